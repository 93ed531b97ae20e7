// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem/body_path.hpp"

#include <algorithm>
#include <cmath>

namespace gdesp::dem {
namespace {

// c = a b^T when transposed, else a b; 3 x 3, row by row.
void multiply(const double* a, const double* b, bool transposed, double* c) {
  for (int r = 0; r < 3; ++r) {
    for (int k = 0; k < 3; ++k) {
      double sum = 0.0;
      for (int m = 0; m < 3; ++m) sum += a[3 * r + m] * (transposed ? b[3 * k + m] : b[3 * m + k]);
      c[3 * r + k] = sum;
    }
  }
}

// Axis times angle of a rotation.
Vec3d rotation_vector(const double* q) {
  const Vec3d twice_sine{q[7] - q[5], q[2] - q[6], q[3] - q[1]};
  const double sine = 0.5 * norm(twice_sine), cosine = 0.5 * (q[0] + q[4] + q[8] - 1.0);
  const double angle = std::atan2(sine, cosine);
  if (sine > 1.0e-9) return (0.5 * angle / sine) * twice_sine;
  if (cosine > 0.0) return 0.5 * twice_sine;
  // Half a turn: the axis is the longest column of Q + 1.
  int column = 0;
  for (int k = 1; k < 3; ++k) column = q[4 * k] > q[4 * column] ? k : column;
  Vec3d axis{q[column], q[3 + column], q[6 + column]};
  axis[column] += 1.0;
  return (angle / norm(axis)) * axis;
}

// Rodrigues' formula.
void rotation_from(const Vec3d& vector, double* q) {
  const double angle = norm(vector);
  const double s = angle > 1.0e-12 ? std::sin(angle) / angle : 1.0;
  const double c = angle > 1.0e-6 ? (1.0 - std::cos(angle)) / (angle * angle) : 0.5;
  const double cross_matrix[9] = {0, -vector.z, vector.y, vector.z, 0, -vector.x, -vector.y, vector.x, 0};
  double square[9];
  multiply(cross_matrix, cross_matrix, false, square);
  for (int k = 0; k < 9; ++k) q[k] = (k % 4 == 0 ? 1.0 : 0.0) + s * cross_matrix[k] + c * square[k];
}

}  // namespace

BodyMoment body_at(const BodyMotionState& state, double share, double duration) {
  BodyMoment moment;
  moment.centre = state.centre_begin + share * (state.centre_end - state.centre_begin);
  double turn[9], part[9];
  multiply(state.rotation_end, state.rotation_begin, true, turn);
  const Vec3d angle = rotation_vector(turn);
  rotation_from(share * angle, part);
  multiply(part, state.rotation_begin, false, moment.rotation);
  if (duration > 0.0) {
    moment.velocity = (1.0 / duration) * (state.centre_end - state.centre_begin);
    moment.spin = (1.0 / duration) * angle;
  }
  return moment;
}

ListedPose listed_pose(const BodyMotionState& state, const BodyMoment& moment) {
  ListedPose pose;
  for (int r = 0; r < 3; ++r) {
    for (int k = 0; k < 3; ++k) pose.to_body[3 * r + k] = moment.rotation[3 * k + r];
  }
  pose.centre = moment.centre;
  pose.centre_initial = state.centre_initial;
  pose.present = state.present;
  return pose;
}

BodyPose pose_since(const ListedPose& listed, const BodyMotionState& state, const BodyMoment& moment) {
  BodyPose pose;
  const ListedPose now = listed_pose(state, moment);
  double turned[9];
  multiply(now.to_body, listed.to_body, true, turned);
  for (int k = 0; k < 9; ++k) {
    pose.to_body[k] = static_cast<float>(now.to_body[k]);
    pose.turned[k] = static_cast<float>(turned[k] - (k % 4 == 0 ? 1.0 : 0.0));
  }
  pose.shift = Vec3f(moment.centre - listed.centre);
  pose.velocity = Vec3f(moment.velocity);
  pose.spin = Vec3f(moment.spin);
  pose.present = now.present;
  return pose;
}

double moved_since(const ListedPose& listed, const BodyMoment& moment, double reach) {
  double turned[9];
  multiply(moment.rotation, listed.to_body, false, turned);
  return norm(moment.centre - listed.centre) + norm(rotation_vector(turned)) * reach;
}

}  // namespace gdesp::dem
