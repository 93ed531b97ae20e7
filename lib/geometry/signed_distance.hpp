// SPDX-License-Identifier: GPL-3.0-or-later
// The boundary grid: signed distance to the scene's walls in a narrow band, on the particle lattice, with a material
// id, as a sparse OpenVDB grid. Memory grows with the walls' area.
//
// Distances are exact to the nearest triangle: each triangle competes for the lattice points within the band around it,
// block by block of 8 x 8 columns, which needs no closed surface. The sign comes from the columns' inside test, so open terrain sheets and dirty solids are no trouble.
#pragma once

#include <string>
#include <vector>

#include "geometry/columns.hpp"
#include "geometry/lattice.hpp"

namespace gdesp::geometry {

/// What one lattice point knows of the walls.
struct BandPoint {
  Index3 at;
  float distance;  ///< m, negative inside the solid
  Vec3f normal;    ///< unit, from the wall into the fluid (gradient of the distance)
  std::int32_t material;
};

/// Surfaces of the scene at rest. material[t] belongs to triangle t.
struct WallSurfaces {
  TriangleMesh mesh;
  std::vector<std::int32_t> material;
};

/// Columns of a lattice: column (i, j) of `grid` is lattice column (i0 + i, j0 + j).
struct LatticeColumns {
  ColumnGrid grid;
  std::int32_t i0 = 0, j0 = 0;
};

/// Where the band is wanted and what is solid.
struct BandRequest {
  Lattice lattice;
  LatticeColumns columns;
  const ColumnIntervals* solid = nullptr;  ///< per column, m
  Index3 lower, upper;                     ///< lattice box, inclusive; points outside are dropped
  double half_width = 3.0;                 ///< dp
};

/// The narrow band, ordered by (i, j, k). Writes it to `vdb_path` as grids "signed_distance" (float, m) and
/// "material" (int) unless that is empty; `offset` (m) is stored as metadata. Throws Error(resource).
std::vector<BandPoint> signed_distance_band(const WallSurfaces& walls, const BandRequest& request,
                                            const std::string& vdb_path, const Vec3d& offset);

}  // namespace gdesp::geometry
