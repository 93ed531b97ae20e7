// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/column_grid.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "core/error.hpp"

namespace gdesp::analysis {
namespace {

void find_bounds(std::span<const Vec3d> position, Vec3d& lower, Vec3d& upper) {
  lower = upper = position[0];
  for (std::size_t i = 0; i < position.size(); ++i) {
    const Vec3d& p = position[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      throw Error(ErrorKind::numerical, "particle " + std::to_string(i) + " has a position that is not finite");
    }
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], p[axis]);
      upper[axis] = std::max(upper[axis], p[axis]);
    }
  }
}

}  // namespace

ColumnGrid::ColumnGrid(std::span<const Vec3d> position, double cell, int dimensions)
    : dimensions_(dimensions), cell_(cell) {
  const std::size_t n = position.size();
  start_.assign(1, 0);
  if (n == 0) return;
  find_bounds(position, lower_, upper_);
  // A few stray particles far away must not cost a huge table: wider columns find the same neighbours.
  double width = cell_;
  const auto columns = [&](double w) {
    return ((upper_.x - lower_.x) / w + 1.0) * (dimensions_ == 2 ? 1.0 : (upper_.y - lower_.y) / w + 1.0);
  };
  while (columns(width) > 4.0 * static_cast<double>(n) + 1e6) width *= 1.5;
  cell_ = width;
  nx_ = static_cast<int>((upper_.x - lower_.x) / cell_) + 1;
  ny_ = dimensions_ == 2 ? 1 : static_cast<int>((upper_.y - lower_.y) / cell_) + 1;

  const std::size_t count = static_cast<std::size_t>(nx_) * ny_;
  std::vector<std::uint32_t> column(n);
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < n; ++i) {
    column[i] = static_cast<std::uint32_t>(column_y(position[i].y)) * nx_ + column_x(position[i].x);
  }
  start_.assign(count + 1, 0);
  for (std::size_t i = 0; i < n; ++i) ++start_[column[i] + 1];
  for (std::size_t c = 0; c < count; ++c) start_[c + 1] += start_[c];
  index_.resize(n);
  {
    std::vector<std::uint32_t> fill(start_.begin(), start_.end() - 1);
    for (std::size_t i = 0; i < n; ++i) index_[fill[column[i]]++] = static_cast<std::uint32_t>(i);
  }
#pragma omp parallel for schedule(dynamic, 256)
  for (std::size_t c = 0; c < count; ++c) {
    std::sort(index_.begin() + start_[c], index_.begin() + start_[c + 1], [&](std::uint32_t a, std::uint32_t b) {
      return position[a].z != position[b].z ? position[a].z < position[b].z : a < b;
    });
  }
  position_.resize(n);
#pragma omp parallel for schedule(static)
  for (std::size_t s = 0; s < n; ++s) position_[s] = position[index_[s]];
}

int ColumnGrid::column_x(double x) const {
  return static_cast<int>(std::clamp(std::floor((x - lower_.x) / cell_), -2.0, static_cast<double>(nx_) + 1.0));
}

int ColumnGrid::column_y(double y) const {
  if (dimensions_ == 2) return 0;
  return static_cast<int>(std::clamp(std::floor((y - lower_.y) / cell_), -2.0, static_cast<double>(ny_) + 1.0));
}

std::size_t ColumnGrid::first_at_or_above(std::size_t column, double z) const {
  const auto first = position_.begin() + start_[column], last = position_.begin() + start_[column + 1];
  return std::lower_bound(first, last, z, [](const Vec3d& p, double value) { return p.z < value; }) - position_.begin();
}

double ColumnGrid::highest_below(double x, double y, double radius, double z) const {
  double best = -std::numeric_limits<double>::infinity();
  if (empty()) return best;
  const int cx = column_x(x), cy = column_y(y);
  for (int iy = std::max(cy - 1, 0); iy <= std::min(cy + 1, ny_ - 1); ++iy) {
    for (int ix = std::max(cx - 1, 0); ix <= std::min(cx + 1, nx_ - 1); ++ix) {
      const std::size_t column = static_cast<std::size_t>(iy) * nx_ + ix;
      for (std::size_t s = first_at_or_above(column, z); s-- > start_[column];) {
        const Vec3d& p = position_[s];
        if (p.z <= best) break;
        const double dx = p.x - x, dy = dimensions_ == 2 ? 0.0 : p.y - y;
        if (dx * dx + dy * dy < radius * radius) {
          best = p.z;
          break;
        }
      }
    }
  }
  return best;
}

}  // namespace gdesp::analysis
