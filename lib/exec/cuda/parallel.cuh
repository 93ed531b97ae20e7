// SPDX-License-Identifier: GPL-3.0-or-later
// Device versions of the verbs of exec/parallel.hpp. Everything is ordered on the back end's stream.
#pragma once

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_reduce.cuh>
#include <cub/device/device_scan.cuh>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>

#include "exec/cuda/check.cuh"
#include "exec/lanes.hpp"

namespace gdesp::exec {

/// One of the sixteen lanes of a cluster, held by one thread of half a warp.
struct DeviceLanes {
  using Real = float;
  using Mask = bool;
  int lane;            ///< 0..15
  unsigned half_mask;  ///< of this half of the warp

  __device__ Real load_i(const float* p) const { return p[lane >> 2]; }
  __device__ Real load_j(const float* p) const { return p[lane & 3]; }
  __device__ void store_sum_i(float* p, Real a) const {
    a += __shfl_xor_sync(half_mask, a, 1);
    a += __shfl_xor_sync(half_mask, a, 2);
    if ((lane & 3) == 0) p[lane >> 2] = a;
  }
  __device__ void store_max_i(float* p, Real a) const {
    a = fmaxf(a, __shfl_xor_sync(half_mask, a, 1));
    a = fmaxf(a, __shfl_xor_sync(half_mask, a, 2));
    if ((lane & 3) == 0) p[lane >> 2] = a;
  }
  __device__ bool any(bool m) const { return __any_sync(half_mask, m) != 0; }
  __device__ bool leader() const { return lane == 0; }
  __device__ std::uint32_t allocate(std::uint32_t* counter, std::uint32_t amount) const {
    const unsigned first = lane == 0 ? atomicAdd(counter, amount) : 0u;
    return __shfl_sync(half_mask, first, half_mask & 0xffffu ? 0 : 16);
  }
};

namespace detail {

inline constexpr int block_threads = 128;

template <class Body>
__global__ void run_parallel_for(const Body body, Index count) {
  const Index i = static_cast<Index>(blockIdx.x) * blockDim.x + threadIdx.x;
  if (i < count) body(i);
}

template <class Body>
__global__ void __launch_bounds__(block_threads) run_pair_pass(const Body body, Index clusters) {
  const std::int64_t thread = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
  const Index c = static_cast<Index>(thread >> 4);
  if (c >= clusters) return;
  const int in_warp = threadIdx.x & 31;
  body(c, DeviceLanes{in_warp & 15, in_warp < 16 ? 0x0000ffffu : 0xffff0000u});
}

inline cudaStream_t stream(const Cuda& exec) { return static_cast<cudaStream_t>(exec.stream); }

/// Scratch of CUB, kept and grown; one per thread of the host.
void* cub_scratch(const Cuda& exec, std::size_t bytes);
/// A small pinned and device-visible result slot.
void* result_slot(const Cuda& exec, std::size_t bytes);

}  // namespace detail

template <class Body>
void parallel_for(const Cuda& exec, const char* name, Index count, const Body& body) {
  if (count <= 0) return;
  const int blocks = (count + detail::block_threads - 1) / detail::block_threads;
  detail::run_parallel_for<<<blocks, detail::block_threads, 0, detail::stream(exec)>>>(body, count);
  check(cudaGetLastError(), name);
}

template <class Body>
void pair_pass(const Cuda& exec, const char* name, Index clusters, const Body& body) {
  if (clusters <= 0) return;
  const std::int64_t threads = static_cast<std::int64_t>(clusters) * 16;
  const unsigned blocks = static_cast<unsigned>((threads + detail::block_threads - 1) / detail::block_threads);
  detail::run_pair_pass<<<blocks, detail::block_threads, 0, detail::stream(exec)>>>(body, clusters);
  check(cudaGetLastError(), name);
}

template <class T, class Body, class Combine>
T reduce(const Cuda& exec, const char* name, Index count, T start, const Body& body, const Combine& combine) {
  if (count <= 0) return start;
  const auto values = thrust::make_transform_iterator(thrust::counting_iterator<Index>(0), body);
  T* result = static_cast<T*>(detail::result_slot(exec, sizeof(T)));
  std::size_t bytes = 0;
  cub::DeviceReduce::Reduce(nullptr, bytes, values, result, count, combine, start, detail::stream(exec));
  void* scratch = detail::cub_scratch(exec, bytes);
  check(cub::DeviceReduce::Reduce(scratch, bytes, values, result, count, combine, start, detail::stream(exec)), name);
  T host;
  detail::copy_to_host(exec, &host, result, sizeof(T));
  return host;
}

template <class T>
T exclusive_scan(const Cuda& exec, const char* name, const T* in, T* out, Index count) {
  check(cudaMemsetAsync(out, 0, sizeof(T), detail::stream(exec)), name);
  if (count <= 0) return T{0};
  std::size_t bytes = 0;
  cub::DeviceScan::InclusiveSum(nullptr, bytes, in, out + 1, count, detail::stream(exec));
  void* scratch = detail::cub_scratch(exec, bytes);
  check(cub::DeviceScan::InclusiveSum(scratch, bytes, in, out + 1, count, detail::stream(exec)), name);
  T total;
  detail::copy_to_host(exec, &total, out + count, sizeof(T));
  return total;
}

inline void sort_pairs(const Cuda& exec, const char* name, Array<std::uint64_t, Cuda>& keys, Array<Index, Cuda>& values,
                       Array<std::uint64_t, Cuda>& keys_scratch, Array<Index, Cuda>& values_scratch, Index count,
                       int bits) {
  keys_scratch.resize_discard(keys.size());
  values_scratch.resize_discard(values.size());
  cub::DoubleBuffer<std::uint64_t> key_buffer(keys.data(), keys_scratch.data());
  cub::DoubleBuffer<Index> value_buffer(values.data(), values_scratch.data());
  std::size_t bytes = 0;
  cub::DeviceRadixSort::SortPairs(nullptr, bytes, key_buffer, value_buffer, count, 0, bits, detail::stream(exec));
  void* scratch = detail::cub_scratch(exec, bytes);
  check(cub::DeviceRadixSort::SortPairs(scratch, bytes, key_buffer, value_buffer, count, 0, bits,
                                        detail::stream(exec)), name);
  if (key_buffer.Current() != keys.data()) keys.swap(keys_scratch);
  if (value_buffer.Current() != values.data()) values.swap(values_scratch);
}

inline void synchronize(const Cuda& exec) { check(cudaStreamSynchronize(detail::stream(exec)), "waiting for the GPU"); }

}  // namespace gdesp::exec
