// SPDX-License-Identifier: GPL-3.0-or-later
// Device versions of the verbs of exec/parallel.hpp. Everything is ordered on the back end's stream.
#pragma once

#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_reduce.cuh>
#include <cub/device/device_scan.cuh>

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
  __device__ Real load(const float* p) const { return p[lane]; }
  __device__ Real number_of_j() const { return static_cast<float>(lane & 3); }
  struct Exchange {
    Real mine;
    int lane;
    unsigned half_mask;
    __device__ float operator[](int from) const {
      return __shfl_sync(half_mask, mine, from + (half_mask & 0xffffu ? 0 : 16));
    }
    __device__ Real spread(int quarter) const { return (*this)[4 * quarter + (lane >> 2)]; }
    __device__ Real repeated(int quarter) const { return (*this)[4 * quarter + (lane & 3)]; }
  };
  __device__ Exchange exchange(Real a) const { return {a, lane, half_mask}; }
  __device__ float sum(Real a) const {
    for (int step = 1; step < 16; step *= 2) a += __shfl_xor_sync(half_mask, a, step);
    return a;
  }
  __device__ void store_sum_j(float* p, Real a) const {
    a += __shfl_xor_sync(half_mask, a, 4);
    a += __shfl_xor_sync(half_mask, a, 8);
    if (lane < 4) p[lane] = a;
  }
  __device__ void store_sum_i(float* p, Real a) const {
    a += __shfl_xor_sync(half_mask, a, 1);
    a += __shfl_xor_sync(half_mask, a, 2);
    if ((lane & 3) == 0) p[lane >> 2] = a;
  }
  __device__ Real sum_i(Real a) const {
    a += __shfl_xor_sync(half_mask, a, 1);
    return a + __shfl_xor_sync(half_mask, a, 2);
  }
  __device__ void store_max_i(float* p, Real a) const {
    a = fmaxf(a, __shfl_xor_sync(half_mask, a, 1));
    a = fmaxf(a, __shfl_xor_sync(half_mask, a, 2));
    if ((lane & 3) == 0) p[lane >> 2] = a;
  }
  __device__ bool any(bool m) const { return __any_sync(half_mask, m) != 0; }
  __device__ unsigned bits(bool m) const {
    return (__ballot_sync(half_mask, m) >> (half_mask & 0xffffu ? 0 : 16)) & 0xffffu;
  }
  template <class Visit>
  __device__ void for_each_bit(unsigned b, const Visit& visit) const {
    if ((b >> lane) & 1u) visit(lane);
  }
  template <class Visit>
  __device__ void for_each_i(const Visit& visit) const {
    if ((lane & 3) == 0) visit(lane >> 2);
  }
  __device__ void share_memory() const { __syncwarp(half_mask); }
  __device__ bool leader() const { return lane == 0; }
  __device__ std::uint32_t allocate(std::uint32_t* counter, std::uint32_t amount) const {
    const unsigned first = lane == 0 ? atomicAdd(counter, amount) : 0u;
    return __shfl_sync(half_mask, first, half_mask & 0xffffu ? 0 : 16);
  }
};

/// One of the eight lanes of a row, held by one thread of a quarter of a warp.
struct DeviceRowLanes {
  using Real = float;
  using Int = std::int32_t;
  using Mask = bool;
  int lane;               ///< 0..7
  unsigned quarter_mask;  ///< of this quarter of the warp

  __device__ Real load(const float* p) const { return p[lane]; }
  __device__ Int load(const std::int32_t* p) const { return p[lane]; }
  __device__ void store(float* p, Real a) const { p[lane] = a; }
  __device__ void store(std::int32_t* p, Int a) const { p[lane] = a; }
  __device__ Int bits(Real a) const { return __float_as_int(a); }
  __device__ Real value(Int a) const { return static_cast<float>(a); }
  __device__ Int truncate(Real a) const { return static_cast<Int>(a); }
  __device__ Int scaled(Int a, std::int32_t by) const { return a * by; }
  __device__ void gather4(const float* p, int stride, Int index, Real out[4]) const {
    const float4 q = *reinterpret_cast<const float4*>(p + static_cast<std::int64_t>(index) * stride);
    out[0] = q.x;
    out[1] = q.y;
    out[2] = q.z;
    out[3] = q.w;
  }
  __device__ Real gather(const float* p, Int index) const { return p[index]; }
  __device__ float sum(Real a) const {
    a += __shfl_xor_sync(quarter_mask, a, 4);
    a += __shfl_xor_sync(quarter_mask, a, 2);
    return a + __shfl_xor_sync(quarter_mask, a, 1);
  }
  __device__ Float4 sums(Real x, Real y, Real z) const { return {sum(x), sum(y), sum(z), 0.0f}; }
  __device__ float largest(Real a) const {
    a = fmaxf(a, __shfl_xor_sync(quarter_mask, a, 4));
    a = fmaxf(a, __shfl_xor_sync(quarter_mask, a, 2));
    return fmaxf(a, __shfl_xor_sync(quarter_mask, a, 1));
  }
  __device__ bool any(bool m) const { return __any_sync(quarter_mask, m) != 0; }
  __device__ bool leader() const { return lane == 0; }
  __device__ void share_memory() const { __syncwarp(quarter_mask); }
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

/// *largest = max(*largest, mine) over all threads, none of which may be negative. All blocks write to one place, one after the other:
/// each of them asks first whether it has news, which only some tens of them have.
__device__ inline void note_largest(const Largest& mine, Largest* largest) {
  __shared__ float of_warps[4][block_threads / 32];
  for (int k = 0; k < 4; ++k) {
    float value = mine.value[k];
    for (int step = 16; step > 0; step >>= 1) value = fmaxf(value, __shfl_xor_sync(0xffffffffu, value, step));
    if ((threadIdx.x & 31) == 0) of_warps[k][threadIdx.x >> 5] = value;
  }
  __syncthreads();
  if (threadIdx.x >= 4) return;
  const int k = static_cast<int>(threadIdx.x);
  float value = 0.0f;
  for (const float of_warp : of_warps[k]) value = fmaxf(value, of_warp);
  // Not negative, so the order of the bits is the order of the values.
  if (value > *static_cast<const volatile float*>(&largest->value[k]))
    // cppcheck-suppress invalidPointerCast ; both are as IEEE 754 and two's complement have them
    atomicMax(reinterpret_cast<int*>(&largest->value[k]), __float_as_int(value));
}

template <class Body>
__global__ void __launch_bounds__(block_threads)
    run_row_pass(const Body body, Index rows, const Gate gate, Largest* largest) {
  if (gate.closed()) {
    if (blockIdx.x == 0 && threadIdx.x == 0) *largest = *gate.after;
    return;
  }
  const std::int64_t thread = static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
  const Index r = static_cast<Index>(thread >> 3);
  const int in_warp = threadIdx.x & 31;
  Largest mine;
  if (r < rows) mine = body(r, DeviceRowLanes{in_warp & 7, 0xffu << (in_warp & 24)});
  __syncwarp();
  note_largest(mine, largest);
}

inline cudaStream_t stream(const Cuda& exec) { return static_cast<cudaStream_t>(exec.stream); }

/// Scratch of CUB, kept and grown; one per thread of the host.
void* cub_scratch(const Cuda& exec, std::size_t bytes);
/// A small pinned and device-visible result slot.
void* result_slot(const Cuda& exec, std::size_t bytes);

/// Puts a kernel of at least `threads` threads (at least one block) behind what the stream was given before.
template <class... Parameters, class... Arguments>
void launch(const Cuda& exec, const char* name, void (*kernel)(Parameters...), std::int64_t threads,
            const Arguments&... arguments) {
  const std::int64_t blocks = threads > 0 ? (threads + block_threads - 1) / block_threads : 1;
  cudaLaunchConfig_t config{};
  config.gridDim.x = static_cast<unsigned>(blocks);
  config.blockDim.x = block_threads;
  config.stream = stream(exec);
  check(cudaLaunchKernelEx(&config, kernel, arguments...), name);
}

}  // namespace detail

template <class Body>
void parallel_for(const Cuda& exec, const char* name, Index count, const Body& body) {
  if (count > 0) detail::launch(exec, name, &detail::run_parallel_for<Body>, count, body, count);
}

template <class Body>
void pair_pass(const Cuda& exec, const char* name, Index clusters, const Body& body) {
  if (clusters > 0) {
    detail::launch(exec, name, &detail::run_pair_pass<Body>, std::int64_t{16} * clusters, body, clusters);
  }
}

template <class Body>
void row_pass(const Cuda& exec, const char* name, Index rows, const Body& body, const Gate& gate, Largest* largest) {
  check(cudaMemsetAsync(largest, 0, sizeof(Largest), detail::stream(exec)), name);
  // A pass without rows has a block too: it hands a closed gate on.
  detail::launch(exec, name, &detail::run_row_pass<Body>, std::int64_t{8} * rows, body, rows, gate, largest);
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

inline void sort_pairs(const Cuda& exec, const char* name, SortedPairs& pairs, Index count, int bits) {
  cub::DoubleBuffer<std::uint64_t> key_buffer(pairs.keys, pairs.other_keys);
  cub::DoubleBuffer<Index> value_buffer(pairs.values, pairs.other_values);
  std::size_t bytes = 0;
  cub::DeviceRadixSort::SortPairs(nullptr, bytes, key_buffer, value_buffer, count, 0, bits, detail::stream(exec));
  void* scratch = detail::cub_scratch(exec, bytes);
  check(cub::DeviceRadixSort::SortPairs(scratch, bytes, key_buffer, value_buffer, count, 0, bits, detail::stream(exec)),
        name);
  pairs = {key_buffer.Current(), value_buffer.Current(), key_buffer.Alternate(), value_buffer.Alternate()};
}

inline void synchronize(const Cuda& exec) { check(cudaStreamSynchronize(detail::stream(exec)), "waiting for the GPU"); }

}  // namespace gdesp::exec
