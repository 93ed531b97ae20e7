// SPDX-License-Identifier: GPL-3.0-or-later
// The roof of this machine, as a program built like the solver sees it: independent fused multiply-adds in registers
// (FLOP/s, two a multiply-add), and the triad a = b + s c over arrays of 128 MiB each (bytes/s, 16 counted an element).
// usage: bench_roof [ignored] [threads,...]
#include "bench.hpp"

namespace {

using namespace gdesp;
typedef float Lanes __attribute__((vector_size(64)));

// Twelve chains, more than the latency of a multiply-add times the units: each by name, for arrays go through memory.
float multiply_add_chains(long rounds) {
  const Lanes a = Lanes{} + 0.999f, b = Lanes{} + 0.0005f;
  Lanes c0 = a, c1 = b, c2 = a + b, c3 = c2 + b, c4 = c3 + b, c5 = c4 + b;
  Lanes c6 = c5 + b, c7 = c6 + b, c8 = c7 + b, c9 = c8 + b, c10 = c9 + b, c11 = c10 + b;
  for (long r = 0; r < rounds; ++r) {
    c0 = c0 * a + b, c1 = c1 * a + b, c2 = c2 * a + b, c3 = c3 * a + b, c4 = c4 * a + b, c5 = c5 * a + b;
    c6 = c6 * a + b, c7 = c7 * a + b, c8 = c8 * a + b, c9 = c9 * a + b, c10 = c10 * a + b, c11 = c11 * a + b;
  }
  const Lanes sum = ((c0 + c1) + (c2 + c3)) + ((c4 + c5) + (c6 + c7)) + ((c8 + c9) + (c10 + c11));
  return sum[0];
}

double peak_flops(int threads) {
  constexpr long rounds = 2000000;
  float sink = 0.0f;
  const double seconds = bench::best_seconds(5, [&] {
#pragma omp parallel num_threads(threads) reduction(+ : sink)
    sink += multiply_add_chains(rounds);
  });
  if (sink == 12345.0f) std::fprintf(stderr, "%g\n", static_cast<double>(sink));
  return 2.0 * 16.0 * 12.0 * rounds * threads / seconds;
}

double triad_bytes() {
  constexpr exec::Index count = 1 << 25;
  exec::Array<float, exec::OpenMP> a, b, c;
  for (auto* array : {&a, &b, &c}) array->resize_discard(count);
  float *pa = a.data(), *pb = b.data(), *pc = c.data();
  const double seconds = bench::best_seconds(7, [&] {
#pragma omp parallel for simd schedule(static)
    for (exec::Index i = 0; i < count; ++i) pa[i] = pb[i] + 3.0f * pc[i];
  });
  return 16.0 * count / seconds;  // two reads, a write, and the read that comes before a write
}

}  // namespace

int main(int argc, char** argv) {
  return bench::for_each_case(argc, argv, "1", [](long, int threads) {
    bench::print({"roof_multiply_add", 0, threads}, peak_flops(threads), "FLOP/s");
    bench::print({"roof_triad", 0, threads}, triad_bytes(), "B/s");
  });
}
