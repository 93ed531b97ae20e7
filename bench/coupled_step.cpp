// SPDX-License-Identifier: GPL-3.0-or-later
// Coupled steps: a settled bed of grains under water that moves over it, h = 1.5 dp, grains sub-stepping inside the
// fluid's step. The rate counts water and grains once a step.
// usage: bench_coupled_step [sizes] [threads]
#include <memory>

#include "scenes.hpp"

namespace {

void run(long wanted, int threads) {
  using namespace gdesp;
  const std::size_t before = exec::allocated_bytes();
  const auto simulation = make_simulation(bench::flooded_bed(wanted), "cpu");
  for (int k = 0; k < 3; ++k) simulation->step(1.0e3);
  const Diagnostics start = simulation->diagnostics();
  const int steps = wanted > 500000 ? 6 : 12;
  bench::start_profile();
  const double seconds = bench::seconds_of([&] {
    for (int k = 0; k < steps; ++k) simulation->step(1.0e3);
  });
  const Diagnostics end = simulation->diagnostics();
  const long particles = static_cast<long>(end.fluid_particles + end.grains);
  bench::print({"coupled_step", particles, threads}, static_cast<double>(particles) * steps / seconds,
               "particle steps/s",
               {{"grains", static_cast<double>(end.grains)},
                {"substeps_per_step", static_cast<double>(end.grain_substeps - start.grain_substeps) / steps},
                {"memory_per_particle", bench::bytes_each(before, particles)}});
}

}  // namespace

int main(int argc, char** argv) { return gdesp::bench::for_each_case(argc, argv, "100000", run); }
