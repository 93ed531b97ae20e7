// SPDX-License-Identifier: GPL-3.0-or-later
// Sub-steps of grains: a column that settles and then collapses, Hertz-Mindlin with tangential history.
// usage: bench_dem_step [grains] [threads] [spread of diameters]
#include <cmath>
#include <cstdlib>

#include "bench.hpp"
#include "dem/grain_system.hpp"
#include "exec/parallel.hpp"

namespace gdesp {
namespace {

using Grains = dem::GrainSystem<exec::OpenMP>;

constexpr double diameter = 0.01;

// A loose lattice of grains, jittered, on a square base as wide as a third of the column's height.
GrainTable loose_column(long count, double spread, double& side) {
  const double pitch = 1.02 * diameter * (1.0 + spread);
  const long across = std::max(4L, std::lround(std::cbrt(static_cast<double>(count) / 2.0)));
  side = static_cast<double>(across) * pitch;
  GrainTable table;
  std::uint64_t state = 88172645463325252ull;
  const auto random = [&] {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return static_cast<double>(state >> 11) / 9007199254740992.0;
  };
  for (long k = 0; k < count; ++k) {
    const long i = k % across, j = (k / across) % across, layer = k / (across * across);
    const auto at = [&](long n) { return (static_cast<double>(n) + 0.5) * pitch + 0.005 * diameter * (random() - 0.5); };
    table.position.push_back({at(i), at(j), at(layer)});
    table.diameter.push_back(static_cast<float>(diameter * (1.0 + spread * (2.0 * random() - 1.0))));
    table.density.push_back(2500.0f);
    const auto v = [&] { return static_cast<float>(0.4 * (random() - 0.5)); };
    table.velocity.push_back({v(), v(), v()});
  }
  return table;
}

void rectangle(TriangleTable& table, const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d, int body) {
  const auto base = static_cast<std::int32_t>(table.vertex.size());
  table.vertex.insert(table.vertex.end(), {a, b, c, d});
  table.triangle.push_back({base, base + 1, base + 2});
  table.triangle.push_back({base, base + 2, base + 3});
  table.body.insert(table.body.end(), 2, body);
}

// Floor, three walls, and a gate (body 1) that holds the column on the side of +x.
TriangleTable channel(double side, double length, double height) {
  TriangleTable t;
  rectangle(t, {0, 0, 0}, {length, 0, 0}, {length, side, 0}, {0, side, 0}, 0);
  rectangle(t, {0, 0, 0}, {0, side, 0}, {0, side, height}, {0, 0, height}, 0);
  rectangle(t, {0, 0, 0}, {0, 0, height}, {length, 0, height}, {length, 0, 0}, 0);
  rectangle(t, {0, side, 0}, {length, side, 0}, {length, side, height}, {0, side, height}, 0);
  rectangle(t, {side, 0, 0}, {side, 0, height}, {side, side, height}, {side, side, 0}, 1);
  return t;
}

void report(const char* state, Grains& grains, long steps, double seconds, int threads) {
  const dem::GrainSums sums = grains.sums();
  char extra[256];
  std::snprintf(extra, sizeof extra,
                ",\"state\":\"%s\",\"contacts_per_grain\":%.2f,\"rebuilds\":%ld,\"near_walls\":%d,\"overlap\":%.2g",
                state, 2.0 * sums.contacts / std::max(1, sums.particles), grains.rebuilds(), grains.near_walls(),
                static_cast<double>(sums.largest_overlap));
  bench::print("dem_step", sums.particles, threads, "cpu", static_cast<double>(sums.particles) * steps / seconds,
               "grain steps/s", extra);
}

void run(Grains& grains, const char* state, double dt, int calls, int threads) {
  constexpr int substeps = 20;
  const double seconds = bench::best_seconds(1, [&] {
    for (int k = 0; k < calls; ++k) grains.advance(substeps * dt, substeps);
  });
  report(state, grains, static_cast<long>(calls) * substeps, seconds, threads);
}

}  // namespace
}  // namespace gdesp

int main(int argc, char** argv) {
  using namespace gdesp;
  const long count = argc > 1 ? std::atol(argv[1]) : 100000;
  const int threads = exec::set_threads(argc > 2 ? std::atoi(argv[2]) : 0);
  const double spread = argc > 3 ? std::atof(argv[3]) : 0.0;
  double side = 0.0;
  const GrainTable table = loose_column(count, spread, side);
  const double height = table.position.back().z + 10 * diameter;
  const bool periodic[3] = {false, false, false};
  const Domain domain = make_domain({-0.1, -0.1, -0.1}, {6 * side, side + 0.1, height + 0.1}, diameter, periodic, 3);
  dem::ContactParameters contact;
  contact.youngs_modulus = 2.0e7;
  contact.restitution = 0.5;
  contact.friction = 0.5;
  Grains grains({}, domain, table, contact, channel(side, 5 * side, height), {0, 0, -9.81});
  const double dt = grains.stable_time_step(0.2);
  if (std::getenv("GDESP_PROFILE")) exec::set_profiling(true);
  grains.set_bodies({dem::BodyMotionState{}});
  const auto fall = static_cast<int>(std::sqrt(height) * 0.4 / (20 * dt));
  run(grains, "settling", dt, fall, threads);
  run(grains, "settled", dt, 20, threads);
  dem::BodyMotionState gone;
  gone.present = false;
  grains.set_bodies({gone});
  run(grains, "collapse", dt, 100, threads);
  for (const exec::ProfileRow& row : exec::profile()) {
    std::fprintf(stderr, "%-24s %8.3f s %8ld calls\n", row.name.c_str(), row.seconds, row.calls);
  }
  return 0;
}
