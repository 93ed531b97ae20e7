// SPDX-License-Identifier: GPL-3.0-or-later
// Points sorted into cells, for questions of who is near.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <cmath>

#include "geometry/triangle_mesh.hpp"

namespace gdesp::geometry {

/// Cells of edge `width` (m) or wider over the bounds of the points, z fastest; those within `width` of a place are in the 27 cells
/// around it. Keeps a reference to the points, in whose order it lists them.
class PointCells {
 public:
  PointCells(const std::vector<Vec3d>& points, double width) : points_(points), width_(width) {
    Box box = empty_box();
    for (const auto& p : points) extend(box, p);
    if (points.empty()) box = {};
    origin_ = box.lower;
    const Vec3d size = extent(box);
    const double most = 8.0 * static_cast<double>(points.size()) + 1000.0;
    for (;; width_ *= 1.25) {
      double cells = 1.0;
      for (int a = 0; a < 3; ++a) n_[a] = static_cast<std::int64_t>(size[a] / width_) + 1, cells *= static_cast<double>(n_[a]);
      if (cells <= most) break;
    }
    start_.assign(static_cast<std::size_t>(n_[0] * n_[1] * n_[2]) + 1, 0);
    for (const auto& p : points) ++start_[index(p) + 1];
    for (std::size_t c = 0; c + 1 < start_.size(); ++c) start_[c + 1] += start_[c];
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    member_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) member_[next[index(points[i])]++] = static_cast<std::uint32_t>(i);
  }

  /// use(j) for every point nearer to p than `distance` (m), which is at most the width.
  template <class Use>
  void near(const Vec3d& p, double distance, const Use& use) const {
    std::int64_t low[3], high[3];
    for (int a = 0; a < 3; ++a) {
      low[a] = std::max<std::int64_t>(0, cell(a, p[a] - distance));
      high[a] = std::min<std::int64_t>(n_[a] - 1, cell(a, p[a] + distance));
    }
    if (low[2] > high[2]) return;
    for (std::int64_t i = low[0]; i <= high[0]; ++i) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        const auto row = static_cast<std::size_t>((i * n_[1] + j) * n_[2]);
        for (std::uint32_t k = start_[row + static_cast<std::size_t>(low[2])]; k < start_[row + static_cast<std::size_t>(high[2]) + 1]; ++k) {
          const Vec3d d = points_[member_[k]] - p;
          if (dot(d, d) < distance * distance) use(member_[k]);
        }
      }
    }
  }

 private:
  std::int64_t cell(int axis, double x) const { return static_cast<std::int64_t>(std::floor((x - origin_[axis]) / width_)); }
  std::size_t index(const Vec3d& p) const {
    std::int64_t at[3];
    for (int a = 0; a < 3; ++a) at[a] = std::clamp<std::int64_t>(cell(a, p[a]), 0, n_[a] - 1);
    return static_cast<std::size_t>((at[0] * n_[1] + at[1]) * n_[2] + at[2]);
  }

  const std::vector<Vec3d>& points_;
  double width_;
  Vec3d origin_;
  std::int64_t n_[3];
  std::vector<std::uint32_t> start_, member_;
};

}  // namespace gdesp::geometry
