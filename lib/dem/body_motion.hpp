// SPDX-License-Identifier: GPL-3.0-or-later
// Where rigid bodies are during an interval, and what grains do to them.
#pragma once

#include <cstdint>

#include "core/vec3.hpp"

namespace gdesp::dem {

/// A body over the coming interval: a corner that was at X at the start of the simulation is at
/// centre + R (X - centre_initial). Between begin and end the centre moves evenly and the body turns evenly about a
/// fixed axis; what grains feel as its velocity is that of this path.
struct BodyMotionState {
  Vec3d centre_initial;                                    ///< m
  Vec3d centre_begin, centre_end;                          ///< m
  double rotation_begin[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< R at the begin, row by row
  double rotation_end[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};    ///< R at the end
  std::int32_t present = 1, reserved = 0;                  ///< present 0: removed
};

/// What grains gave to a body, summed over sub-steps.
struct BodyImpulse {
  Vec3d linear;   ///< N s
  Vec3d angular;  ///< N m s, about the centre as it moved
};

}  // namespace gdesp::dem
