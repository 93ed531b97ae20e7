// SPDX-License-Identifier: GPL-3.0-or-later
// Sub-steps of grains: a settled layer, Hertz-Mindlin with tangential history, about 5 contacts a grain; stirred so
// that lists go stale as in a slow flow.
// usage: bench_dem_step [sizes] [threads] [file]: `file` receives the grains as a LAMMPS data file and nothing is timed
#include "counted_real.hpp"
#include "dem/contact_force.hpp"
#include "scenes.hpp"

namespace {

using namespace gdesp;
using Grains = dem::GrainSystem<exec::OpenMP>;
using bench::CountedReal;

const char* data_file = nullptr;

// Operations of one contact of spheres, by running the law on a counting real; separation, gathering and summing by
// hand: 9 for r, 6 for its length, 3 for overlap and reach, 4 for n, 3 for the radius, 3 for the mass, 24 for the
// surface velocity, 18 for torque and sums.
double contact_operations() {
  dem::ContactLaws<dem::HertzMindlin> laws{};
  dem::ContactGeometry<CountedReal> g{{1.0f, 0.0f, 0.0f}, 1.0f, 1.0f, 1.0f, {1.0f, 1.0f, 1.0f}};
  Vec3<CountedReal> history{};
  const dem::HalfSteps half{1.0f, 1.0f};
  return 70.0 + bench::operations_of([&] { dem::contact_force(laws, g, half, history); });
}

int write_data(const GrainTable& table, double side, const char* path) {
  std::FILE* file = std::fopen(path, "w");
  if (!file) {
    std::fprintf(stderr, "bench_dem_step: cannot write %s\n", path);
    return 5;
  }
  std::fprintf(file,
               "settled grains\n\n%zu atoms\n1 atom types\n\n0 %.9g xlo xhi\n0 %.9g ylo yhi\n-0.01 0.6 zlo zhi\n\n"
               "Atoms # sphere\n\n",
               table.position.size(), side, side);
  for (std::size_t k = 0; k < table.position.size(); ++k) {
    const Vec3d& r = table.position[k];
    std::fprintf(file, "%zu 1 %.9g %.9g %.9g %.9g %.9g\n", k + 1, static_cast<double>(table.diameter[k]),
                 static_cast<double>(table.density[k]), r.x, r.y, r.z);
  }
  return std::fclose(file) == 0 ? 0 : 5;
}

void run(long wanted, int threads) {
  double side = 0.0;
  const GrainTable table = bench::settled_grains(wanted, side);
  if (data_file) {
    if (const int code = write_data(table, side, data_file)) std::exit(code);
    return;
  }
  const std::size_t before = exec::allocated_bytes();
  Grains grains({}, bench::layer_domain(side, 0.5), table, bench::glass_like(), bench::floor_of(side),
                {0.0, 0.0, -9.81});
  const double dt = grains.stable_time_step(0.2);
  constexpr int substeps = 20;
  const int calls = wanted > 500000 ? 5 : 10;
  const auto advance = [&](int n) {
    for (int k = 0; k < n; ++k) grains.advance(substeps * dt, substeps);
  };
  advance(3);
  const long rebuilds = grains.rebuilds();
  bench::start_profile();
  const double seconds = bench::seconds_of([&] { advance(calls); });
  const long steps = static_cast<long>(calls) * substeps;
  exec::set_profiling(false);
  const dem::GrainSums sums = grains.sums();
  const double contacts = 2.0 * sums.contacts / std::max(1, sums.particles);
  bench::print({"dem_step", sums.particles, threads},
               static_cast<double>(sums.particles) * static_cast<double>(steps) / seconds, "grain steps/s",
               {{"contacts_per_grain", contacts},
                {"rebuilds_per_100_steps",
                 100.0 * static_cast<double>(grains.rebuilds() - rebuilds) / static_cast<double>(steps)},
                {"dt", dt},
                {"flop_per_particle", contacts * contact_operations() + 60.0},
                // records in and out, row of contacts in and history out, velocities in and out, start
                {"bytes_per_particle", 64.0 + 64.0 + 64.0 + 128.0 + 96.0 + 48.0 + 12.0 + 8.0},
                {"memory_per_particle", bench::bytes_each(before, sums.particles)}});
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 3) data_file = argv[3];
  return bench::for_each_case(argc, argv, "100000", run);
}
