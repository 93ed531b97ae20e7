// SPDX-License-Identifier: GPL-3.0-or-later
// @eq sph.kernel.wendland-c2
//   W(r) = alpha (1 - q/2)^4 (1 + 2 q),  q = r/h in [0, 2], zero beyond;
//   alpha = 21/(16 pi h^3) in three dimensions, 7/(4 pi h^2) in two.
//   r: distance [m]; h: smoothing length [m]; W [1/m^3, 1/m^2]. Integral over space 1.
//   Source: Wendland (1995), Adv. Comput. Math. 4, 389-396, doi:10.1007/BF02123482; constants as in Dehnen & Aly
//   (2012), MNRAS 425, 1068, doi:10.1111/j.1365-2966.2012.21439.x. (The 7/(8 pi h^3) printed as eq. 4 of the G-DeSp
//   paper does not integrate to one.)
//   Coded with t = max(0, 1 - r/(2h)): W = alpha t^4 (5 - 4 t);  (dW/dr)/r = -(5 alpha/h^2) t^3, smooth at r = 0:
//   no division, no cut-off test, and a particle adds nothing to itself.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/host_device.hpp"
#include "core/real.hpp"
#include "core/wendland.hpp"

namespace gdesp::sph {

using gdesp::wendland_normalisation;  // alpha

/// W / alpha at t.
template <class Real>
GDESP_HD inline Real wendland_shape(const Real& t) {
  const Real t2 = t * t;
  return t2 * t2 * (Real(5.0f) - Real(4.0f) * t);
}

/// W / alpha at r (m); inverse_support = 1/(2h).
template <class Real>
GDESP_HD inline Real wendland_at(float inverse_support, const Real& rx, const Real& ry, const Real& rz) {
  using real::max;
  using real::sqrt;
  return wendland_shape(max(Real(0.0f), Real(1.0f) - sqrt(rx * rx + ry * ry + rz * rz) * Real(inverse_support)));
}

/// -(dW/dr)/r * h^2/(5 alpha) at t; not negative.
template <class Real>
GDESP_HD inline Real wendland_slope_shape(const Real& t) {
  return t * t * t;
}

/// sum_j V0 (r_x^2) (-(dW/dr)/r) over a cubic lattice of spacing dp: what the gradient of a linear field comes out as,
/// 1 in the continuum limit. Dividing the gradient by it makes hydrostatics exact on the lattice (0.974 and 0.979 at
/// h = 1.3 dp in two and three dimensions, that is 2-3 % of every pressure otherwise).
inline double lattice_gradient_moment(double h_over_dp, int dimensions) {
  const int reach = static_cast<int>(2.0 * h_over_dp) + 1;
  const int reach_y = dimensions == 2 ? 0 : reach;
  double moment = 0.0;
  for (int x = -reach; x <= reach; ++x)
    for (int y = -reach_y; y <= reach_y; ++y)
      for (int z = -reach; z <= reach; ++z) {
        const double r = std::sqrt(static_cast<double>(x * x + y * y + z * z));
        const double t = std::max(0.0, 1.0 - r / (2.0 * h_over_dp));
        moment += t * t * t * x * x;
      }
  return moment * 5.0 * wendland_normalisation(h_over_dp, dimensions) / (h_over_dp * h_over_dp);
}

}  // namespace gdesp::sph
