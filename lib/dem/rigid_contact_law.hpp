// SPDX-License-Identifier: GPL-3.0-or-later
// @eq rigid.contact.normal
//   N = k d - 2 beta sqrt(k m_c) v_n,  k = E* s (space), (pi/4) E* (plane, per metre), or contact.stiffness (law linear)
//   N: force of one contact point on the body along n [N]; n: unit normal out of the other surface; d: depth of the point
//   below that surface [m]; v_n: velocity of the point against it along n [m/s]; E* = E/(2 (1 - nu^2)) [Pa]; s: spacing of
//   the body's contact points [m]; beta of dem.linear.damping; m_c = m/(points in contact): mass each of them carries
//   [kg]. A face with n points is a spring n k, damped so that it rebounds with the restitution coefficient.
//   Valid while d stays well below s. A point that starts inside a surface counts d from there.
//   Source: Cundall and Strack (1979), Geotechnique 29, 47, doi:10.1680/geot.1979.29.1.47, point by point.
// @eq rigid.contact.friction
//   T = T_0 - k_t v_t h,  T_total = T - 2 beta sqrt(k_t m_c) v_t, both cut at mu max(N - u A, 0)
//   T: elastic tangential force, remembered [N]; T_0: the last one, turned into the tangent plane; v_t: tangential velocity
//   [m/s]; h: step [s]; k_t: k 2(1 - nu)/(2 - nu), or k times contact.stiffness_ratio; mu: contact.wall_friction;
//   u: pressure of the still water at the point [Pa], A: the surface it stands for [m2]. No water is computed between
//   a body and the ground, so N is the total stress there and N - u A the effective one (Terzaghi 1943, Theoretical Soil
//   Mechanics, doi:10.1002/9780470172766): friction is that of a body to whose underside water has found its way.
//   A block on a plane rests up to tan(slope) = mu and slides at g (sin - mu cos) beyond.
//   Source: as rigid.contact.normal.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/vec3.hpp"

namespace gdesp::dem {

/// Of every contact point of one body.
struct RigidContactLaw {
  double stiffness = 0.0;        ///< k, N/m
  double shear_stiffness = 0.0;  ///< k_t, N/m
  double damping_ratio = 0.0;    ///< beta
  double friction = 0.0;         ///< mu
};

/// One point that touches.
struct PointTouch {
  Vec3d n;                  ///< unit, out of the other surface
  double depth = 0.0;       ///< m, > 0
  Vec3d velocity;           ///< m/s, of the point against the other surface
  double mass = 0.0;        ///< m_c, kg
  double pore_force = 0.0;  ///< u A, N
};

/// N on the body; `tangential` (N) is the memory of the contact. `step`: s.
inline Vec3d rigid_contact_force(const RigidContactLaw& law, const PointTouch& touch, double step, Vec3d& tangential) {
  const double v_n = dot(touch.velocity, touch.n);
  const double damping = 2.0 * law.damping_ratio * std::sqrt(law.stiffness * touch.mass);
  const double normal = law.stiffness * touch.depth - damping * v_n;
  const Vec3d v_t = touch.velocity - v_n * touch.n;
  const double length = norm(tangential);
  Vec3d elastic = tangential - dot(tangential, touch.n) * touch.n;
  const double in_plane = norm(elastic);
  if (in_plane > 0.0) elastic *= length / in_plane;
  elastic -= (law.shear_stiffness * step) * v_t;
  const double cap = law.friction * std::max(normal - touch.pore_force, 0.0);
  const double held = norm(elastic);
  if (held > cap) elastic *= cap / held;
  tangential = elastic;
  Vec3d total = elastic - (2.0 * law.damping_ratio * std::sqrt(law.shear_stiffness * touch.mass)) * v_t;
  const double size = norm(total);
  if (size > cap) total *= cap / size;
  return normal * touch.n + total;
}

}  // namespace gdesp::dem
