// SPDX-License-Identifier: GPL-3.0-or-later
// The functions that laws written on a generic real type use instead of branches. Laws say `using real::max;` and
// so on: plain floats find these, lane types (exec/lanes.hpp) bring their own.
#pragma once

#include <cmath>

#include "core/host_device.hpp"

namespace gdesp::real {

GDESP_HD inline float max(float a, float b) { return a > b ? a : b; }
GDESP_HD inline float min(float a, float b) { return a < b ? a : b; }
GDESP_HD inline float sqrt(float a) { return ::sqrtf(a); }
/// 1/a for a neither zero, infinite nor subnormal; to one unit in the last place.
GDESP_HD inline float reciprocal(float a) { return 1.0f / a; }
/// 1/sqrt(a) for a of at least 1e-37; to one unit in the last place.
GDESP_HD inline float inverse_sqrt(float a) { return 1.0f / ::sqrtf(a); }
GDESP_HD inline float select(bool c, float a, float b) { return c ? a : b; }

}  // namespace gdesp::real
