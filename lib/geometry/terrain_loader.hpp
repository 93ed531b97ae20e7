// SPDX-License-Identifier: GPL-3.0-or-later
// Terrain from its files: rasters (tiles joined, reprojected), point clouds (triangulated) or meshes; bathymetry
// burned in.
#pragma once

#include "geometry/heightfield.hpp"
#include "geometry/scene_parts.hpp"

namespace gdesp::geometry {

/// A sheet with normals up, in scene coordinates.
struct TerrainSheet {
  TriangleMesh mesh;
  double spacing = 0.0;  ///< m, mean horizontal distance of vertices
  std::string crs;       ///< WKT or empty
};

/// Reads scene.terrain. Throws Error(input).
TerrainSheet load_terrain(const Scene& scene, Notes& notes);

/// A surface file (raster, points or mesh) as a sheet, for slides and bathymetry.
TerrainSheet load_sheet(const std::string& path, const Terrain& conventions, const std::string& target_crs,
                        Notes& notes);

/// Delaunay triangulation of points seen from above; equal positions are joined (the mean height is kept).
TriangleMesh triangulate_points(const std::vector<Vec3d>& points);

/// Heights of a sheet at the nodes x0 + i dx, y0 + j dy; NaN where it has none.
std::vector<double> heights_on_grid(const TriangleMesh& sheet, const Heightfield& grid);

/// Turns every triangle so that its normal looks up. Returns how many were turned.
std::size_t turn_up(TriangleMesh& sheet);

}  // namespace gdesp::geometry
