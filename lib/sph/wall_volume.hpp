// SPDX-License-Identifier: GPL-3.0-or-later
// @eq sph.wall.volume
//   added to D rho_f/Dt of sph.continuity, at extrapolated walls:   -(rho_f/V_f) sum_w omega_wf V_w E_w,
//     E_w = -sum_f V_f (v_f - v_w - u_w) . grad_f W_wf,   u_w = <v_f - v_w> - (<v_f - v_w> . n) n,   omega_wf = W_wf / sum_f W_wf.
//     <x> = sum_f omega_wf s_f x_f,  s_f = max(0, 1 - 5 (1 - eps_f)).
//   E_w: rate of expansion of the water as the wall particle w measures it [1/s]; u_w: mean velocity at which water slides past w [m/s]; n: unit
//   normal of the wall at w, u_w = 0 where it is unknown; eps: porosity; rho [kg/m3]; V [m3]; v [m/s]; W [1/m3].
//   In sph.momentum the wall's share, V_f V_w P_w grad W, does work that sph.continuity, which sees the wall's velocity, does not take from
//   the water's compression: films, edges and water between grains are given energy. P_w is a mean of the water's pressures with the
//   weights omega_wf (sph.wall.extrapolation): the adjoint of that mean shares the volume out, so that what P_w gives to the water's motion it takes
//   from the water's compression. u_w is left out: over an even wall its work comes back by itself, and kept in it lets water feel the wall's
//   particles one by one (friction fivefold). Between grains it does not come back, but throws the water about (docs/decisions/0056).
//   Source: own construction; adjoint operators in the same service: Bonet, Lok (1999), Comput. Methods Appl. Mech. Eng. 180, 97,
//   doi:10.1016/S0045-7825(99)00051-1.
#pragma once

#include "core/host_device.hpp"
#include "core/real.hpp"
#include "sph/pressure_and_viscosity.hpp"
#include "sph/wendland_c2.hpp"

namespace gdesp::sph {

/// What water around a wall particle adds up to; G, B: sph.momentum.
template <class Real>
struct WallVolumeSums {
  Real weight{0.0f};                  ///< sum W / alpha
  Real compression{0.0f};             ///< -sum G B_f v_wf . r_wf, 1/s
  Real vx{0.0f}, vy{0.0f}, vz{0.0f};  ///< sum s_f v_wf W / alpha, m/s
  Real gx{0.0f}, gy{0.0f}, gz{0.0f};  ///< sum G B_f r_wf, 1/m
};

/// Adds fluid particle f, with its porosity. r = r_w - r_f (m), v = v_w - v_f (m/s).
template <class Real>
GDESP_HD inline void add_wall_volume(const FluidPairLaw& law, const Real (&r)[3], const Real (&v)[3], const Real& B_f,
                                     const Real& porosity, WallVolumeSums<Real>& sums) {
  using real::max;
  using real::sqrt;
  const Real t =
      max(Real(0.0f), Real(1.0f) - sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]) * Real(law.inverse_support));
  const Real w = wendland_shape(t), G = Real(law.slope) * B_f * wendland_slope_shape(t);
  sums.weight += w;
  sums.compression -= G * (v[0] * r[0] + v[1] * r[1] + v[2] * r[2]);
  const Real slides = w * max(Real(0.0f), Real(1.0f) - Real(5.0f) * (Real(1.0f) - porosity));
  sums.vx += slides * v[0];
  sums.vy += slides * v[1];
  sums.vz += slides * v[2];
  sums.gx += G * r[0];
  sums.gy += G * r[1];
  sums.gz += G * r[2];
}

/// -V_w E_w / (V0 sum W / alpha), 1/s: times W_wf / alpha and V0/V_f, what fluid particle f is compressed by. n: normal, or zero;
/// B_w = V_w/V0.
template <class Real>
GDESP_HD inline Real wall_volume(const WallVolumeSums<Real>& sums, const Real (&n)[3], const Real& B_w) {
  using real::max;
  using real::reciprocal;
  const Real per_weight = reciprocal(max(sums.weight, Real(1.0e-6f)));
  const Real known = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  const Real along = sums.vx * n[0] + sums.vy * n[1] + sums.vz * n[2];
  const Real slides = (known * sums.vx - along * n[0]) * sums.gx + (known * sums.vy - along * n[1]) * sums.gy +
                      (known * sums.vz - along * n[2]) * sums.gz;
  return B_w * per_weight * (sums.compression + per_weight * slides);
}

}  // namespace gdesp::sph
