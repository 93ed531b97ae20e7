// SPDX-License-Identifier: GPL-3.0-or-later
// The exposed surface of several solids that overlap: a dam that reaches into the ground, a wall on a tank's floor. Faces that
// lie inside another solid bound nothing; a wall particle must not take its depth or normal from them.
#pragma once

#include <string>
#include <vector>

#include "geometry/scene_parts.hpp"
#include "geometry/signed_distance.hpp"

namespace gdesp::geometry {

/// Terrain (material 1) and walls (material 2 + index): split along their intersections (CGAL corefinement), faces inside
/// another solid left out. Tank faces look inward. Where splitting fails (a surface that crosses itself), whole triangles
/// are kept or dropped by their centre, and `notes` says so.
WallSurfaces exposed_surfaces(const SceneParts& parts, Notes& notes);

}  // namespace gdesp::geometry
