// SPDX-License-Identifier: GPL-3.0-or-later
// The walls as a surface that can be asked: how far away, and at which height. A tree of boxes over triangles.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "particles/particle_tables.hpp"

namespace gdesp::analysis {

class WallSurface {
 public:
  WallSurface() = default;
  /// Takes the triangles at rest (body 0); those of moving bodies are no bank.
  explicit WallSurface(const TriangleTable& walls);

  bool empty() const { return triangle_.empty(); }
  /// The point of the walls that is nearest to p, if it is at most `limit` m away; else nullopt.
  std::optional<Vec3d> nearest(const Vec3d& p, double limit) const;
  /// Elevation of the ground at (x, y), m: of the highest triangle that faces up (the lid of a closed tank does not); of
  /// the highest of any where none does; nullopt where there is none at all.
  std::optional<double> height(double x, double y) const;

 private:
  struct Triangle {
    Vec3d a, b, c;
  };
  struct Node {
    Vec3d lower, upper;
    std::uint32_t first = 0, count = 0;  // leaf: triangles; inner: count 0, children at first and first + 1
  };
  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);

  std::vector<Triangle> triangle_;
  std::vector<Node> node_;
};

}  // namespace gdesp::analysis
