// SPDX-License-Identifier: GPL-3.0-or-later
// @eq sph.wall.guard
//   A particle of water at distance s from the wall's true surface may approach it by half that distance a step at most:
//     v_n >= v_w,n - s/(2 dt)  for s > 0;   v_n >= v_w,n + min(max(0, -s - dp/10)/(10 dt), c/20)  for s <= 0.
//   s and the normal n are means over the wall particles near by, weighted by (1 - |r - f_w|/(2 dp))^6, of
//     s_w = (r - f_w) . n_w,   f_w = r_w + depth_w n_w,
//   f_w: the point of the surface that the wall particle lies below. The nearest piece of the surface decides at edges.
//   The weight has the factor max(0, min(1, max(2 - 2 |r - r_w|/dp, 1 + 5 s_w/dp))): water inside a wall has a particle of the wall within
//   0.87 dp, water that is only behind the plane of a ridge's far face has not (without it notches threw water at c/20); water a hair behind
//   a plane touches it. A surface that is hardly in reach (sum of weights below 1e-4) has no say (the crest of a dam threw water off its face).
//   (Weights by |r - r_w| let the crest of a dam, whose plane lies above, speak for water beside its face.) v_n, v_w,n: normal velocity of water and wall [m/s]; c: sound speed.
//   The first tenth of dp behind the surface is not pushed back: s is a mean over facets, and still water that touched a wall was thrown off it
//   (8 % of sqrt(g H), single particles). In ordinary flow the bound lies near c/6 and never acts; it is what keeps a particle from slipping between wall
//   particles on stair-stepped terrain (extrapolated pressures alone let some through). Source: own construction.
//   Where bodies move, walls at rest are asked once more by themselves, after all walls together: between two walls normals cancel, and water
//   that a body crushes against the bed went through it.
#pragma once

#include "core/host_device.hpp"
#include "core/real.hpp"
#include "core/vec3.hpp"

namespace gdesp::sph {

template <class Real>
struct WallGuardSums {
  Real weight{0.0f}, distance{0.0f}, nx{0.0f}, ny{0.0f}, nz{0.0f}, wall_speed{0.0f};
};

/// Adds wall particle w: inverse_reach = 1/(2 dp); r = r_fluid - r_w (m), its normal, depth (m) and velocity (m/s).
template <class Real>
GDESP_HD inline void add_wall_guard(float inverse_reach, const Real r[3], const Real n[3], const Real& depth,
                                    const Real v[3], WallGuardSums<Real>& sums) {
  using real::max;
  using real::min;
  using real::sqrt;
  const Real x = r[0] - depth * n[0], y = r[1] - depth * n[1], z = r[2] - depth * n[2];
  const Real t = max(Real(0.0f), Real(1.0f) - sqrt(x * x + y * y + z * z) * Real(inverse_reach));
  const Real t3 = t * t * t;
  // A wall particle without a normal (zero) has no say.
  const Real s = x * n[0] + y * n[1] + z * n[2];
  const Real apart = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]) * Real(4.0f * inverse_reach);
  const Real touches = Real(1.0f) + s * Real(10.0f * inverse_reach);
  const Real here = max(Real(0.0f), min(Real(1.0f), max(Real(2.0f) - apart, touches)));
  const Real w = t3 * t3 * (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) * here;
  sums.weight += w;
  sums.distance += w * s;
  sums.nx += w * n[0];
  sums.ny += w * n[1];
  sums.nz += w * n[2];
  sums.wall_speed += w * (v[0] * n[0] + v[1] * n[1] + v[2] * n[2]);
}

/// The surface near a particle, as the pass leaves it; weight 0: none near.
struct NearWall {
  float weight, distance, nx, ny, nz, wall_speed;  ///< sums as gathered
};

inline constexpr float least_guard_weight = 1.0e-4f;  ///< of a surface that has a say

/// v (m/s) with the bound applied for a step dt (s); c: sound speed (m/s); dp: particle spacing (m).
GDESP_HD inline Vec3f guarded_velocity(const Vec3f& v, const NearWall& wall, float dt, float c, float dp) {
  if (!(wall.weight > least_guard_weight)) return v;
  Vec3f n{wall.nx, wall.ny, wall.nz};
  const float length = norm(n);
  if (length < 0.3f * wall.weight) return v;  // opposite walls: no direction is out
  n *= 1.0f / length;
  const float s = wall.distance / wall.weight, wall_speed = wall.wall_speed / wall.weight;
  const float least =
      wall_speed + (s > 0.0f ? -0.5f * s / dt : real::min(0.1f * real::max(-s - 0.1f * dp, 0.0f) / dt, 0.05f * c));
  const float along = dot(v, n);
  return along < least ? v + n * (least - along) : v;
}

}  // namespace gdesp::sph
