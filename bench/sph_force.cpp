// SPDX-License-Identifier: GPL-3.0-or-later
// The fluid's pair passes and the neighbour build on a jittered block of water, h = 1.3 dp, skin 0.1 h, artificial
// viscosity and density diffusion.
// usage: bench_sph_force [sizes] [threads]
#include "counted_real.hpp"
#include "scenes.hpp"
#include "sph/fluid_system.hpp"
#include "sph/wendland_c2.hpp"

namespace {

using namespace gdesp;
using bench::CountedReal;

// Operations of one pair, by running the law on a counting real. The differences of places and velocities are six more.
template <bool Momentum, bool Continuity>
double pair_operations() {
  sph::FluidPairLaw law{};
  sph::FluidRates<CountedReal> rates;
  const CountedReal one(1.0f);
  return 6.0 + bench::operations_of([&] {
           sph::add_fluid_pair<Momentum, Continuity, sph::Viscosity::artificial, true>(law, one, one, one, one, one,
                                                                                       one, one, one, one, one, rates);
         });
}

// Neighbours inside the support on the undisturbed lattice.
double neighbours(double h_over_dp) {
  const int reach = static_cast<int>(2.0 * h_over_dp) + 1;
  double count = -1.0;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j)
      for (int k = -reach; k <= reach; ++k) count += std::sqrt(i * i + j * j + k * k) < 2.0 * h_over_dp ? 1.0 : 0.0;
  return count;
}

void run(long wanted, int threads) {
  const double dp = bench::spacing;
  const int n = static_cast<int>(std::lround(std::cbrt(static_cast<double>(wanted))));
  const bool periodic[3] = {false, false, false};
  const Domain domain = make_domain({-0.1, -0.1, -0.1}, {n * dp + 0.1, n * dp + 0.1, n * dp + 0.1}, dp, periodic, 3);
  sph::FluidParameters parameters;
  parameters.dp = dp;
  parameters.h = 1.3 * dp;
  parameters.sound_speed = 40.0;
  parameters.skin = 0.1 * parameters.h;
  const std::size_t before = exec::allocated_bytes();
  sph::FluidSystem<exec::OpenMP> fluid({}, domain, parameters, bench::jittered_block(n, dp), {});
  const long particles = fluid.particles();
  const double lanes = 16.0 * static_cast<double>(fluid.list_entries()) / static_cast<double>(particles);
  const double pairs = neighbours(1.3), list_bytes = 4.0 * lanes / 16.0;
  const auto report = [&](const char* name, double seconds, double operations) {
    bench::print({name, particles, threads}, static_cast<double>(particles) / seconds, "particle evaluations/s",
                 {{"flop_per_particle", operations * pairs},
                  {"bytes_per_particle", 32.0 + 16.0 + 4.0 + list_bytes},
                  {"lanes_per_neighbour", lanes / pairs},
                  {"memory_per_particle", bench::bytes_each(before, particles)}});
  };
  bench::start_profile();
  const int repeats = particles > 500000 ? 3 : 7;
  double both = 1e30, momentum = 1e30, continuity = 1e30;
  for (int k = 0; k < repeats; ++k) {  // interleaved: a disturbance of the machine meets all
    both = std::min(both, bench::seconds_of([&] { fluid.combined_pass(); }));
    momentum = std::min(momentum, bench::seconds_of([&] { fluid.momentum_pass(); }));
    continuity = std::min(continuity, bench::seconds_of([&] { fluid.continuity_pass(); }));
  }
  report("sph_force", both, pair_operations<true, true>());
  report("sph_momentum", momentum, pair_operations<true, false>());
  report("sph_continuity", continuity, pair_operations<false, true>());
  const double build = bench::best_seconds(std::max(2, repeats / 2), [&] { fluid.rebuild(0.0); });
  bench::print({"neighbour_build", particles, threads}, static_cast<double>(particles) / build, "particles/s");
}

}  // namespace

int main(int argc, char** argv) { return bench::for_each_case(argc, argv, "100000", run); }
