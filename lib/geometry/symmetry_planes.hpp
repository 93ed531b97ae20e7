// SPDX-License-Identifier: GPL-3.0-or-later
// Tank faces that are planes of symmetry: a half or a quarter of a scene stands for the whole. What they stop they do not hold back.
#pragma once

#include "geometry/scene_parts.hpp"
#include "particles/particle_tables.hpp"

namespace gdesp::geometry {

/// Whether a face of a tank ("x-", ..., "top") is one.
bool is_symmetry(const WallPart& tank, const char* face);

/// Marks as smooth the triangles at rest that lie within `tolerance` (m) in a tank's planes of symmetry, those of other walls in the
/// same face too. Nothing is marked in a scene without such planes.
void mark_symmetry_planes(const SceneParts& parts, double tolerance, TriangleTable& walls);

}  // namespace gdesp::geometry
