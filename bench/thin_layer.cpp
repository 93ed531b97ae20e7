// SPDX-License-Identifier: GPL-3.0-or-later
// What the layer of functors and lanes costs: the combined fluid pass of the library against a loop by intrinsics on
// the same records and lists. ratio: time of the library over time of the loop (1.05 is the limit); difference: largest
// difference of the rates over the largest rate.
// usage: bench_thin_layer [sizes] [threads]
#include "hand_written_pass.hpp"
#include "scenes.hpp"

namespace {

void run(long wanted, int threads) {
#if defined(__AVX512F__)
  using namespace gdesp;
  const double dp = bench::spacing;
  const int n = static_cast<int>(std::lround(std::cbrt(static_cast<double>(wanted))));
  const bool periodic[3] = {false, false, false};
  const Domain domain = make_domain({-0.1, -0.1, -0.1}, {n * dp + 0.1, n * dp + 0.1, n * dp + 0.1}, dp, periodic, 3);
  sph::FluidParameters parameters;
  parameters.dp = dp;
  parameters.h = 1.3 * dp;
  parameters.sound_speed = 40.0;
  parameters.skin = 0.1 * parameters.h;
  sph::FluidSystem<exec::OpenMP> fluid({}, domain, parameters, bench::jittered_block(n, dp), {});
  const exec::Index clusters = fluid.set().clusters();
  exec::Array<float, exec::OpenMP> rate;
  rate.resize_discard(16 * static_cast<std::size_t>(clusters));
  const bench::HandWrittenPass by_hand{bench::plain_pass(fluid, rate.data())};
  double library = 1e30, loop = 1e30;
  for (int k = 0; k < 15; ++k) {
    library = std::min(library, bench::seconds_of([&] { fluid.combined_pass(); }));
    loop = std::min(loop, bench::seconds_of([&] { bench::run_plain(by_hand, clusters); }));
  }
  bench::print(
      {"thin_layer", fluid.particles(), threads}, static_cast<double>(fluid.particles()) / library,
      "particle evaluations/s",
      {{"ratio", library / loop}, {"difference", bench::largest_difference(fluid.rates(), rate.data(), clusters)}});
#else
  (void)wanted, (void)threads;
  std::fprintf(stderr,
               "bench_thin_layer: the loop by hand is for AVX-512, and this build has none; nothing measured\n");
#endif
}

}  // namespace

int main(int argc, char** argv) { return gdesp::bench::for_each_case(argc, argv, "100000", run); }
