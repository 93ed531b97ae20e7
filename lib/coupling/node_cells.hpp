// SPDX-License-Identifier: GPL-3.0-or-later
// The cells of the nodes' lattice, one around each node, of those tiles that may have nodes.
#pragma once

#include "coupling/node_lattice.hpp"

namespace gdesp::coupling {

struct NodeCells {
  NodeLattice lattice;
  const Index* wanted;   ///< per dense tile number: whether it may have nodes
  const Index* storage;  ///< per dense tile number: which of the wanted ones it is

  /// Of cell c of tile t, among the cells of all wanted tiles.
  GDESP_HD std::int64_t number(Index t, const Vec3<std::int32_t>& c) const {
    return static_cast<std::int64_t>(storage[t]) * lattice.nodes_of_tile() +
           (c.z * lattice.count.y + c.y) * lattice.count.x + c.x;
  }
  /// The cell along one axis in which a coordinate of a tile lies.
  GDESP_HD std::int32_t along(std::int64_t p, int axis) const {
    return static_cast<std::int32_t>(
        (static_cast<std::uint64_t>(Domain::fraction_of(p)) * static_cast<std::uint64_t>(lattice.count[axis])) >>
        Domain::fraction_bits);
  }
  /// From cell c of tile t along one axis to the one `by` further: false when it lies outside the domain.
  GDESP_HD bool step(int axis, int by, std::int32_t& t, std::int32_t& c) const {
    const Domain& domain = lattice.domain;
    const std::int32_t m = lattice.count[axis], k = c + by;
    const std::int32_t tiles = k >= 0 ? k / m : -((m - 1 - k) / m);
    c = k - tiles * m;
    t += tiles;
    if (domain.periodic[axis]) t = ((t % domain.tiles[axis]) + domain.tiles[axis]) % domain.tiles[axis];
    return t >= 0 && t < domain.tiles[axis];
  }
  /// visit(dense tile number, cell): the cells up to `reach` further along each axis, of wanted tiles.
  template <class Visit>
  GDESP_HD void for_each_around(const Vec3<std::int32_t>& at, const Vec3<std::int32_t>& cell, int reach,
                                const Visit& visit) const {
    const Domain& domain = lattice.domain;
    const int reach_y = lattice.count.y > 1 ? reach : 0;
    for (int z = -reach; z <= reach; ++z) {
      std::int32_t tz = at.z, cz = cell.z;
      if (!step(2, z, tz, cz)) continue;
      for (int y = -reach_y; y <= reach_y; ++y) {
        std::int32_t ty = at.y, cy = cell.y;
        if (!step(1, y, ty, cy)) continue;
        for (int x = -reach; x <= reach; ++x) {
          std::int32_t tx = at.x, cx = cell.x;
          if (!step(0, x, tx, cx)) continue;
          const Index t = (tz * domain.tiles.y + ty) * domain.tiles.x + tx;
          if (wanted[t]) visit(t, Vec3<std::int32_t>{cx, cy, cz});
        }
      }
    }
  }
  /// Coordinates in its tile of cell k of all.
  GDESP_HD Vec3<std::int32_t> in_tile(Index k) const {
    const Index n = k % lattice.nodes_of_tile();
    return {n % lattice.count.x, n / lattice.count.x % lattice.count.y, n / (lattice.count.x * lattice.count.y)};
  }
};

}  // namespace gdesp::coupling
