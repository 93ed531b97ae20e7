// SPDX-License-Identifier: GPL-3.0-or-later
// Water on the particle lattice: up to a level in the basin that is connected to a seed, in a box, in a closed mesh.
//
// A lattice point is fluid where it lies outside every solid, and a wall particle where it lies inside: the two
// complete each other to the unbroken lattice, so that still water has no gaps at its walls and stays still, and the
// volume has no bias of order dp times area. Flat walls of tanks and boxes are kept half a spacing away.
#pragma once

#include <string>
#include <vector>

#include "geometry/scene_parts.hpp"
#include "geometry/solid_columns.hpp"

namespace gdesp::geometry {

/// What one fill has become.
struct FillReport {
  std::string kind;
  std::size_t particles = 0;
  double volume = 0.0;         ///< m3 (m2 in two dimensions), of the particles
  double exact_volume = 0.0;   ///< m3, of the space filled, from the columns' true intervals
  double surface_area = 0.0;   ///< m2, of the water surface (level fills)
  double level = 0.0;          ///< m, top of the fill
  double lowest_ground = 0.0;  ///< m, level fills
  Vec3d lowest_at;             ///< m, such a place
  double open_edge = 0.0;  ///< m, length of the basin's rim that is held by no wall (polygon or edge of the terrain)
  Vec3d open_edge_at;      ///< one such place
};

/// A region where grains stand in the water at the start: there the water is thinned to the pores.
struct PorousRegion {
  std::optional<Box> box;  ///< m; exact when the shape is a box
  ColumnIntervals inside;  ///< otherwise, on the fill's columns
  Box bounds;              ///< m
  double porosity = 1.0;
};

/// The scene's surfaces on lattice columns, as fills need them.
struct FillSpace {
  Lattice lattice;
  LatticeColumns columns;
  ColumnIntervals solid;              ///< walls and bodies together
  std::vector<double> ground;         ///< m, per column; NaN: none
  Box domain;                         ///< m
  bool periodic[2] = {false, false};  ///< x, y: water flows out at one side of the columns and in at the other
  Vec3d offset;                       ///< m, added to coordinates in messages
};

/// Positions (m) of one fill. Levels and meshes use the common lattice; a box has its own, fitted to its faces (spacing
/// length / round(length / dp) along each axis), which is the common one when its faces lie on that. Throws
/// Error(input): seed in the solid or above the level, level below the bed, nothing filled.
std::vector<Vec3d> fill_water(const FluidFill& fill, const SolidPart& mesh, const FillSpace& space,
                              const SceneParts& parts, const std::string& name, FillReport& report);

/// Appends the points of `more` that are farther than dp / 2 from every point of `fluid`.
void add_fill(std::vector<Vec3d>& fluid, std::vector<Vec3d> more, double dp);

/// Inside porous regions a coarser lattice that holds the pores' share of the fluid takes the particles' place, so that
/// the mass per particle stays the same everywhere: its numbers along the axes give the volume a particle first (in a region a few
/// spacings wide, rounding each axis for itself would be 10 to 25 % off), then spacings that differ little.
void thin_to_pores(std::vector<Vec3d>& fluid, const std::vector<PorousRegion>& porous, const FillSpace& space);

}  // namespace gdesp::geometry
