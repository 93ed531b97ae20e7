// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs of the execution layer: parallel_for, pair_pass (16 lanes a cluster, exec/lanes.hpp), row_pass (8 lanes
// a row), reduce, scan, sort. Bodies are named functors; each writes only what its own index owns, so results do not depend on the
// number of threads. Device versions: exec/cuda/parallel.cuh.
#pragma once

#include "exec/array.hpp"
#include "exec/backend.hpp"
#include "exec/lanes.hpp"
#include "exec/profile.hpp"

#if defined(__CUDACC__)
#include "exec/cuda/parallel.cuh"
#else

#include <omp.h>

#include <algorithm>
#include <vector>

namespace gdesp::exec {

namespace detail {
// Below these counts one thread is faster than waking the others.
inline constexpr Index small_loop = 4096, small_pass = 256;
// Rows between the one whose neighbours are asked for and the one that is worked on.
inline constexpr Index rows_ahead = 8;
}  // namespace detail

/// body(i) for i in [0, count).
template <class Body>
void parallel_for(const OpenMP&, const char* name, Index count, const Body& body) {
  const ProfileScope scope(name);
#pragma omp parallel for schedule(static) if (count > detail::small_loop)
  for (Index i = 0; i < count; ++i) body(i);
}

/// body(cluster, lanes) for each cluster: sixteen lanes are the pairs of four i and four j particles.
template <class Body>
void pair_pass(const OpenMP&, const char* name, Index clusters, const Body& body) {
  const ProfileScope scope(name);
#pragma omp parallel for schedule(dynamic, 64) if (clusters > detail::small_pass)
  for (Index c = 0; c < clusters; ++c) body(c, HostLanes{});
}

/// body(row, lanes) for each row of eight lanes; `largest` becomes the largest of what the bodies return. Bodies may
/// write only what belongs to their row. A closed gate leaves the pass out.
template <class Body>
void row_pass(const OpenMP&, const char* name, Index rows, const Body& body, const Gate& gate, Largest* largest) {
  const ProfileScope scope(name);
  if (gate.closed()) {
    *largest = *gate.after;
    return;
  }
  Largest total;
#pragma omp parallel
  {
    Largest mine;
#pragma omp for schedule(dynamic, 128) nowait
    for (Index r = 0; r < rows; ++r) {
      if constexpr (requires { body.prefetch(r); }) {
        if (r + detail::rows_ahead < rows) body.prefetch(r + detail::rows_ahead);
      }
      const Largest one = body(r, HostRowLanes{});
      for (int k = 0; k < 4; ++k) mine.value[k] = max(mine.value[k], one.value[k]);
    }
#pragma omp critical(gdesp_row_pass)
    for (int k = 0; k < 4; ++k) total.value[k] = max(total.value[k], mine.value[k]);
  }
  *largest = total;
}

/// combine over body(i), i in [0, count), starting from `start`; the order is fixed (blocks of 4096).
template <class T, class Body, class Combine>
T reduce(const OpenMP&, const char* name, Index count, T start, const Body& body, const Combine& combine) {
  const ProfileScope scope(name);
  constexpr Index block = 4096;
  const Index blocks = (count + block - 1) / block;
  std::vector<T> partial(static_cast<std::size_t>(blocks), start);
#pragma omp parallel for schedule(static) if (blocks > 1)
  for (Index b = 0; b < blocks; ++b) {
    T sum = start;
    const Index end = std::min(count, (b + 1) * block);
    for (Index i = b * block; i < end; ++i) sum = combine(sum, body(i));
    partial[static_cast<std::size_t>(b)] = sum;
  }
  T total = start;
  for (const T& p : partial) total = combine(total, p);
  return total;
}

/// out[i] = in[0] + ... + in[i - 1] for i in [0, count]; returns out[count]. `out` has count + 1 elements.
template <class T>
T exclusive_scan(const OpenMP&, const char* name, const T* in, T* out, Index count) {
  const ProfileScope scope(name);
  const int threads = count > detail::small_loop ? omp_get_max_threads() : 1;
  std::vector<T> sums(static_cast<std::size_t>(threads) + 1, T{0});
#pragma omp parallel num_threads(threads)
  {
    const int me = omp_get_thread_num();
    const Index begin = static_cast<Index>(static_cast<long>(count) * me / threads);
    const Index end = static_cast<Index>(static_cast<long>(count) * (me + 1) / threads);
    T sum{0};
    for (Index i = begin; i < end; ++i) sum += in[i];
    sums[static_cast<std::size_t>(me) + 1] = sum;
#pragma omp barrier
#pragma omp single
    for (int k = 0; k < threads; ++k) sums[static_cast<std::size_t>(k) + 1] += sums[static_cast<std::size_t>(k)];
    T running = sums[static_cast<std::size_t>(me)];
    for (Index i = begin; i < end; ++i) {
      const T value = in[i];
      out[i] = running;
      running += value;
    }
  }
  out[count] = sums[static_cast<std::size_t>(threads)];
  return out[count];
}

/// Stable sort of (key, value) pairs by the low `bits` of the key. On return `pairs.keys` and `pairs.values` point to the
/// sorted ones; which of the two places that is depends on the number of passes.
void sort_pairs(const OpenMP&, const char* name, SortedPairs& pairs, Index count, int bits);

/// Waits until all work given so far is done.
inline void synchronize(const OpenMP&) {}

}  // namespace gdesp::exec
#endif
