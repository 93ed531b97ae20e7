// SPDX-License-Identifier: GPL-3.0-or-later
// The functions that laws written on a generic real type use instead of branches. Laws say `using real::max;` and
// so on: plain floats find these, lane types (exec/lanes.hpp) bring their own.
#pragma once

#include <cmath>

#include "core/host_device.hpp"

namespace gdesp::real {

GDESP_HD inline float max(float a, float b) { return a > b ? a : b; }
GDESP_HD inline float min(float a, float b) { return a < b ? a : b; }
GDESP_HD inline float floor(float a) { return ::floorf(a); }
// Rounding a root or a quotient exactly takes a device some ten instructions; its own approximations err by one unit in the
// last place (CUDA C++ Programming Guide, PTX ISA: sqrt.approx, rcp.approx) and are one, as exec/lanes.hpp does on the CPU.
/// To one unit in the last place.
GDESP_HD inline float sqrt(float a) {
#if defined(__CUDA_ARCH__)
  float root;
  asm("sqrt.approx.f32 %0, %1;" : "=f"(root) : "f"(a));
  return root;
#else
  return ::sqrtf(a);
#endif
}
/// 1/a for a neither zero, infinite nor subnormal; to one unit in the last place.
GDESP_HD inline float reciprocal(float a) {
#if defined(__CUDA_ARCH__)
  float quotient;
  asm("rcp.approx.f32 %0, %1;" : "=f"(quotient) : "f"(a));
  return quotient;
#else
  return 1.0f / a;
#endif
}
/// 1/sqrt(a) for a of at least 1e-37; to one unit in the last place.
GDESP_HD inline float inverse_sqrt(float a) {
#if defined(__CUDA_ARCH__)
  const float guess = ::rsqrtf(a);  // two units; a step of Newton's
  return ::fmaf(::fmaf(-a * guess, guess, 1.0f), 0.5f * guess, guess);
#else
  return 1.0f / ::sqrtf(a);
#endif
}
GDESP_HD inline float select(bool c, float a, float b) { return c ? a : b; }

}  // namespace gdesp::real
