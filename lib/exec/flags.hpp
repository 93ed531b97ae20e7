// SPDX-License-Identifier: GPL-3.0-or-later
// Flags that several bodies of a loop may set at once, to the same end.
#pragma once

#include <cstdint>

#include "core/host_device.hpp"

namespace gdesp::exec {

/// Sets a flag, whoever else sets it too.
template <class T>
GDESP_HD inline void set_flag(T* flag) {
#if defined(__CUDA_ARCH__)
  *flag = 1;
#else
  __atomic_store_n(flag, T{1}, __ATOMIC_RELAXED);
#endif
}

}  // namespace gdesp::exec
