// SPDX-License-Identifier: GPL-3.0-or-later
// Which triangles lie near a point: a bounding-box tree over a mesh (median split), for grains against walls.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace gdesp::geometry {

/// The nearest point of a mesh to a query point.
struct NearestPoint {
  double distance = 1e300;     ///< m
  Vec3d point;                 ///< m
  std::int32_t triangle = -1;  ///< -1: none within the limit
};

class TriangleTree {
 public:
  TriangleTree() = default;
  /// Keeps a reference to nothing: the mesh is copied corner by corner.
  explicit TriangleTree(const TriangleMesh& mesh);
  bool empty() const { return corner_.empty(); }

  /// Indices of the triangles closer than `radius` to p, ascending; replaces the content of `found`.
  void within(const Vec3d& p, double radius, std::vector<std::int32_t>& found) const;
  /// The nearest triangle not farther than `limit`.
  NearestPoint nearest(const Vec3d& p, double limit) const;
  /// Corners of a triangle.
  const Vec3d* corners(std::int32_t triangle) const { return corner_[triangle].at; }
  Vec3d normal(std::int32_t triangle) const;  ///< unit; zero for a degenerate triangle

 private:
  struct Node {
    Box box;
    std::int32_t first, count, right;
  };  // count > 0: a leaf; else left child is the next node
  struct Corners {
    Vec3d at[3];
  };
  std::int32_t build(std::int32_t first, std::int32_t last);

  std::vector<Corners> corner_;
  std::vector<std::int32_t> order_;
  std::vector<Node> node_;
};

}  // namespace gdesp::geometry
