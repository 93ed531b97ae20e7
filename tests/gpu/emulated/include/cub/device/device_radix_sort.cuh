// SPDX-License-Identifier: GPL-3.0-or-later
// Stands in for CUB on the emulated device.
#pragma once

#include <algorithm>
#include <numeric>

#include "cub/device/device_reduce.cuh"

namespace cub {

template <class T>
struct DoubleBuffer {
  T* buffers[2];
  int selector = 0;
  DoubleBuffer(T* current, T* other) : buffers{current, other} {}
  T* Current() const { return buffers[selector]; }
  T* Alternate() const { return buffers[1 - selector]; }
};

struct DeviceRadixSort {
  /// Stable, by the bits [begin_bit, end_bit) of the keys. What was current is overwritten, as CUB may.
  template <class Key, class Value>
  static cudaError_t SortPairs(void* scratch, std::size_t& bytes, DoubleBuffer<Key>& keys, DoubleBuffer<Value>& values,
                               int count, int begin_bit, int end_bit, cudaStream_t stream) {
    if (!scratch) {
      bytes = emulated_scratch_bytes;
      return cudaSuccess;
    }
    const Key* keys_in = keys.Current();
    const Value* values_in = values.Current();
    keys.selector = 1 - keys.selector;
    values.selector = 1 - values.selector;
    return emulated_give(stream, "DeviceRadixSort", [=, keys_out = keys.Current(), values_out = values.Current()] {
      std::memset(scratch, 0x7f, emulated_scratch_bytes);
      const int bits = end_bit - begin_bit;
      const Key wanted = bits >= static_cast<int>(8 * sizeof(Key)) ? ~Key{0} : ((Key{1} << bits) - 1) << begin_bit;
      std::vector<int> order(static_cast<std::size_t>(count));
      std::iota(order.begin(), order.end(), 0);
      std::stable_sort(order.begin(), order.end(),
                       [&](int a, int b) { return (keys_in[a] & wanted) < (keys_in[b] & wanted); });
      for (int i = 0; i < count; ++i) {
        keys_out[i] = keys_in[order[static_cast<std::size_t>(i)]];
        values_out[i] = values_in[order[static_cast<std::size_t>(i)]];
      }
      std::memset(const_cast<Key*>(keys_in), 0x7f, static_cast<std::size_t>(count) * sizeof(Key));
      std::memset(const_cast<Value*>(values_in), 0x7f, static_cast<std::size_t>(count) * sizeof(Value));
    });
  }
};

}  // namespace cub
