// SPDX-License-Identifier: GPL-3.0-or-later
#include "neighbors/domain.hpp"

#include <algorithm>

namespace gdesp {

Domain make_domain(const Vec3d& lower, const Vec3d& upper, double dp, const bool periodic[3], int dimensions) {
  constexpr double tile_spacings = 64.0;
  Domain domain;
  domain.lower = lower;
  domain.dimensions = dimensions;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = upper[axis] - lower[axis];
    domain.periodic[axis] = periodic[axis];
    domain.tile_size[axis] = tile_spacings * dp;
    if (periodic[axis]) {
      domain.tiles[axis] = std::max(1, static_cast<std::int32_t>(std::floor(length / domain.tile_size[axis])));
      domain.tile_size[axis] = length / domain.tiles[axis];
    } else {
      domain.tiles[axis] = std::max(1, static_cast<std::int32_t>(std::ceil(length / domain.tile_size[axis] - 1e-9)));
    }
  }
  return domain;
}

}  // namespace gdesp
