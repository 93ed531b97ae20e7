// SPDX-License-Identifier: GPL-3.0-or-later
// One contact, put together from its laws: normal force with damping and cohesion, tangential force with history,
// rolling resistance. The same for two grains and for a grain and a wall; exchanging i and j changes signs only.
// @eq dem.damping.limit
//   c_n <= 0.2 m*/dt, c_t <= 0.06 m*/dt, c_r <= 0.02 I_r/dt
//   c_n, c_t [N s/m], c_r [N m s]: normal, tangential, rolling damping of a contact; m* [kg], I_r [kg m2]: its effective mass and
//   inertia; dt: step [s]. Damping on the predicted velocity (dem.motion.leapfrog) is stable while a + 4 b < 4, a = (omega dt)^2 of the elastic
//   forces, b = the share of the velocity that damping takes in a step; in a bed of six contacts a grain the stiffest modes have
//   b = (2 c_n + 4 c_t) dt/m* (neighbours against each other) and 10 c_t dt/m* (neighbours that turn the same way). With the limits both stay
//   below 0.7: without them beds of deep overlaps or strong damping go on spinning. A step that is small enough meets none of them.
//   Source: own, by the criterion of Jury (1964), Theory and Application of the z-Transform Method, on the recurrence of that scheme.
#pragma once

#include "dem/friction.hpp"
#include "dem/hertz_mindlin.hpp"
#include "dem/linear_spring_dashpot.hpp"
#include "dem/rolling_resistance.hpp"

namespace gdesp::dem {

/// The laws of one kind of contact (grain-grain or grain-wall).
template <class Law>
struct ContactLaws {
  Law law;
  float friction = 0.0f;          ///< mu
  float rolling_friction = 0.0f;  ///< mu_r
  float work_of_adhesion = 0.0f;  ///< J/m2
};

/// Shares of dem.damping.limit; the rolling one is in rolling_resistance.hpp.
inline constexpr float most_normal_damping = 0.2f, most_tangential_damping = 0.06f;

/// The two halves of a step around now, s.
struct HalfSteps {
  float before = 0.0f, after = 0.0f;
};

template <class R>
struct ContactGeometry {
  Vec3<R> n;         ///< unit, from j to i
  R overlap;         ///< m, > 0
  R radius;          ///< R*, m
  R mass;            ///< m*, kg
  Vec3<R> velocity;  ///< m/s, of i against j at the contact
};

template <class R>
struct ContactForce {
  Vec3<R> force;       ///< N, on i
  R normal_force;      ///< N, >= 0, without cohesion
  R normal_stiffness;  ///< N/m
};

/// Force of one contact on i; `history` is the elastic tangential force (N).
template <class Law, class R>
GDESP_HD inline ContactForce<R> contact_force(const ContactLaws<Law>& laws, const ContactGeometry<R>& g,
                                              const HalfSteps& h, Vec3<R>& history) {
  using real::max;
  using real::min;
  const R zero(0.0f);
  ContactCoefficients<R> c = laws.law(g.overlap, g.radius, g.mass);
  const R taken = g.mass * R(1.0f / (h.before + h.after));
  c.normal_damping = min(c.normal_damping, R(most_normal_damping) * taken);
  c.tangential_damping = min(c.tangential_damping, R(most_tangential_damping) * taken);
  const R v_n = dot(g.velocity, g.n);
  const R normal = c.elastic_force - c.normal_damping * v_n;
  ContactMotion<R> motion;
  motion.n = g.n;
  motion.v_t = {g.velocity.x - v_n * g.n.x, g.velocity.y - v_n * g.n.y, g.velocity.z - v_n * g.n.z};
  motion.unloading = Law::unloading(g.overlap, max(v_n, zero), R(h.before + h.after));
  motion.cap = R(laws.friction) * max(normal, zero);
  motion.half_before = R(h.before);
  motion.half_after = R(h.after);
  const Vec3<R> t = tangential_force(c, motion, history);
  const R push = normal - dmt_pull(laws.work_of_adhesion, g.radius);
  return {{push * g.n.x + t.x, push * g.n.y + t.y, push * g.n.z + t.z}, max(normal, zero), c.normal_stiffness};
}

}  // namespace gdesp::dem
