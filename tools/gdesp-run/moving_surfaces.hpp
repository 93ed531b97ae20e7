// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces of moving bodies at their place now, for frames.
#pragma once

#include "io/frame.hpp"
#include "simulation/simulation.hpp"

namespace gdesp::tool {

/// The triangles of `walls` that belong to a body (those of a removed body left out), moved to where the body is at
/// time t (s): by its displacement when the motion is prescribed, else by its pose r = centre + R (r_start - centre_start).
TriangleTable moving_surfaces(const TriangleTable& walls, const std::vector<Body>& bodies,
                              const std::vector<BodyPose>& poses, double t);

/// Where the bodies are, as frames say it: orientation as a unit quaternion w, x, y, z.
std::vector<BodyState> body_states(const std::vector<Body>& bodies, const std::vector<BodyPose>& poses, double t);

}  // namespace gdesp::tool
