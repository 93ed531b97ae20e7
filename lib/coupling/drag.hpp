// SPDX-License-Identifier: GPL-3.0-or-later
// Drag of the fluid on one grain, as coefficient [kg/s]: force = coefficient (u - v), u the fluid's, v the grain's
// velocity. Per volume of grain, so that rods (two dimensions) and coarse grains take the same laws:
//   coefficient = V K(eps, |u - v|, d).
// @eq coupling.drag.ergun-wen-yu
//   K = 150 (1 - eps) mu/(eps d^2) + 1.75 rho |u - v|/d                       for eps <= 0.8 (Ergun 1952)
//   K = 0.75 C_d eps rho |u - v| eps^-2.65 / d                                for eps > 0.8 (Wen and Yu 1966)
//   C_d = 24/Re (1 + 0.15 Re^0.687) for Re <= 1000, 0.44 above; Re = rho d eps |u - v| / mu.
//   eps: porosity; mu [Pa s]; rho [kg/m3]; d: diameter [m]. Equations 11, 14-16 of the paper (beta/(1 - eps)), the
//   first term of 14 with mu instead of the printed rho. Source: Tsuji, Kawaguchi, Tanaka (1993), Powder Technol. 77,
//   79, doi:10.1016/0032-5910(93)85010-7.
// @eq coupling.drag.di-felice
//   force [N] = C_d pi d^2 rho |u_s| u_s eps^-xi / 8, u_s = eps (u - v), Re = |u_s| d rho/mu,
//   C_d = (0.63 + 4.8/sqrt(Re))^2, xi = 3.7 - 0.65 exp(-(1.5 - log10 Re)^2/2).
//   Source: Di Felice (1994), Int. J. Multiphase Flow 20, 153, doi:10.1016/0301-9322(94)90011-6; drag coefficient of
//   Dallavalle (1948). Coded with |u_s| C_d = (mu/(rho d)) (0.63 sqrt(Re) + 4.8)^2: finite at rest.
// The relaxation itself, implicit in each sub-step of the grains: dem.motion.drag.
#pragma once

#include <cmath>

#include "core/host_device.hpp"

namespace gdesp::coupling {

/// What surrounds a grain.
struct DragState {
  float porosity;   ///< eps, 0..1
  float slip;       ///< m/s, |u - v|
  float diameter;   ///< m, of the real grain
  float density;    ///< kg/m3, fluid
  float viscosity;  ///< Pa s, dynamic
};

/// K of the Ergun / Wen-Yu pair, kg/(s m3).
GDESP_HD inline float ergun_wen_yu_drag(const DragState& s) {
  const float d = s.diameter;
  if (s.porosity <= 0.8f) {
    return 150.0f * (1.0f - s.porosity) * s.viscosity / (s.porosity * d * d) + 1.75f * s.density * s.slip / d;
  }
  const float reynolds = s.density * d * s.porosity * s.slip / s.viscosity;
  // C_d |u - v|, finite at rest.
  const float cd_slip = reynolds <= 1000.0f ? 24.0f * s.viscosity / (s.density * d * s.porosity) *
                                                  (1.0f + 0.15f * ::powf(reynolds, 0.687f))
                                            : 0.44f * s.slip;
  return 0.75f * cd_slip * s.porosity * s.density * ::powf(s.porosity, -2.65f) / d;
}

/// K of Di Felice, kg/(s m3).
GDESP_HD inline float di_felice_drag(const DragState& s) {
  const float d = s.diameter;
  const float superficial = s.porosity * s.slip;
  const float reynolds = s.density * d * superficial / s.viscosity;
  const float root = 0.63f * ::sqrtf(reynolds) + 4.8f;
  const float cd_speed = s.viscosity / (s.density * d) * root * root;
  const float away = 1.5f - ::log10f(reynolds > 1.0e-12f ? reynolds : 1.0e-12f);
  const float xi = 3.7f - 0.65f * ::expf(-0.5f * away * away);
  // Force / (u - v) / (pi d^3 / 6).
  return 0.75f * cd_speed * s.density * ::powf(s.porosity, 1.0f - xi) / d;
}

}  // namespace gdesp::coupling
