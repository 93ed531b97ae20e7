// SPDX-License-Identifier: GPL-3.0-or-later
// The fluid's pair passes and the neighbour build on a jittered block of water, h = 1.3 dp.
#include <cmath>
#include <cstdlib>
#include <random>

#include "bench.hpp"
#include "exec/parallel.hpp"
#include "sph/fluid_system.hpp"

namespace {

using namespace gdesp;

FluidTable jittered_block(int n, double dp) {
  FluidTable table;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-0.15 * dp, 0.15 * dp);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        table.position.push_back({(i + 0.5) * dp + jitter(random), (j + 0.5) * dp + jitter(random),
                                  (k + 0.5) * dp + jitter(random)});
        table.velocity.push_back({static_cast<float>(jitter(random)), 0.0f, 0.0f});
        table.density.push_back(1000.0f);
      }
  return table;
}

void run(long wanted, int threads) {
  const double dp = 0.01;
  const int n = static_cast<int>(std::cbrt(static_cast<double>(wanted)) + 0.5);
  const bool periodic[3] = {false, false, false};
  const Domain domain = make_domain({-0.1, -0.1, -0.1}, {n * dp + 0.1, n * dp + 0.1, n * dp + 0.1}, dp, periodic, 3);
  sph::FluidParameters parameters;
  parameters.dp = dp;
  parameters.h = 1.3 * dp;
  parameters.sound_speed = 40.0;
  parameters.skin = 0.1 * parameters.h;
  sph::FluidSystem<exec::OpenMP> fluid({}, domain, parameters, jittered_block(n, dp), {});
  const long particles = fluid.particles();
  using gdesp::bench::best_seconds;
  using gdesp::bench::print;
  const double both = best_seconds(7, [&] { fluid.combined_pass(); });
  print("sph_force", particles, threads, "cpu", particles / both, "particle evaluations/s");
  const double momentum = best_seconds(7, [&] { fluid.momentum_pass(); });
  print("sph_momentum", particles, threads, "cpu", particles / momentum, "particle evaluations/s");
  const double continuity = best_seconds(7, [&] { fluid.continuity_pass(); });
  print("sph_continuity", particles, threads, "cpu", particles / continuity, "particle evaluations/s");
  const double build = best_seconds(5, [&] { fluid.rebuild(0.0); });
  print("neighbour_build", particles, threads, "cpu", particles / build, "particles/s");
}

}  // namespace

int main(int argc, char** argv) {
  for (int k = 1; k < argc; ++k) {
    for (int threads : {1, 2}) run(std::atol(argv[k]), exec::set_threads(threads));
  }
  return 0;
}
