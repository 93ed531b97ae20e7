// SPDX-License-Identifier: GPL-3.0-or-later
// The cubic lattice on which fluid and wall particles are placed: point (i, j, k) is the centre of a cell of
// edge dp. In two dimensions j is always 0 and y is 0. It decides what is water and what is wall; rows below a still surface
// then stand a little above or below it.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/vec3.hpp"

namespace gdesp::geometry {

using Index3 = Vec3<std::int32_t>;

struct Lattice {
  Vec3d origin;     ///< m, lower corner of cell (0, 0, 0)
  double dp = 1.0;  ///< m
  int dimensions = 3;
  std::vector<double> row_shift = {};  ///< dp, upwards: [k] of row k below the surface (sph.surface-rows); others 0
  std::int32_t surface = 0;            ///< index of the row above the surface, the plane z = origin.z + surface dp

  double coordinate(int axis, std::int32_t i) const {
    return dimensions == 2 && axis == 1 ? 0.0 : origin[axis] + (i + 0.5) * dp;
  }
  Vec3d point(const Index3& i) const { return {coordinate(0, i.x), coordinate(1, i.y), coordinate(2, i.z)}; }
  /// m, upwards: where the particles of row k stand, from their lattice points.
  double shift(std::int32_t k) const {
    const std::int64_t row = static_cast<std::int64_t>(surface) - 1 - k;
    return row >= 0 && row < static_cast<std::int64_t>(row_shift.size()) ? row_shift[static_cast<std::size_t>(row)] * dp
                                                                         : 0.0;
  }
  /// m, upwards: of the row at height z; 0 where none is.
  double shift_at(double z) const {
    const std::int32_t k = nearest(2, z);
    return std::abs(z - coordinate(2, k)) < 1e-6 * dp ? shift(k) : 0.0;
  }
  /// Where the particle of a lattice point stands.
  Vec3d place(const Index3& i) const { return point(i) + Vec3d{0.0, 0.0, shift(i.z)}; }
  /// Index of the cell that c lies in.
  std::int32_t nearest(int axis, double c) const {
    return static_cast<std::int32_t>(std::floor((c - origin[axis]) / dp));
  }
  /// Index of the first cell centre at or above c.
  std::int32_t first_at_or_above(int axis, double c) const {
    return static_cast<std::int32_t>(std::ceil((c - origin[axis]) / dp - 0.5 - 1e-9));
  }
  /// Index of the last cell centre at or below c.
  std::int32_t last_at_or_below(int axis, double c) const {
    return static_cast<std::int32_t>(std::floor((c - origin[axis]) / dp - 0.5 + 1e-9));
  }
};

}  // namespace gdesp::geometry
