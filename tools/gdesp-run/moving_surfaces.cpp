// SPDX-License-Identifier: GPL-3.0-or-later
#include "moving_surfaces.hpp"

#include "dem/rigid_motion.hpp"
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
    const dem::Quaternion q = dem::quaternion_of(poses[b].rotation);
    state.orientation[0] = q.w, state.orientation[1] = q.x, state.orientation[2] = q.y, state.orientation[3] = q.z;
    states.push_back(state);
  }
  return states;
}

}  // namespace gdesp::tool
