// SPDX-License-Identifier: GPL-3.0-or-later
// @eq sph.wall.extrapolation
//   P_w = ( sum_f P_f W_wf + (g - a_w) . sum_f rho_f (r_w - r_f) W_wf ) / sum_f W_wf;  rho_w from max(P_w, 0) by the Tait law.
//   P_w: pressure of a wall particle [Pa], f: fluid particles, a_w: acceleration of the wall [m/s2]. A wall does not pull:
//   in a pair P_w counts as max(min(P_w, 4 P_w), min(0, -P_f)). (Cut at zero whatever P_f, a wall above still water pushes
//   the water at the shore down the slope; not fourfold below zero, it pushes the rows below the surface off the wall, against air.) Source: Adami, Hu, Adams (2012), J. Comput. Phys. 231, 7057, eqs 27-28,
//   doi:10.1016/j.jcp.2012.05.005.
// @eq sph.wall.no-slip
//   v_ghost = v_w + s (v_w - <v_f>),  s = min(depth/(<(r_f - r_w) . n> - depth), 3),  <x> = sum_f x_f W_wf / sum_f W_wf;
//   seen by the viscosity alone; continuity sees v_w. v_w: velocity of the wall [m/s], f: fluid particles, n, depth [m]: of the wall particle
//   below the surface, so that the velocity is linear across the surface and the wall's there. s = 1 where the normal is unknown.
//   Sources: <v_f>: Adami, Hu, Adams (2012), eqs 22-23, with s = 1; s of distances: Morris, Fox, Zhu (1997),
//   doi:10.1006/jcph.1997.5776, pair by pair and at most 1.5 (docs/decisions/0054).
#pragma once

#include "core/host_device.hpp"
#include "core/real.hpp"
#include "sph/wendland_c2.hpp"

namespace gdesp::sph {

template <class Real>
struct WallSums {
  Real weight{0.0f};                  ///< sum W / alpha
  Real pressure{0.0f};                ///< sum A_f W / alpha
  Real rx{0.0f}, ry{0.0f}, rz{0.0f};  ///< sum (r_w - r_f) W / alpha, m
  Real vx{0.0f}, vy{0.0f}, vz{0.0f};  ///< sum v_f W / alpha, m/s; of no-slip walls
};

/// A of a wall particle as water of A_f feels it: not so far below zero that the pair is pulled together.
template <class Real>
GDESP_HD inline Real pressing_wall(const Real& A_w, const Real& A_f) {
  using real::max;
  using real::min;
  return max(min(A_w, Real(4.0f) * A_w), min(Real(0.0f), Real(0.0f) - A_f));
}

/// s of sph.wall.no-slip; `reach`: <(r_f - r_w) . n> (m), 0 without a normal.
GDESP_HD inline float no_slip_share(float depth, float reach) {
  if (!(depth > 0.0f && reach > 0.0f)) return 1.0f;
  return depth < 3.0f * (reach - depth) ? depth / (reach - depth) : 3.0f;
}

/// Adds fluid particle f. r = r_w - r_f. Returns W / alpha.
template <class Real>
GDESP_HD inline Real add_wall_pair(float inverse_support, const Real& rx, const Real& ry, const Real& rz,
                                   const Real& A_f, WallSums<Real>& sums) {
  const Real w = wendland_at(inverse_support, rx, ry, rz);
  sums.weight += w;
  sums.pressure += w * A_f;
  sums.rx += w * rx;
  sums.ry += w * ry;
  sums.rz += w * rz;
  return w;
}

}  // namespace gdesp::sph
