// SPDX-License-Identifier: GPL-3.0-or-later
// Particles sorted into vertical columns, and by height inside each: what every measurement of a free surface
// needs. Dense in the horizontal only, so that a high jet costs nothing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.hpp"

namespace gdesp::analysis {

class ColumnGrid {
 public:
  /// `position`: m; copied (sorted), so the caller may drop its own. `cell`: m, the largest horizontal distance
  /// asked for later. Two dimensions: y is ignored. Throws Error(numerical) on a position that is not finite.
  ColumnGrid(std::span<const Vec3d> position, double cell, int dimensions);

  std::size_t size() const { return position_.size(); }
  bool empty() const { return position_.empty(); }
  int dimensions() const { return dimensions_; }
  double cell() const { return cell_; }
  Vec3d lower() const { return lower_; }
  Vec3d upper() const { return upper_; }
  const Vec3d& position(std::size_t slot) const { return position_[slot]; }
  std::uint32_t index(std::size_t slot) const { return index_[slot]; }  ///< place in the caller's list

  /// Calls visit(slot, horizontal distance squared) for the particles closer than cell() in the horizontal
  /// and with z in [z_low, z_high], column by column.
  template <class Visit>
  void for_each(double x, double y, double z_low, double z_high, Visit&& visit) const;

  /// Height of the highest particle within `radius` <= cell() of (x, y) and below `z`; -infinity when none.
  double highest_below(double x, double y, double radius, double z) const;

 private:
  int column_x(double x) const;
  int column_y(double y) const;
  std::size_t first_at_or_above(std::size_t column, double z) const;

  int dimensions_ = 3;
  int nx_ = 0, ny_ = 0;
  double cell_ = 0.0;
  Vec3d lower_, upper_;
  std::vector<Vec3d> position_;
  std::vector<std::uint32_t> index_;
  std::vector<std::uint32_t> start_;  // nx * ny + 1
};

template <class Visit>
void ColumnGrid::for_each(double x, double y, double z_low, double z_high, Visit&& visit) const {
  if (empty()) return;
  const double reach2 = cell_ * cell_;
  const int cx = column_x(x), cy = column_y(y);
  for (int iy = cy - 1; iy <= cy + 1; ++iy) {
    if (iy < 0 || iy >= ny_) continue;
    for (int ix = cx - 1; ix <= cx + 1; ++ix) {
      if (ix < 0 || ix >= nx_) continue;
      const std::size_t column = static_cast<std::size_t>(iy) * nx_ + ix;
      for (std::size_t s = first_at_or_above(column, z_low); s < start_[column + 1]; ++s) {
        const Vec3d& p = position_[s];
        if (p.z > z_high) break;
        const double dx = p.x - x, dy = dimensions_ == 2 ? 0.0 : p.y - y;
        const double r2 = dx * dx + dy * dy;
        if (r2 < reach2) visit(s, r2);
      }
    }
  }
}

}  // namespace gdesp::analysis
