// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "dem/body_motion.hpp"
#include "dem/wall_contacts.hpp"

namespace gdesp::dem {

/// A body at one moment of its interval.
struct BodyMoment {
  Vec3d centre;                                      ///< m
  double rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< R, row by row
  Vec3d velocity, spin;                              ///< m/s, rad/s
};

/// At `share` (0 begin, 1 end) of an interval of `duration` (s).
BodyMoment body_at(const BodyMotionState& state, double share, double duration);
/// For listing walls.
ListedPose listed_pose(const BodyMotionState& state, const BodyMoment& moment);
/// Against the pose at which walls were listed.
BodyPose pose_since(const ListedPose& listed, const BodyMotionState& state, const BodyMoment& moment);
/// m: no point of the body within `reach` of its centre has moved farther between the two.
double moved_since(const ListedPose& listed, const BodyMoment& moment, double reach);

}  // namespace gdesp::dem
