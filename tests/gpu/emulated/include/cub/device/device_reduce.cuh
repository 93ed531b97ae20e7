// SPDX-License-Identifier: GPL-3.0-or-later
// Stands in for CUB on the emulated device.
#pragma once

#include "cuda_runtime.h"

namespace cub {

/// Bytes of scratch asked for; the whole of it is written to, as CUB may.
inline constexpr std::size_t emulated_scratch_bytes = 1024;

struct DeviceReduce {
  /// combine over all values and `start`, in 256 interleaved parts: another order than the processor's.
  template <class Values, class T, class Combine>
  static cudaError_t Reduce(void* scratch, std::size_t& bytes, Values values, T* result, int count, Combine combine,
                            T start, cudaStream_t stream) {
    if (!scratch) {
      bytes = emulated_scratch_bytes;
      return cudaSuccess;
    }
    gdesp::emulated::refuse_host_addresses("DeviceReduce", values);
    return emulated_give(stream, "DeviceReduce", [=] {
      std::memset(scratch, 0x7f, emulated_scratch_bytes);
      constexpr int parts = 256;
      T total = start;
      for (int part = 0; part < parts && part < count; ++part) {
        T sum = values[part];
        for (int i = part + parts; i < count; i += parts) sum = combine(sum, values[i]);
        total = combine(total, sum);
      }
      *result = total;
    });
  }
};

}  // namespace cub
