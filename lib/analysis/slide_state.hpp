// SPDX-License-Identifier: GPL-3.0-or-later
// State of a slide as a whole: grains or a rigid body.
#pragma once

#include <functional>
#include <optional>

#include "particles/particle_tables.hpp"

namespace gdesp::analysis {

/// Volume share of a sphere (d = 3; a disc, d = 2) that lies below a level: the spherical cap of height h,
/// V = pi h^2 (3 R - h) / 3 (the circular segment A = R^2 (a - sin a cos a), cos a = 1 - h / R), over the whole.
double cap_share(double centre_z, double diameter, double level, int dimensions);

/// Water level at a place; nullopt where it is dry.
using LevelAt = std::function<std::optional<double>(double x, double y)>;

struct SlideState {
  double volume = 0.0;     ///< m3 (m2 in two dimensions), of solids
  double mass = 0.0;       ///< kg; grains only
  Vec3d centre, velocity;  ///< m, m/s, of the centre of mass; velocity NaN for a body's first frame
  double fastest = 0.0;    ///< m/s; grains only
  double submerged = 0.0;  ///< share of the volume below the water's surface, 0..1
};

/// Mass-weighted sums over grains. In parallel.
SlideState measure_grains(const GrainTable& grains, int dimensions, const LevelAt& level);

/// Closed surface of triangles: volume and centre by the divergence theorem; the submerged volume from the surface
/// cut into pieces smaller than `piece` m, each taken at its own level. Velocity is left to the caller.
SlideState measure_body(const TriangleTable& body, double piece, const LevelAt& level);

}  // namespace gdesp::analysis
