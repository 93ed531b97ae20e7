// SPDX-License-Identifier: GPL-3.0-or-later
// @eq sph.eos.tait
//   P = (rho0 c^2 / gamma) ((rho/rho0)^gamma - 1),  gamma = 7.
//   P: pressure [Pa]; rho: true density [kg/m3]; rho0: reference density [kg/m3]; c: speed of sound at rho0 [m/s].
//   Valid for |rho/rho0 - 1| of some per cent, that is c at least ten times the largest speed.
//   Source: eqs 7-8 of the paper; Monaghan (1994), J. Comput. Phys. 110, 399, doi:10.1006/jcph.1994.1034.
//   Coded for D = rho/rho0 - 1 and A = P/(rho0 c^2), as the exact polynomial: no cancellation at small D.
#pragma once

#include <cmath>

#include "core/host_device.hpp"

namespace gdesp::sph {

/// A(D).
GDESP_HD inline float tait_pressure(float D) {
  return D * (1.0f + D * (3.0f + D * (5.0f + D * (5.0f + D * (3.0f + D * (1.0f + D * (1.0f / 7.0f)))))));
}

/// D(A), the inverse; A >= -1/7.
GDESP_HD inline float tait_density(float A) {
  const float base = 1.0f + 7.0f * A;
  return base > 0.0f ? ::expm1f(::log1pf(7.0f * A) * (1.0f / 7.0f)) : -1.0f;
}

}  // namespace gdesp::sph
