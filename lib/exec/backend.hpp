// SPDX-License-Identifier: GPL-3.0-or-later
// The two execution back ends. A kernel source is compiled once by the host compiler, where CompiledBackend is
// OpenMP, and once by nvcc, where it is Cuda; both sets of symbols live in one library (docs/decisions/0001).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace gdesp::exec {

struct OpenMP {};

/// All work of one simulation is ordered on one stream (a cudaStream_t; void* keeps CUDA out of this header).
struct Cuda {
  void* stream = nullptr;
};

#if defined(__CUDACC__)
using CompiledBackend = Cuda;
#else
using CompiledBackend = OpenMP;
#endif

using Index = std::int32_t;

/// One CUDA device as the driver sees it.
struct DeviceInfo {
  int number = 0;
  std::string name;
  double memory_bytes = 0.0;
  int compute_capability = 0;  ///< 10 * major + minor
};

/// True when the CUDA back end was compiled in.
bool cuda_built();
/// The devices seen now; empty without a driver, a device, or the back end. Never throws.
std::vector<DeviceInfo> cuda_devices();
/// Takes the device for this process and returns its back end. Throws Error(resource) with the reason.
Cuda take_cuda_device(int number);
/// Sets the number of threads of the OpenMP back end (0: OMP_NUM_THREADS where it is set, else all cores) and returns it. Throws Error(usage) beyond 1024.
int set_threads(int threads);
/// Threads that wait for each other at the end of a loop spin for some 10 ms by default, which on a busy machine makes
/// two threads ten times slower than one; a tenth of a millisecond serves as well. The OpenMP runtime reads this once,
/// when a program starts: so the program (argv of main, as it came) starts again, unless the user has chosen
/// (GOMP_SPINCOUNT, OMP_WAIT_POLICY).
void wait_briefly(char** argv);

}  // namespace gdesp::exec
