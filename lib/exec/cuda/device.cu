// SPDX-License-Identifier: GPL-3.0-or-later
// Memory, devices and scratch of the CUDA back end. Plain allocations only: no managed memory.
#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "exec/array.hpp"
#include "exec/batch.hpp"
#include "exec/cuda/parallel.cuh"

namespace gdesp::exec {

bool cuda_built() { return true; }

std::vector<DeviceInfo> cuda_devices() {
  int count = 0;
  if (cudaGetDeviceCount(&count) != cudaSuccess) {
    cudaGetLastError();
    return {};
  }
  std::vector<DeviceInfo> devices;
  for (int k = 0; k < count; ++k) {
    cudaDeviceProp properties;
    if (cudaGetDeviceProperties(&properties, k) != cudaSuccess) continue;
    devices.push_back(
        {k, properties.name, static_cast<double>(properties.totalGlobalMem), 10 * properties.major + properties.minor});
  }
  return devices;
}

Cuda take_cuda_device(int number) {
  const std::vector<DeviceInfo> devices = cuda_devices();
  if (devices.empty()) {
    throw Error(ErrorKind::resource, "no CUDA device is seen (no GPU, or no driver); use --device cpu");
  }
  if (number < 0 || number >= static_cast<int>(devices.size())) {
    throw Error(ErrorKind::resource, "CUDA device " + std::to_string(number) + " does not exist; seen: 0.." +
                                         std::to_string(devices.size() - 1));
  }
  check(cudaSetDevice(number), "taking the device");
  cudaStream_t stream;
  check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "making a stream");
  return Cuda{stream};
}

namespace detail {

void note_allocation(std::size_t bytes);
void note_release(std::size_t bytes);

void* allocate(const Cuda& exec, std::size_t bytes) {
  if (bytes == 0) return nullptr;
  void* p = nullptr;
  const cudaError_t code = cudaMalloc(&p, bytes);
  if (code != cudaSuccess) {
    cudaGetLastError();
    std::size_t free_bytes = 0, total = 0;
    cudaMemGetInfo(&free_bytes, &total);
    throw Error(ErrorKind::resource, "GPU memory: " + std::to_string(bytes >> 20) + " MiB wanted, " +
                                         std::to_string(free_bytes >> 20) + " MiB free of " +
                                         std::to_string(total >> 20) + " MiB; a larger resolution.dp needs less");
  }
  check(cudaMemsetAsync(p, 0, bytes, stream(exec)), "clearing memory");
  note_allocation(bytes);
  return p;
}
void release(const Cuda& exec, void* p, std::size_t bytes) {
  if (!p) return;
  cudaStreamSynchronize(stream(exec));
  cudaFree(p);
  note_release(bytes);
}
void copy_to_host(const Cuda& exec, void* to, const void* from, std::size_t bytes) {
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, stream(exec)), "copying from the GPU");
  synchronize(exec);
}
void copy_from_host(const Cuda& exec, void* to, const void* from, std::size_t bytes) {
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, stream(exec)), "copying to the GPU");
  synchronize(exec);
}
void fill_bytes(const Cuda& exec, void* p, int value, std::size_t bytes) {
  check(cudaMemsetAsync(p, value, bytes, stream(exec)), "filling memory");
}

namespace {
struct Scratch {
  void* data = nullptr;
  std::size_t bytes = 0;
  void* grow(const Cuda& exec, std::size_t wanted) {
    if (wanted > bytes) {
      release(exec, data, bytes);
      data = nullptr;
      bytes = 0;
      data = allocate(exec, wanted + wanted / 4);
      bytes = wanted + wanted / 4;
    }
    return data;
  }
};
}  // namespace

void* cub_scratch(const Cuda& exec, std::size_t bytes) {
  thread_local Scratch scratch;
  return scratch.grow(exec, std::max<std::size_t>(bytes, 1));
}
void* result_slot(const Cuda& exec, std::size_t bytes) {
  thread_local Scratch scratch;
  return scratch.grow(exec, std::max<std::size_t>(bytes, 256));
}

// A captured batch differs from the one before in pointers and counts as a rule, so that the graph at hand is updated;
// when its number of passes differs too, it is made anew.
bool begin_capture(const Cuda& exec) {
  static const bool wanted = [] {
    const char* set = std::getenv("GDESP_CUDA_GRAPHS");
    return !set || std::string_view(set) != "0";
  }();
  // Relaxed: kernels that are loaded when they are first used may allocate.
  if (wanted) check(cudaStreamBeginCapture(stream(exec), cudaStreamCaptureModeRelaxed), "capturing a batch");
  return wanted;
}
void drop_capture(const Cuda& exec) {
  cudaGraph_t captured = nullptr;
  cudaStreamEndCapture(stream(exec), &captured);
  if (captured) cudaGraphDestroy(captured);
  cudaGetLastError();
}
void launch_captured(const Cuda& exec, void*& graph) {
  cudaGraph_t captured = nullptr;
  check(cudaStreamEndCapture(stream(exec), &captured), "capturing a batch");
  auto ready = static_cast<cudaGraphExec_t>(graph);
  cudaGraphExecUpdateResultInfo result;
  if (ready && cudaGraphExecUpdate(ready, captured, &result) != cudaSuccess) {
    cudaGetLastError();
    cudaGraphExecDestroy(ready);
    ready = nullptr;
  }
  const cudaError_t made = ready ? cudaSuccess : cudaGraphInstantiate(&ready, captured, 0);
  cudaGraphDestroy(captured);
  graph = made == cudaSuccess ? ready : nullptr;
  check(made, "making a graph of a batch");
  check(cudaGraphLaunch(ready, stream(exec)), "giving a batch");
}
void forget_graph(const Cuda& exec, void* graph) {
  if (!graph) return;
  cudaStreamSynchronize(stream(exec));
  cudaGraphExecDestroy(static_cast<cudaGraphExec_t>(graph));
}

}  // namespace detail
}  // namespace gdesp::exec
