// SPDX-License-Identifier: GPL-3.0-or-later
#include "moving_surfaces.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/prescribed_motion.hpp"

namespace gdesp::tool {
namespace {

Vec3d rotated(const double r[9], const Vec3d& v) {
  return {r[0] * v.x + r[1] * v.y + r[2] * v.z, r[3] * v.x + r[4] * v.y + r[5] * v.z,
          r[6] * v.x + r[7] * v.y + r[8] * v.z};
}

Vec3d placed(const Vec3d& start, const Body& body, const BodyPose& pose, double t) {
  if (body.kind == BodyKind::prescribed) return start + motion_at(body.motion, t).displacement;
  return pose.centre + rotated(pose.rotation, start - body.centre);
}

/// Shepperd's method: the largest of the four components is taken from the diagonal, so that nothing is divided by
/// a small number (Shepperd 1978, doi:10.2514/3.55767b).
void to_quaternion(const double r[9], double q[4]) {
  const double trace = r[0] + r[4] + r[8];
  const double squares[4] = {trace, r[0], r[4], r[8]};
  const int largest = static_cast<int>(std::max_element(squares, squares + 4) - squares);
  if (largest == 0) {
    q[0] = 1.0 + trace;
    q[1] = r[7] - r[5];
    q[2] = r[2] - r[6];
    q[3] = r[3] - r[1];
  } else {
    const int i = largest - 1, j = (i + 1) % 3, k = (i + 2) % 3;
    q[0] = r[3 * k + j] - r[3 * j + k];
    q[1 + i] = 1.0 + r[4 * i] - r[4 * j] - r[4 * k];
    q[1 + j] = r[3 * j + i] + r[3 * i + j];
    q[1 + k] = r[3 * k + i] + r[3 * i + k];
  }
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (int c = 0; c < 4; ++c) q[c] /= length;
}

}  // namespace

TriangleTable moving_surfaces(const TriangleTable& walls, const std::vector<Body>& bodies,
                              const std::vector<BodyPose>& poses, double t) {
  TriangleTable out;
  std::vector<std::int32_t> number(walls.vertex.size(), -1);
  for (std::size_t i = 0; i < walls.body.size(); ++i) {
    if (walls.body[i] <= 0) continue;
    const auto b = static_cast<std::size_t>(walls.body[i] - 1);
    if (b >= poses.size() || b >= bodies.size() || removed_at(bodies[b].motion, t)) continue;
    Vec3<std::int32_t> corners = walls.triangle[i];
    for (int k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(corners[k]);
      if (number[vertex] < 0) {
        number[vertex] = static_cast<std::int32_t>(out.vertex.size());
        out.vertex.push_back(placed(walls.vertex[vertex], bodies[b], poses[b], t));
      }
      corners[k] = number[vertex];
    }
    out.triangle.push_back(corners);
    out.body.push_back(walls.body[i]);
  }
  return out;
}

std::vector<BodyState> body_states(const std::vector<Body>& bodies, const std::vector<BodyPose>& poses, double t) {
  std::vector<BodyState> states;
  for (std::size_t b = 0; b < bodies.size() && b < poses.size(); ++b) {
    BodyState state;
    state.centre = placed(bodies[b].centre, bodies[b], poses[b], t);
    state.velocity = poses[b].velocity;
    state.angular_velocity = poses[b].angular_velocity;
    state.force = poses[b].force;
    state.torque = poses[b].torque;
    to_quaternion(poses[b].rotation, state.orientation);
    states.push_back(state);
  }
  return states;
}

}  // namespace gdesp::tool
