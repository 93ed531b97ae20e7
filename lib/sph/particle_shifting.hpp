// SPDX-License-Identifier: GPL-3.0-or-later
// @eq sph.shifting
//   dr_i = -k h u dt f_i grad C_i,  grad C_i = sum_j V_j grad W_ij,  u = max_j |v_j|,  |dr_i| <= 0.4 u dt
//   moves particles from where they are close together to where they are apart: k: coefficient [1], about 20; h: smoothing
//   length [m]; u: largest speed of the water [m/s]; dt: step [s]; grad C: of the concentration of particles [1/m], walls
//   included. (Tried for u: |v_i| of Skillen et al., which vanishes at stagnation points, where strain is largest; the
//   largest |v_ij| in the support, with which the error does not fall with dp.)
//   f = max(0, 1 - 2 q), q = max (1 - |r_ij|/(2h)) over the particles j of the free surface (q = 0: none within 2h, 1:
//   i is one): near the surface the gradient points outwards, and would make the water swell. j is of the surface when
//   the divergence of the positions D_j = -sum_k V_k r_jk . grad W_jk, d inside water of d dimensions, is below 0.75 d.
//   Still water is not shifted. Valid where spacing changes by less than itself a step.
//   Source: Lind, Xu, Stansby, Rogers (2012), J. Comput. Phys. 231, 1499, doi:10.1016/j.jcp.2011.10.027; in the form of
//   Skillen, Lind, Stansby, Rogers (2013), Comput. Methods Appl. Mech. Eng. 265, 163, doi:10.1016/j.cma.2013.05.017;
//   surface by D: Lee et al. (2008), J. Comput. Phys. 227, 8417, doi:10.1016/j.jcp.2008.06.005.
// @eq sph.tensile-control
//   P_i + P_j [Pa] of sph.momentum = P_j - P_i where P_i < 0 and i is not near the free surface
//   (q < 1/2, sph.shifting): the term whose sum vanishes on a regular lattice changes its sign, so that tension no longer draws
//   particles together into clumps. Linear momentum is kept to the order of the method only, not to round-off.
//   Source: Sun, Colagrossi, Marrone, Antuono, Zhang (2018), Comput. Phys. Commun. 224, 63,
//   doi:10.1016/j.cpc.2017.11.016.
#pragma once

#include "core/host_device.hpp"
#include "core/real.hpp"
#include "core/vec3.hpp"

namespace gdesp::sph {

template <class Real>
struct SpacingSums {
  Real x{0.0f}, y{0.0f}, z{0.0f};  ///< -grad C_i, 1/m
  Real divergence{0.0f};           ///< D_i
};

/// Adds particle j: r = r_i - r_j (m); volume_slope: V0 5 alpha/h^2 (1/m2); B_j: its volume over V0.
template <class Real>
GDESP_HD inline void add_spacing_pair(float inverse_support, float volume_slope, const Real (&r)[3], const Real& B_j,
                                      SpacingSums<Real>& sums) {
  using real::max;
  using real::sqrt;
  const Real r2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
  const Real t = max(Real(0.0f), Real(1.0f) - sqrt(r2) * Real(inverse_support));
  const Real G = Real(volume_slope) * B_j * t * t * t;
  sums.x += G * r[0];
  sums.y += G * r[1];
  sums.z += G * r[2];
  sums.divergence += G * r2;
}

/// Share of d below which D marks the free surface.
inline constexpr float surface_divergence = 0.75f;

/// Displacement (m) in a step dt (s); away: -grad C (1/m), near_surface: q, speed: u (m/s), strength: k h (m).
GDESP_HD inline Vec3f shift_of(const Vec3f& away, float near_surface, float speed, float strength, float dt) {
  const float inside = real::max(1.0f - 2.0f * near_surface, 0.0f);
  const float path = speed * dt;
  const Vec3f shift = away * (strength * path * inside);
  const float length = norm(shift), most = 0.4f * path;
  return length > most ? shift * (most / length) : shift;
}

/// P_i as the momentum equation of i takes it (any unit).
GDESP_HD inline float controlled_pressure(float P, float near_surface) {
  return P < 0.0f && near_surface < 0.5f ? -P : P;
}

}  // namespace gdesp::sph
