// SPDX-License-Identifier: GPL-3.0-or-later
// How grains and water are averaged over each other: through the nodes of a lattice, which both see with a cubic B-spline.
// @eq coupling.averaging
//   W_ia = sum_n S_n(r_i) S_n(r_a) / V_n,  S_n(r) = B(x) B(y) B(z) with (x, y, z) = (r - r_n)/spacing of the nodes,
//   B(s) = [max(2 - |s|, 0)^3 - 4 max(1 - |s|, 0)^3]/6; S_n = 0 beyond 2.25 spacings, where it is below 2e-4. V_n: volume of
//   a node [m3]; W [1/m3].
//   Splines add up to one and carry linear functions exactly (but for those corners, 1e-3 at most): sum_a V_a W_ia = 1 in
//   filled space. W has the spread of the
//   Wendland kernel of length h_c (variance 4/15 h_c^2 along each axis in space, 5/18 h_c^2 in the plane) when the spacing of
//   the nodes is sqrt(2/5) h_c, in the plane sqrt(5/12) h_c. A sum over neighbours inside 2 h_c = 6 h takes 2000 to 3000
//   pairs a particle; through the nodes it takes 64 and 64.
//   Source: cubic B-splines between particles and a lattice: Hockney and Eastwood (1988), Computer Simulation Using
//   Particles, section 5-3; smoothing of particle volumes over a length of several grains: Robinson, Ramaioli, Luding
//   (2014), doi:10.1016/j.ijmultiphaseflow.2013.11.003. The choice of spacing is own.
#pragma once

#include <cmath>

#include "core/host_device.hpp"
#include "core/real.hpp"
#include "core/vec3.hpp"

namespace gdesp::coupling {

/// Spacings of nodes beyond which a node has no weight.
inline constexpr float spline_reach = 2.25f;

/// m, between nodes, for the spread of a Wendland kernel of smoothing length `h_c` (m).
inline double node_spacing(double h_c, int dimensions) {
  return h_c * std::sqrt(dimensions == 2 ? 5.0 / 12.0 : 2.0 / 5.0);
}

/// B(s).
template <class Real>
GDESP_HD inline Real cubic_spline(const Real& s) {
  using real::max;
  const Real q = max(s, -s), a = max(Real(2.0f) - q, Real(0.0f)), b = max(Real(1.0f) - q, Real(0.0f));
  return (a * a * a - Real(4.0f) * b * b * b) * Real(1.0f / 6.0f);
}

/// dB/ds.
template <class Real>
GDESP_HD inline Real cubic_spline_slope(const Real& s) {
  using real::max;
  using real::select;
  const Real q = max(s, -s), a = max(Real(2.0f) - q, Real(0.0f)), b = max(Real(1.0f) - q, Real(0.0f));
  const Real slope = (a * a - Real(4.0f) * b * b) * Real(0.5f);
  return select(s < Real(0.0f), slope, -slope);
}

/// S_n of one lattice.
struct AveragingSpline {
  Vec3f inverse_spacing;  ///< 1/m
  float inverse_volume;   ///< 1/V_n: 1/m3, in the plane 1/m2
  bool plane;             ///< y has no part in it

  template <class Real>
  struct Gradient {
    Real x, y, z;
  };  // 1/m

  /// S of a place at (x, y, z) from the node, m.
  template <class Real>
  GDESP_HD Real weight(const Real& x, const Real& y, const Real& z) const {
    using real::select;
    const Real sx = x * Real(inverse_spacing.x), sz = z * Real(inverse_spacing.z);
    Real w = cubic_spline(sx) * cubic_spline(sz), distance2 = sx * sx + sz * sz;
    if (!plane) {
      const Real sy = y * Real(inverse_spacing.y);
      w = w * cubic_spline(sy);
      distance2 += sy * sy;
    }
    return select(distance2 < Real(spline_reach * spline_reach), w, Real(0.0f));
  }

  /// Also its gradient at that place.
  template <class Real>
  GDESP_HD Real weight(const Real& x, const Real& y, const Real& z, Gradient<Real>& gradient) const {
    using real::select;
    const Real zero(0.0f), one(1.0f);
    const Real sx = x * Real(inverse_spacing.x), sy = plane ? zero : y * Real(inverse_spacing.y),
               sz = z * Real(inverse_spacing.z);
    const Real within = select(sx * sx + sy * sy + sz * sz < Real(spline_reach * spline_reach), one, zero);
    const Real wx = cubic_spline(sx) * within, wy = plane ? one : cubic_spline(sy), wz = cubic_spline(sz);
    const Real xy = wx * wy, zx = wz * wx;
    gradient.x = cubic_spline_slope(sx) * within * wy * wz * Real(inverse_spacing.x);
    gradient.y = plane ? zero : cubic_spline_slope(sy) * zx * Real(inverse_spacing.y);
    gradient.z = cubic_spline_slope(sz) * xy * Real(inverse_spacing.z);
    return xy * wz;
  }
};

}  // namespace gdesp::coupling
