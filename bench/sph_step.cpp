// SPDX-License-Identifier: GPL-3.0-or-later
// Whole steps of water in a tank (two light passes or one full one, walls, wall guard, lists when they are stale), as
// gdesp-run does them. The rate counts particles of water; rate_with_walls counts the walls' too, as other programs' figures do.
// usage: bench_sph_step [sizes] [threads] [h/dp, default 1.3] [steps] [split (default, two passes) | verlet (one)]
#include <cstring>
#include <memory>

#include "scenes.hpp"

namespace {

double h_over_dp = 1.3;
int steps = 24;
gdesp::TimeScheme scheme = gdesp::TimeScheme::split;

void run(long wanted, int threads) {
  using namespace gdesp;
  const std::size_t before = exec::allocated_bytes();
  SimulationInput input = bench::dam_break(wanted, h_over_dp);
  input.time.scheme = scheme;
  const auto simulation = make_simulation(input, "cpu");
  for (int k = 0; k < 4; ++k) simulation->step(1.0e3);
  const Diagnostics start = simulation->diagnostics();
  bench::start_profile();
  const double seconds = bench::seconds_of([&] {
    for (int k = 0; k < steps; ++k) simulation->step(1.0e3);
  });
  const Diagnostics end = simulation->diagnostics();
  const double water = static_cast<double>(end.fluid_particles), walls = static_cast<double>(end.wall_particles);
  bench::print({"sph_step", static_cast<long>(water), threads}, water * steps / seconds, "particle steps/s",
               {{"h_over_dp", h_over_dp},
                {"passes", scheme == TimeScheme::split ? 2.0 : 1.0},
                {"wall_particles", walls},
                {"rate_with_walls", (water + walls) * steps / seconds},
                {"steps_per_rebuild", steps / std::max(1.0, static_cast<double>(end.rebuilds - start.rebuilds))},
                {"memory_per_particle", bench::bytes_each(before, static_cast<long>(water + walls))}});
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 3) h_over_dp = std::atof(argv[3]);
  if (argc > 4) steps = std::atoi(argv[4]);
  if (argc > 5 && std::strcmp(argv[5], "verlet") == 0) scheme = gdesp::TimeScheme::verlet;
  return gdesp::bench::for_each_case(argc, argv, "100000", run);
}
