// SPDX-License-Identifier: GPL-3.0-or-later
// A terrain raster: elevations at the nodes of a regular grid, joined by triangles (each cell is split along the
// diagonal from its south-west to its north-east node).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace gdesp::geometry {

/// Node (i, j) stands at (x0 + i dx, y0 + j dy); NaN marks a node without data. dx, dy > 0 (m).
struct Heightfield {
  double x0 = 0.0, y0 = 0.0, dx = 1.0, dy = 1.0;
  int nx = 0, ny = 0;
  std::vector<double> z;  ///< m, row by row from the south
  double& at(int i, int j) { return z[static_cast<std::size_t>(j) * nx + i]; }
  double at(int i, int j) const { return z[static_cast<std::size_t>(j) * nx + i]; }
};

/// Elevation on the triangulated surface at (x, y); NaN outside or on a triangle that lacks a node.
double sample(const Heightfield& field, double x, double y);
/// The triangulated surface, normals up; nodes without data left out. `box` limits it horizontally (null: all).
TriangleMesh to_mesh(const Heightfield& field, const Box* box = nullptr);
/// The part of the field whose nodes lie within `box` enlarged by one node.
Heightfield crop(const Heightfield& field, const Box& box);
/// Nodes without data that are enclosed by data, at most 64 side by side: filled by the membrane that their rim spans (Laplace's
/// equation, relaxed). Wider gaps stay gaps. Returns how many nodes were filled.
std::size_t fill_small_gaps(Heightfield& field);
Box bounds(const Heightfield& field);
/// Writes an ESRI ASCII grid (square cells required), with xllcenter / yllcenter and NODATA -9999, `decimals` digits.
void write_esri_ascii(const Heightfield& field, const std::string& path, int decimals);

}  // namespace gdesp::geometry
