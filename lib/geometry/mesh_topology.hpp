// SPDX-License-Identifier: GPL-3.0-or-later
// What the edges of a mesh tell before anything is done to it: how often, and in which direction, triangles use them.
#pragma once

#include <cstddef>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace gdesp::geometry {

/// Corners of triangles, as numbers of points.
using TriangleSoup = std::vector<std::vector<std::size_t>>;

struct EdgeCounts {
  std::size_t border = 0;        ///< edges of one triangle
  std::size_t non_manifold = 0;  ///< of more than two
  std::size_t inconsistent = 0;  ///< of two that run along it the same way
  Vec3d non_manifold_at;         ///< m, the westernmost such edge
};
EdgeCounts count_edges(const TriangleMesh& mesh);

/// A sheet that needs nothing: every triangle looks up, every edge is used once or twice and then both ways, there is one rim,
/// and no two triangles lie over one another. Such a mesh, the common case, is spared all repair.
bool is_plain_sheet(const TriangleMesh& mesh);

/// Two triangles on the same corners that look opposite ways enclose nothing: where layers thin out to nothing. Both go when the
/// edges they leave are then used in pairs; otherwise they are one facet given twice, and stay. Returns the number of pairs that went.
std::size_t remove_flaps(TriangleSoup& triangles);

}  // namespace gdesp::geometry
