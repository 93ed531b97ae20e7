// SPDX-License-Identifier: GPL-3.0-or-later
// The factor of Wendland's C2 function, W(r) = alpha (1 - q/2)^4 (1 + 2 q), q = r/h in [0, 2] (Wendland 1995, Adv. Comput.
// Math. 4, 389-396, doi:10.1007/BF02123482), so that its integral over space is one: the solver's kernel, the analysis'
// weight and the filling of water share it.
#pragma once

#include <numbers>

namespace gdesp {

/// alpha, 1/m^dimensions: 7/(4 pi h^2) in two dimensions, 21/(16 pi h^3) in three. h: m.
inline double wendland_normalisation(double h, int dimensions) {
  return dimensions == 2 ? 7.0 / (4.0 * std::numbers::pi * h * h) : 21.0 / (16.0 * std::numbers::pi * h * h * h);
}

}  // namespace gdesp
