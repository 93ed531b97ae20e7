// SPDX-License-Identifier: GPL-3.0-or-later
// The blocks of sph/activity.hpp: a tile is cut into eight along each axis (fewer where the domain is so large that
// their dense numbering would not fit).
#pragma once

#include "exec/backend.hpp"
#include "neighbors/domain.hpp"

namespace gdesp::sph {

using exec::Index;

struct BlockGrid {
  Domain domain;
  int shift[3] = {0, 0, 0};  ///< bits of a fraction that lie below a block
  Vec3<std::int32_t> count{1, 1, 1};

  GDESP_HD Index blocks() const { return count.x * count.y * count.z; }
  GDESP_HD Index number(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return (z * count.y + y) * count.x + x;
  }
  GDESP_HD Vec3<std::int32_t> coordinates(Index b) const {
    return {b % count.x, (b / count.x) % count.y, b / (count.x * count.y)};
  }
  /// Inside: periodic axes wrap, others end at the border.
  GDESP_HD std::int32_t inside(std::int32_t k, int axis) const {
    const std::int32_t n = count[axis];
    if (domain.periodic[axis]) return ((k % n) + n) % n;
    return k < 0 ? 0 : (k >= n ? n - 1 : k);
  }
  GDESP_HD Index block_of(const FixedPosition& p) const {
    return number(inside(static_cast<std::int32_t>(p.x >> shift[0]), 0),
                  inside(static_cast<std::int32_t>(p.y >> shift[1]), 1),
                  inside(static_cast<std::int32_t>(p.z >> shift[2]), 2));
  }
};

inline BlockGrid make_block_grid(const Domain& domain) {
  constexpr double most_blocks = 1 << 24;
  BlockGrid grid;
  grid.domain = domain;
  for (int bits = 3; bits >= 0; --bits) {
    double blocks = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const int b = axis == 1 && domain.dimensions == 2 ? 0 : bits;
      grid.shift[axis] = Domain::fraction_bits - b;
      grid.count[axis] = domain.tiles[axis] << b;
      blocks *= static_cast<double>(grid.count[axis]);
    }
    if (blocks <= most_blocks) break;
  }
  return grid;
}

}  // namespace gdesp::sph
