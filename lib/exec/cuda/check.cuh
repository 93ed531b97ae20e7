// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cuda_runtime.h>

#include <string>

#include "core/error.hpp"

namespace gdesp::exec {

/// Throws Error(resource) when a CUDA call failed; `what` says what was being done.
inline void check(cudaError_t code, const char* what) {
  if (code != cudaSuccess) {
    throw Error(ErrorKind::resource, std::string("GPU: ") + what + ": " + cudaGetErrorString(code));
  }
}

}  // namespace gdesp::exec
