// SPDX-License-Identifier: GPL-3.0-or-later
// Which parts of each lattice column are solid: terrain, walls and bodies of a scene.
#pragma once

#include "geometry/columns.hpp"
#include "geometry/lattice.hpp"
#include "geometry/scene_parts.hpp"
#include "geometry/signed_distance.hpp"

namespace gdesp::geometry {

/// Lattice columns that cover `box` horizontally (2D: the one row y = 0). Throws Error(resource) past 4e8 columns.
LatticeColumns lattice_columns(const Lattice& lattice, const Box& box);

/// Solids at rest. A column without terrain (where the scene has terrain and no tank) is solid throughout. `ground`,
/// if given, receives the terrain's and sheets' height per column (NaN: none). `exact_columns` of any grid work.
ColumnIntervals static_solid(const SceneParts& parts, const ColumnGrid& columns, std::vector<double>* ground = nullptr);

/// Bodies (moving, floating, and slides that are no grains) as they stand at the start.
ColumnIntervals body_solid(const SceneParts& parts, const Scene& scene, const ColumnGrid& columns);

/// Distance (m) by which p is inside the tank's inner box, measured to its closed faces only; negative outside.
double tank_clearance(const WallPart& tank, const Vec3d& p);
/// Distance (m) from p to a box from outside (0 inside); y is ignored in two dimensions.
double box_distance(const Box& box, const Vec3d& p, int dimensions);
bool is_open(const WallPart& tank, const char* face);

}  // namespace gdesp::geometry
