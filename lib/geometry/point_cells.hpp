// SPDX-License-Identifier: GPL-3.0-or-later
// Points sorted into cells, for questions of who is near.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace gdesp::geometry {

/// Cells of edge `width` (m) or wider over the bounds of the points, z fastest; those within `width` of a place are in the 27 cells
/// around it. At most `cells_per_point` cells a point (and a thousand): a box much larger than what is in it gets wider cells.
class PointCells {
 public:
  PointCells(const std::vector<Vec3d>& points, double width, double cells_per_point = 8.0) : width_(width) {
    Box box = empty_box();
    for (const auto& p : points) extend(box, p);
    if (points.empty()) box = {};
    origin_ = box.lower;
    const Vec3d size = extent(box);
    const double most = cells_per_point * static_cast<double>(points.size()) + 1000.0;
    for (;; width_ *= 1.25) {
      double cells = 1.0;
      for (int a = 0; a < 3; ++a)
        n_[a] = static_cast<std::int64_t>(size[a] / width_) + 1, cells *= static_cast<double>(n_[a]);
      if (cells <= most) break;
    }
    start_.assign(static_cast<std::size_t>(n_[0] * n_[1] * n_[2]) + 1, 0);
    for (const auto& p : points) ++start_[index(p) + 1];
    for (std::size_t c = 0; c + 1 < start_.size(); ++c) start_[c + 1] += start_[c];
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    member_.resize(points.size());
    at_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::uint32_t k = next[index(points[i])]++;
      member_[k] = static_cast<std::uint32_t>(i);
      at_[k] = points[i];
    }
  }

  /// use(j, r^2) for every point j nearer to p than `distance` (m), which is at most the width; r: its distance (m).
  template <class Use>
  void near(const Vec3d& p, double distance, const Use& use) const {
    any_around(p, distance, [&](std::uint32_t j, double r2) {
      if (r2 < distance * distance) use(j, r2);
      return false;
    });
  }

  /// Whether a point is no farther from p than `distance` (m), which is at most the width.
  bool any_within(const Vec3d& p, double distance) const {
    return any_around(p, distance, [&](std::uint32_t, double r2) { return r2 <= distance * distance; });
  }

 private:
  /// test(j, r^2) of the points in the cells within `distance`, until one is true.
  template <class Test>
  bool any_around(const Vec3d& p, double distance, const Test& test) const {
    std::int64_t low[3], high[3];
    for (int a = 0; a < 3; ++a) {
      low[a] = std::max<std::int64_t>(0, cell(a, p[a] - distance));
      high[a] = std::min<std::int64_t>(n_[a] - 1, cell(a, p[a] + distance));
    }
    if (low[2] > high[2]) return false;
    for (std::int64_t i = low[0]; i <= high[0]; ++i) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        const auto row = static_cast<std::size_t>((i * n_[1] + j) * n_[2]);
        const std::uint32_t end = start_[row + static_cast<std::size_t>(high[2]) + 1];
        for (std::uint32_t k = start_[row + static_cast<std::size_t>(low[2])]; k < end; ++k) {
          const Vec3d d = p - at_[k];
          if (test(member_[k], dot(d, d))) return true;
        }
      }
    }
    return false;
  }

  std::int64_t cell(int axis, double x) const {
    return static_cast<std::int64_t>(std::floor((x - origin_[axis]) / width_));
  }
  std::size_t index(const Vec3d& p) const {
    std::int64_t at[3];
    for (int a = 0; a < 3; ++a) at[a] = std::clamp<std::int64_t>(cell(a, p[a]), 0, n_[a] - 1);
    return static_cast<std::size_t>((at[0] * n_[1] + at[1]) * n_[2] + at[2]);
  }

  double width_;
  Vec3d origin_;
  std::int64_t n_[3];
  std::vector<std::uint32_t> start_, member_;
  std::vector<Vec3d> at_;  // in the order of member_
};

}  // namespace gdesp::geometry
