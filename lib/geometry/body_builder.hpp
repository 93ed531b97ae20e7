// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of a case: gates, pistons, rigid and prescribed slides, floating boxes.
#pragma once

#include <string>
#include <vector>

#include "geometry/scene_parts.hpp"
#include "particles/particle_tables.hpp"

namespace gdesp::geometry {

/// Displacement against time from a CSV file of t,dx,dy,dz (s, m), with or without a header line. Throws Error(input)
/// naming the line: not four numbers, times that do not increase, a first displacement other than 0 is allowed.
PrescribedMotion read_motion(const std::string& path);

/// Constant velocity from `start` to `stop`.
PrescribedMotion constant_motion(const Vec3d& velocity, double start, double stop);

Body moving_body(const MovingBody& body, double gravity);
/// What lies behind a piston with far_lake, its box and the particles' water (case coordinates) given: width and bed are those of the water
/// that touches its face. Throws Error(input) when none does, or when its depth is another, or it is no rectangle.
FarLakeShape far_lake_behind(const MovingBody& body, const Box& box, const FluidTable& water, double dp,
                             int dimensions);
Body prescribed_slide(const Slide& slide);

/// What holds a free body: until `release_at` (s), and the motions that it cannot make (x, y, z, rotation).
void hold(Body& body, double release_at, const std::vector<std::string>& fixed);

/// A free body from its closed mesh and density: mass, centre, inertia. In two dimensions per metre of width.
/// Throws Error(input) when the mesh encloses nothing.
Body free_body(const std::string& name, const SolidPart& part, double density, const Vec3d& velocity, int dimensions);

}  // namespace gdesp::geometry
