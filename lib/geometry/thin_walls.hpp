// SPDX-License-Identifier: GPL-3.0-or-later
// Walls at rest that are too thin for the particles: water at one face must not see the open space behind the other.
#pragma once

#include <optional>

#include "geometry/water_fill.hpp"

namespace gdesp::geometry {

/// Spacings that a wall between water and open space must measure: then two layers of wall particles stand in it wherever the
/// lattice lies. Still water behind walls of one layer moves, behind two it does not more than behind three (docs/mesh2particles.md).
constexpr double least_wall_spacings = 2.0;

struct ThinWall {
  Vec3d at;                ///< m, water in front of the thinnest place found
  double thickness = 0.0;  ///< m, there; across the wall, within dp / 8
  std::size_t places = 0;  ///< columns of water that stand before a wall as thin, counted per side
};

/// Looks from every column of water, at depths of more than dp, along the axes and downwards. Water behind a wall counts as none
/// (two basins), and so does the end of the domain. `walls`: solids at rest on the space's columns.
/// Unset: every wall is thick enough.
std::optional<ThinWall> thinnest_wall(const FillSpace& space, const ColumnIntervals& walls, const SceneParts& parts,
                                      const std::vector<Vec3d>& water);

}  // namespace gdesp::geometry
