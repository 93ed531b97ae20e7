// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/node_bricks.hpp"

#include "exec/flags.hpp"

namespace gdesp::coupling {
namespace {

// Bricks that a node stands in.
struct MarkBricks {
  NodeCells cells;
  BrickShape shape;
  const Index* tile;
  const Index* node_of_cell;
  std::uint8_t* marked;
  GDESP_HD void operator()(Index k) const {
    if (node_of_cell[k] < 0) return;
    const Vec3<std::int32_t> at = cells.lattice.domain.tile_coordinates(tile[k / cells.lattice.nodes_of_tile()]);
    cells.for_each_around(at, cells.in_tile(k), brick_margin, [&](Index t, const Vec3<std::int32_t>& c) {
      const Index b = shape.number({c.x / shape.cells.x, c.y / shape.cells.y, c.z / shape.cells.z});
      exec::set_flag(marked + cells.storage[t] * shape.bricks_of_tile() + b);
    });
  }
};

struct ToIndex {
  const std::uint8_t* marked;
  Index* wanted;
  GDESP_HD void operator()(Index k) const { wanted[k] = marked[k] ? 1 : 0; }
};

struct ListBricks {
  const Index* wanted;
  Index* brick;
  Index* list;
  GDESP_HD void operator()(Index k) const {
    if (wanted[k]) {
      list[brick[k]] = k;
    } else {
      brick[k] = -1;
    }
  }
};

struct FindNodes {
  NodeCells cells;
  BrickShape shape;
  const Index* tile;
  const Index* list;
  const Index* node_of_cell;
  const Index* slot_of_node;
  Index* source;
  GDESP_HD void operator()(Index k) const {
    const Index nodes = shape.nodes_of_brick(), place = list[k / nodes];
    const Domain& domain = cells.lattice.domain;
    Vec3<std::int32_t> t = domain.tile_coordinates(tile[place / shape.bricks_of_tile()]), c{0, 0, 0};
    const Vec3<std::int32_t> by = shape.cell(place % shape.bricks_of_tile(), k % nodes);
    source[k] = -1;
    for (int a = 0; a < 3; ++a) {
      if (!cells.step(a, by[a], t[a], c[a])) return;
    }
    const Index number = (t.z * domain.tiles.y + t.y) * domain.tiles.x + t.x;
    if (!cells.wanted[number]) return;
    const Index node = node_of_cell[cells.number(number, c)];
    if (node >= 0) source[k] = slot_of_node[node];
  }
};

}  // namespace

template <class Exec>
NodeBricks<Exec>::NodeBricks(const Exec& exec, const NodeLattice& lattice)
    : exec_(exec), lattice_(lattice), shape_(lattice), wanted_(exec), brick_(exec), list_(exec), source_(exec),
      marked_(exec), value_(exec) {}

template <class Exec>
void NodeBricks<Exec>::build(const NodeCells& cells, const Array<Index, Exec>& tile, Index tiles,
                             const Array<Index, Exec>& node_of_cell, const Array<Index, Exec>& slot_of_node) {
  const Index places = tiles * shape_.bricks_of_tile();
  marked_.resize_discard(static_cast<std::size_t>(places));
  marked_.fill_bytes(0);
  exec::parallel_for(exec_, "bricks::mark", static_cast<Index>(node_of_cell.size()),
                     MarkBricks{cells, shape_, tile.data(), node_of_cell.data(), marked_.data()});
  wanted_.resize_discard(static_cast<std::size_t>(places));
  brick_.resize_discard(static_cast<std::size_t>(places) + 1);
  exec::parallel_for(exec_, "bricks::number", places, ToIndex{marked_.data(), wanted_.data()});
  const Index bricks = exec::exclusive_scan(exec_, "bricks::number", wanted_.data(), brick_.data(), places);
  list_.resize_discard(static_cast<std::size_t>(bricks));
  exec::parallel_for(exec_, "bricks::number", places, ListBricks{wanted_.data(), brick_.data(), list_.data()});
  source_.resize_discard(static_cast<std::size_t>(bricks) * static_cast<std::size_t>(shape_.nodes_of_brick()));
  exec::parallel_for(
      exec_, "bricks::nodes", static_cast<Index>(source_.size()),
      FindNodes{cells, shape_, tile.data(), list_.data(), node_of_cell.data(), slot_of_node.data(), source_.data()});
  make_room();
}

template class NodeBricks<exec::CompiledBackend>;

}  // namespace gdesp::coupling
