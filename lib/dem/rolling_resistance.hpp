// SPDX-License-Identifier: GPL-3.0-or-later
// @eq dem.rolling.elastic_plastic
//   M(t + dt) = P M(t) - k_r w_r dt, |M| <= mu_r R* F_n;  torque M - c_r w_r while below the cap, M at it
//   M: torque on i, -M on j [N m]; w_r: part of w_i - w_j in the plane of contact [rad/s]; mu_r: rolling friction
//   coefficient; R*: effective radius [m]; F_n >= 0: normal force [N]; k_r = 2.25 S_n mu_r^2 R*^2 [N m/rad], S_n:
//   normal stiffness [N/m]; c_r = 2 eta sqrt(I_r k_r), eta = 0.3 [N m s];
//   I_r: harmonic half of I + m R^2 of i and j [kg m2]. Source: elastic-plastic spring-dashpot, model C of Ai, Chen,
//   Rotter, Ooi (2011), Powder Technol. 206, 269, doi:10.1016/j.powtec.2010.09.030; k_r: Jiang, Yu, Harris (2005),
//   Comput. Geotech. 32, 340, doi:10.1016/j.compgeo.2005.05.001. Slips without limit at constant torque mu_r R* F_n.
//   Coded with min(1, cap/|M - c_r w_r|) on both parts: continuous at the cap.
#pragma once

#include "core/vec3.hpp"
#include "dem/contact_law.hpp"

namespace gdesp::dem {

template <class R>
struct RollingMotion {
  Vec3<R> n;       ///< unit, from j to i
  Vec3<R> w;       ///< w_i - w_j, rad/s
  R radius;        ///< R*, m
  R inertia;       ///< I_r, kg m2
  R normal_force;  ///< >= 0, N
  R half_before;   ///< s
  R half_after;    ///< s
};

/// Share of I_r/dt (dem.damping.limit).
inline constexpr float most_rolling_damping = 0.02f;

/// The torque on i, N m; `history` (N m) goes from half a step before to half a step after now.
template <class R>
GDESP_HD inline Vec3<R> rolling_torque(float friction, const R& normal_stiffness, const RollingMotion<R>& m,
                                       Vec3<R>& history) {
  using real::max;
  using real::min;
  using real::sqrt;
  const R reach = R(friction) * m.radius;
  const R stiffness = R(2.25f) * normal_stiffness * reach * reach;
  const R most = m.inertia * (R(most_rolling_damping) / (m.half_before + m.half_after));  // dem.damping.limit
  const R damping = min(R(0.6f) * sqrt(m.inertia * stiffness), most);
  const R spin = dot(m.w, m.n);
  const Vec3<R> w{m.w.x - spin * m.n.x, m.w.y - spin * m.n.y, m.w.z - spin * m.n.z};
  const R along = dot(history, m.n);
  const R before = stiffness * m.half_before;
  const Vec3<R> f{history.x - along * m.n.x - before * w.x, history.y - along * m.n.y - before * w.y,
                  history.z - along * m.n.z - before * w.z};
  const Vec3<R> torque{f.x - damping * w.x, f.y - damping * w.y, f.z - damping * w.z};
  const R size = sqrt(dot(torque, torque));
  const R scale = min(R(1.0f), reach * m.normal_force / max(size, R(1.0e-30f)));
  const R after = stiffness * m.half_after;
  history = {f.x * scale - after * w.x, f.y * scale - after * w.y, f.z * scale - after * w.z};
  return {torque.x * scale, torque.y * scale, torque.z * scale};
}

}  // namespace gdesp::dem
