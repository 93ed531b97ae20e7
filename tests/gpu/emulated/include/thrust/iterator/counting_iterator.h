// SPDX-License-Identifier: GPL-3.0-or-later
// Stands in for Thrust on the emulated device.
#pragma once

namespace thrust {

template <class T>
struct counting_iterator {
  T first;
  explicit counting_iterator(T start) : first(start) {}
  T operator[](T i) const { return first + i; }
};

}  // namespace thrust
