// SPDX-License-Identifier: GPL-3.0-or-later
// Start, motion and sums of free bodies. Their contacts are in rigid_contacts.cpp.
#include "dem/rigid_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "dem/hertz_mindlin.hpp"
#include "dem/linear_spring_dashpot.hpp"

namespace gdesp::dem {
namespace {

// Jacobi's method on a symmetric matrix, row by row: afterwards `m` is diagonal and `axes` holds its axes in columns.
void diagonalise(double m[9], double axes[9]) {
  for (int k = 0; k < 9; ++k) axes[k] = k % 4 == 0 ? 1.0 : 0.0;
  for (int sweep = 0; sweep < 30; ++sweep) {
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        const double off = m[3 * p + q];
        if (std::abs(off) <= 1.0e-15 * (std::abs(m[4 * p]) + std::abs(m[4 * q]))) continue;
        const double theta = (m[4 * q] - m[4 * p]) / (2.0 * off);
        const double t = (theta < 0.0 ? -1.0 : 1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
        const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
        for (int k = 0; k < 3; ++k) {
          const double a = m[3 * k + p], b = m[3 * k + q];
          m[3 * k + p] = c * a - s * b;
          m[3 * k + q] = s * a + c * b;
        }
        for (int k = 0; k < 3; ++k) {
          const double a = m[3 * p + k], b = m[3 * q + k];
          m[3 * p + k] = c * a - s * b;
          m[3 * q + k] = s * a + c * b;
        }
        for (int k = 0; k < 3; ++k) {
          const double a = axes[3 * k + p], b = axes[3 * k + q];
          axes[3 * k + p] = c * a - s * b;
          axes[3 * k + q] = s * a + c * b;
        }
      }
    }
  }
}

void find_principal_axes(const Body& body, Vec3d& moments, Quaternion& axes) {
  double m[9], columns[9];
  std::copy(std::begin(body.inertia), std::end(body.inertia), m);
  diagonalise(m, columns);
  moments = {m[0], m[4], m[8]};
  const Vec3d x{columns[0], columns[3], columns[6]}, y{columns[1], columns[4], columns[7]},
      z{columns[2], columns[5], columns[8]};
  if (dot(cross(x, y), z) < 0.0) {
    for (int k = 0; k < 3; ++k) columns[3 * k + 2] = -columns[3 * k + 2];
  }
  axes = quaternion_of(columns);
}

void check_body(const Body& body, const Vec3d& moments, std::size_t points) {
  const std::string name = "body \"" + body.name + "\": ";
  if (!(body.mass > 0.0))
    throw Error(ErrorKind::input, name + "mass " + std::to_string(body.mass) + " kg; valid: above 0");
  for (int k = 0; k < 3; ++k) {
    if (!(moments[k] >= 0.0))
      throw Error(ErrorKind::input,
                  name + "a principal moment of inertia is " + std::to_string(moments[k]) + " kg m2; valid: 0 or more");
  }
  if (points == 0) throw Error(ErrorKind::input, name + "has no surface: no wall triangle names it");
}

RigidContactLaw make_law(const ContactParameters& c, double spacing, int dimensions) {
  RigidContactLaw law;
  if (c.law == ContactLawKind::linear) {
    law.stiffness = c.stiffness;
    law.shear_stiffness = c.stiffness * c.stiffness_ratio;
  } else {
    const double e_star = c.youngs_modulus / (2.0 * (1.0 - c.poisson_ratio * c.poisson_ratio));
    law.stiffness = dimensions == 2 ? line_contact_stiffness(e_star) : e_star * spacing;
    law.shear_stiffness = law.stiffness * 2.0 * (1.0 - c.poisson_ratio) / (2.0 - c.poisson_ratio);
  }
  law.damping_ratio = damping_ratio(c.wall_restitution > 0.0 ? c.wall_restitution : c.restitution);
  law.friction = c.wall_friction >= 0.0 ? c.wall_friction : c.friction;
  return law;
}

}  // namespace

RigidBodies::RigidBodies(const std::vector<Body>& bodies, const TriangleTable& walls, const ContactParameters& contact,
                         const Vec3d& gravity, double spacing, int dimensions)
    : bodies_(bodies), inertia_(bodies.size()), principal_(bodies.size()), reach_(bodies.size() + 1, 0.0),
      point_(bodies.size()), mesh_(make_wall_mesh(walls, 1.0e-6 * spacing, dimensions, 16.0 * spacing)),
      law_(make_law(contact, spacing, dimensions)), gravity_(gravity), spacing_(spacing), dimensions_(dimensions),
      state_(bodies.size()), other_(bodies.size()), present_(bodies.size(), 1) {
  if (mesh_.body.size() < bodies.size() + 1) mesh_.body.resize(bodies.size() + 1);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Body& body = bodies_[b];
    for (std::size_t t = 0; t < walls.triangle.size(); ++t) {
      if (walls.body.empty() || walls.body[t] != static_cast<std::int32_t>(b + 1)) continue;
      for (int k = 0; k < 3; ++k) {
        Vec3d arm = walls.vertex[static_cast<std::size_t>(walls.triangle[t][k])] - body.centre;
        if (dimensions == 2) arm.y = 0.0;
        reach_[b + 1] = std::max(reach_[b + 1], norm(arm));
      }
    }
    if (body.kind != BodyKind::free) continue;
    point_[b] = surface_points(walls, static_cast<std::int32_t>(b + 1), spacing, dimensions);
    find_principal_axes(body, inertia_[b], principal_[b]);
    check_body(body, inertia_[b], point_[b].size());
    state_[b].centre = body.centre;
    state_[b].orientation = principal_[b];
  }
  list();
  note_first_depths();
}

BodyMoment RigidBodies::moment(std::size_t b, double ahead) const {
  const RigidState& s = state_[b];
  BodyMoment m;
  m.centre = s.centre + ahead * s.velocity;
  const Quaternion q =
      ahead != 0.0 && s.free ? freely_rotated(s.orientation, s.angular_momentum, inertia_[b], ahead) : s.orientation;
  to_matrix(q * conjugate(principal_[b]), m.rotation);
  m.velocity = s.velocity;
  m.spin = angular_velocity(q, s.angular_momentum, inertia_[b]);
  return m;
}

BodyMoment RigidBodies::moment_of(std::int32_t number) const {
  if (number == 0) return {};
  const auto b = static_cast<std::size_t>(number - 1);
  return is_free_kind(b) ? moment(b) : other_[b];
}

double RigidBodies::largest_speed() const {
  double largest = 0.0;
  for (std::size_t b = 0; b < count(); ++b) {
    if (!state_[b].free) continue;
    const Vec3d spin = angular_velocity(state_[b].orientation, state_[b].angular_momentum, inertia_[b]);
    largest = std::max(largest, norm(state_[b].velocity) + reach_[b + 1] * norm(spin));
  }
  return largest;
}

void RigidBodies::place_prescribed(std::size_t b, const BodyMoment& moment, bool present) {
  other_[b] = moment;
  present_[b] = present ? 1 : 0;
}

void RigidBodies::constrain(std::size_t b) {
  RigidState& s = state_[b];
  const Body& body = bodies_[b];
  for (int axis = 0; axis < 3; ++axis) {
    if (body.fixed[axis]) s.velocity[axis] = 0.0;
  }
  if (dimensions_ == 2) {
    s.velocity.y = 0.0;
    s.angular_momentum.x = s.angular_momentum.z = 0.0;
  }
  if (body.fixed[3]) s.angular_momentum = {};
}

void RigidBodies::release(double time) {
  for (std::size_t b = 0; b < count(); ++b) {
    RigidState& s = state_[b];
    if (!is_free_kind(b) || s.free || bodies_[b].release_at > time) continue;
    s.free = 1;
    s.velocity = bodies_[b].velocity;
    Vec3d spin = rotated(conjugate(s.orientation), bodies_[b].angular_velocity);
    for (int k = 0; k < 3; ++k) spin[k] *= inertia_[b][k];
    s.angular_momentum = rotated(s.orientation, spin);
    constrain(b);
  }
}

void RigidBodies::begin_step() {
  for (RigidState& s : state_) s.fluid = s.solid = {};
}

void RigidBodies::drift(double h) {
  for (std::size_t b = 0; b < count(); ++b) {
    RigidState& s = state_[b];
    if (!s.free) continue;
    s.centre += h * s.velocity;
    s.orientation = freely_rotated(s.orientation, s.angular_momentum, inertia_[b], h);
  }
}

void RigidBodies::kick(std::size_t b, double h, const BodyLoad& solid) {
  RigidState& s = state_[b];
  s.velocity += (h / bodies_[b].mass) * (s.fluid.force + solid.force) + h * gravity_;
  s.angular_momentum += h * (s.fluid.torque + solid.torque);
  constrain(b);
}

void RigidBodies::substep(double h, double share, const std::vector<BodyImpulse>& grains) {
  drift(0.5 * h);
  if (lists_are_stale()) list();
  std::vector<BodyLoad> loads(count());
  for (std::size_t b = 0; b < count() && b < grains.size(); ++b) {
    loads[b] = {(1.0 / h) * grains[b].linear, (1.0 / h) * grains[b].angular};
  }
  for (const Found& found : find_touches()) add_force(found, h, loads);
  for (std::size_t b = 0; b < count(); ++b) {
    state_[b].solid.force += share * loads[b].force;
    state_[b].solid.torque += share * loads[b].torque;
    if (state_[b].free) kick(b, h, loads[b]);
  }
  drift(0.5 * h);
}

RigidSums RigidBodies::sums() const {
  RigidSums sums;
  for (std::size_t b = 0; b < count(); ++b) {
    if (!is_free_kind(b)) continue;
    const RigidState& s = state_[b];
    const double m = bodies_[b].mass;
    sums.kinetic_energy +=
        0.5 * m * dot(s.velocity, s.velocity) +
        0.5 * dot(angular_velocity(s.orientation, s.angular_momentum, inertia_[b]), s.angular_momentum);
    sums.potential_energy -= m * dot(gravity_, s.centre);
    sums.momentum += m * s.velocity;
    sums.angular_momentum += cross(s.centre, m * s.velocity) + s.angular_momentum;
  }
  for (const PointMemory& p : memory_) {
    if (p.touching && law_.shear_stiffness > 0.0)
      sums.elastic_energy += 0.5 * dot(p.tangential, p.tangential) / law_.shear_stiffness;
  }
  sums.elastic_energy += normal_energy();
  return sums;
}

void RigidBodies::check(const Vec3d& lower, const Vec3d& upper, double time) const {
  for (std::size_t b = 0; b < count(); ++b) {
    if (!is_free_kind(b)) continue;
    const RigidState& s = state_[b];
    const double sum = dot(s.centre, s.centre) + dot(s.velocity, s.velocity) +
                       dot(s.angular_momentum, s.angular_momentum) + s.orientation.w;
    const std::string where = "body \"" + bodies_[b].name + "\" at t = " + std::to_string(time) + " s: ";
    if (!std::isfinite(sum))
      throw Error(
          ErrorKind::numerical,
          where + "has no finite state; a smaller time step (numerics.cfl) or softer contacts ([contact]) are needed");
    for (int axis = 0; axis < 3; ++axis) {
      if (dimensions_ == 2 && axis == 1) continue;
      if (s.centre[axis] >= lower[axis] && s.centre[axis] <= upper[axis]) continue;
      throw Error(ErrorKind::numerical, where + "its centre has left the domain (" + "xyz"[axis] + " = " +
                                            std::to_string(s.centre[axis]) + " m, valid " +
                                            std::to_string(lower[axis]) + " to " + std::to_string(upper[axis]) +
                                            " m); a larger [domain] or a wall keeps it");
    }
  }
}

}  // namespace gdesp::dem
