// SPDX-License-Identifier: GPL-3.0-or-later
// Stands in for the header of the CUDA Toolkit when device code is compiled for the emulated device: the part of the
// runtime that lib/exec/cuda uses, with the meaning that the CUDA C++ Programming Guide gives it (13.0).
#pragma once

#include "device.hpp"

#define __global__
#define __device__
#define __host__
#define __launch_bounds__(threads)
#define __shared__ static  // one block runs after the other

struct alignas(16) float4 {
  float x, y, z, w;
};
struct dim3 {
  unsigned x = 1, y = 1, z = 1;
};

enum cudaError_t {
  cudaSuccess = 0,
  cudaErrorMemoryAllocation = 2,
  cudaErrorLaunchFailure = 719,
  cudaErrorStreamCaptureUnsupported = 900,
  cudaErrorGraphExecUpdateFailure = 910
};
const char* cudaGetErrorString(cudaError_t code);
cudaError_t cudaGetLastError();

struct cudaDeviceProp {
  char name[256];
  std::size_t totalGlobalMem;
  int major, minor;
};
cudaError_t cudaGetDeviceCount(int* count);
cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int device);
cudaError_t cudaSetDevice(int device);

enum cudaMemcpyKind { cudaMemcpyHostToDevice = 1, cudaMemcpyDeviceToHost = 2 };
cudaError_t cudaMalloc(void** data, std::size_t bytes);
cudaError_t cudaFree(void* data);
cudaError_t cudaMemGetInfo(std::size_t* free_bytes, std::size_t* total_bytes);

struct EmulatedStream;
using cudaStream_t = EmulatedStream*;
inline constexpr unsigned cudaStreamNonBlocking = 1;
cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned flags);
cudaError_t cudaStreamSynchronize(cudaStream_t stream);
cudaError_t cudaMemsetAsync(void* data, int value, std::size_t bytes, cudaStream_t stream);
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind, cudaStream_t stream);

struct EmulatedGraph;
struct EmulatedGraphExec;
using cudaGraph_t = EmulatedGraph*;
using cudaGraphExec_t = EmulatedGraphExec*;
enum cudaStreamCaptureMode { cudaStreamCaptureModeRelaxed = 2 };
struct cudaGraphExecUpdateResultInfo {
  int result;
};
cudaError_t cudaStreamBeginCapture(cudaStream_t stream, cudaStreamCaptureMode mode);
cudaError_t cudaStreamEndCapture(cudaStream_t stream, cudaGraph_t* graph);
cudaError_t cudaGraphInstantiate(cudaGraphExec_t* made, cudaGraph_t graph, unsigned long long flags);
cudaError_t cudaGraphExecUpdate(cudaGraphExec_t made, cudaGraph_t graph, cudaGraphExecUpdateResultInfo* result);
cudaError_t cudaGraphLaunch(cudaGraphExec_t made, cudaStream_t stream);
cudaError_t cudaGraphDestroy(cudaGraph_t graph);
cudaError_t cudaGraphExecDestroy(cudaGraphExec_t made);

/// Puts work behind what the stream was given before. `kind` says what it is: a graph is updated only by work of the same kinds.
cudaError_t emulated_give(cudaStream_t stream, const std::string& kind, std::function<void()> work);

struct cudaLaunchConfig_t {
  dim3 gridDim, blockDim;
  std::size_t dynamicSmemBytes = 0;
  cudaStream_t stream = nullptr;
};

template <class... Parameters, class... Arguments>
cudaError_t cudaLaunchKernelEx(const cudaLaunchConfig_t* config, void (*kernel)(Parameters...), Arguments&&... arguments) {
  // The name of the kernel and of its body, as the compiler spells them.
  const std::string name = gdesp::emulated::kernel_name(__PRETTY_FUNCTION__);
  (gdesp::emulated::refuse_host_addresses(name, arguments), ...);
  const unsigned blocks = config->gridDim.x, threads = config->blockDim.x;
  return emulated_give(config->stream, name, [=] {
    gdesp::emulated::run_kernel(name, blocks, threads, [&] { kernel(arguments...); });
  });
}

// What a thread sees of itself; changes whenever the scheduler goes on with another.
inline const gdesp::emulated::Index3& threadIdx = gdesp::emulated::place.thread;
inline const gdesp::emulated::Index3& blockIdx = gdesp::emulated::place.block;
inline const gdesp::emulated::Index3& blockDim = gdesp::emulated::place.threads;

inline void __syncthreads() { gdesp::emulated::meet_block(); }
// Warp primitives. Each returns when all lanes of its mask have come to the same one.
inline void __syncwarp(unsigned mask = 0xffffffffu) { gdesp::emulated::meet(gdesp::emulated::Meeting::sync, mask, 0); }
template <class T>
T __shfl_xor_sync(unsigned mask, T value, int with) {
  static_assert(sizeof(T) == 4);
  const unsigned* all = gdesp::emulated::meet(gdesp::emulated::Meeting::exchange, mask, std::bit_cast<unsigned>(value));
  return std::bit_cast<T>(gdesp::emulated::of_lane(all, mask, gdesp::emulated::lane() ^ with));
}
template <class T>
T __shfl_sync(unsigned mask, T value, int from) {
  static_assert(sizeof(T) == 4);
  const unsigned* all = gdesp::emulated::meet(gdesp::emulated::Meeting::exchange, mask, std::bit_cast<unsigned>(value));
  return std::bit_cast<T>(gdesp::emulated::of_lane(all, mask, from & 31));
}
inline unsigned __ballot_sync(unsigned mask, int holds) {
  const unsigned* all = gdesp::emulated::meet(gdesp::emulated::Meeting::vote, mask, holds != 0);
  unsigned bits = 0;
  for (int lane = 0; lane < 32; ++lane) bits |= ((mask >> lane) & 1u) && all[lane] ? 1u << lane : 0u;
  return bits;
}
inline int __any_sync(unsigned mask, int holds) { return __ballot_sync(mask, holds) != 0; }

// One block runs after the other and one lane at a time, so that plain sums are atomic.
template <class T>
T atomicAdd(T* sum, T by) {
  const T before = *sum;
  *sum += by;
  return before;
}
inline int atomicMax(int* largest, int value) {
  const int before = *largest;
  if (value > before) *largest = value;
  return before;
}
inline int __float_as_int(float a) { return std::bit_cast<int>(a); }
