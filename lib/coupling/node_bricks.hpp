// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes as particles read them: bricks of up to 8 x 8 x 8 cells with two more nodes on every side, so that the 4 x 4 x 4
// nodes around any particle of a brick lie in it, four quantities a node and four nodes along x side by side: sixteen
// numbers in a row, one for each lane. A node stands in up to eight bricks.
#pragma once

#include "coupling/node_cells.hpp"
#include "exec/parallel.hpp"

namespace gdesp::coupling {

/// Nodes of a brick beyond its cells, on each side.
inline constexpr std::int32_t brick_margin = 2;
/// Sets of four quantities a node.
inline constexpr Index brick_groups = 3;

/// How a tile is cut into bricks.
struct BrickShape {
  Vec3<std::int32_t> cells;   ///< of a brick, along each axis; the last of a tile may have fewer
  Vec3<std::int32_t> bricks;  ///< of a tile
  Vec3<std::int32_t> nodes;   ///< of a brick, with those around it; 1 along y in the plane

  BrickShape() = default;
  explicit BrickShape(const NodeLattice& lattice);
  GDESP_HD Index bricks_of_tile() const { return bricks.x * bricks.y * bricks.z; }
  GDESP_HD Index nodes_of_brick() const { return nodes.x * nodes.y * nodes.z; }
  GDESP_HD Index number(const Vec3<std::int32_t>& b) const { return (b.z * bricks.y + b.y) * bricks.x + b.x; }
  /// Cell of its tile that node `n` of a brick belongs to; outside 0 .. count - 1: to a tile around it.
  GDESP_HD Vec3<std::int32_t> cell(Index brick, Index n) const {
    const Vec3<std::int32_t> b{brick % bricks.x, brick / bricks.x % bricks.y, brick / (bricks.x * bricks.y)},
        at{n % nodes.x, n / nodes.x % nodes.y, n / (nodes.x * nodes.y)};
    return {b.x * cells.x + at.x - brick_margin, b.y * cells.y + at.y - (nodes.y > 1 ? brick_margin : 0),
            b.z * cells.z + at.z - brick_margin};
  }
};

struct NodeBricksView {
  NodeCells cells;
  BrickShape shape;
  const Index* brick;  ///< per wanted tile and brick of it: number, -1: no node in reach
  const float* value;  ///< [brick][group][node][quantity]

  /// Group 0 of the first of the 4 x 4 x 4 nodes that begin at (first.x, first.y, first.z) of tile `t`; null when none of them is there.
  /// The particle may be up to half a cell outside the tile.
  GDESP_HD const float* at(const Vec3<std::int32_t>& t, const Vec3<std::int32_t>& first) const;
  /// Floats from one group to the next.
  GDESP_HD Index group_stride() const { return 4 * shape.nodes_of_brick(); }
};

inline BrickShape::BrickShape(const NodeLattice& lattice) {
  constexpr std::int32_t most = 8;
  for (int a = 0; a < 3; ++a) {
    bricks[a] = (lattice.count[a] + most - 1) / most;
    cells[a] = (lattice.count[a] + bricks[a] - 1) / bricks[a];
    nodes[a] = cells[a] + 2 * brick_margin;
  }
  if (lattice.count.y == 1) nodes.y = 1;
}

GDESP_HD inline const float* NodeBricksView::at(const Vec3<std::int32_t>& t, const Vec3<std::int32_t>& first) const {
  const Domain& domain = cells.lattice.domain;
  const Index number = (t.z * domain.tiles.y + t.y) * domain.tiles.x + t.x;
  if (!cells.wanted[number]) return nullptr;
  Vec3<std::int32_t> b, n;
  for (int a = 0; a < 3; ++a) {
    if (shape.nodes[a] == 1) {
      b[a] = n[a] = 0;
      continue;
    }
    // The cell of the second of the four, where the particle is within half a cell.
    const std::int32_t second = first[a] + 1, last = cells.lattice.count[a] - 1;
    if (second < -1 || second > last) return nullptr;
    b[a] = (second < 0 ? 0 : second) / shape.cells[a];
    n[a] = first[a] - b[a] * shape.cells[a] + brick_margin;
  }
  const Index found = brick[cells.storage[number] * shape.bricks_of_tile() + shape.number(b)];
  if (found < 0) return nullptr;
  const Index node = (n.z * shape.nodes.y + n.y) * shape.nodes.x + n.x;
  return value + 4 * (static_cast<std::int64_t>(found) * brick_groups * shape.nodes_of_brick() + node);
}

// Values of bricks from sums by cluster of nodes.
template <class Recipe>
struct FillBricks {
  BrickShape shape;
  AveragingSpline spline;
  const Index* list;    // per brick: which of which tile
  const Index* source;  // per node of a brick: slot of the node, or -1
  const float* sums;
  Index rows;  // floats of `sums` a cluster
  Recipe recipe;
  float* value;
  GDESP_HD void operator()(Index k) const {
    const Index nodes = shape.nodes_of_brick(), brick = k / nodes, n = k % nodes, s = source[k];
    if (s < 0) return;  // 0 since it was made
    const Vec3<std::int32_t> cell = shape.cell(list[brick] % shape.bricks_of_tile(), n);
    const Vec3f r{(static_cast<float>(cell.x) + 0.5f) / spline.inverse_spacing.x,
                  (static_cast<float>(cell.y) + 0.5f) / spline.inverse_spacing.y,
                  (static_cast<float>(cell.z) + 0.5f) / spline.inverse_spacing.z};
    float out[4 * brick_groups] = {};
    recipe(sums + static_cast<std::int64_t>(rows) * (s / exec::cluster_size) + s % exec::cluster_size, r, out);
    for (Index g = 0; g < recipe.groups; ++g) {
      float* to = value + 4 * ((static_cast<std::int64_t>(brick) * brick_groups + g) * nodes + n);
      for (int q = 0; q < 4; ++q) to[q] = out[4 * g + q];
    }
  }
};

template <class Exec>
class NodeBricks {
 public:
  NodeBricks(const Exec& exec, const NodeLattice& lattice);

  /// `tile`: dense number of each wanted tile; `node_of_cell`: -1, or the number of a node; `slot_of_node`: where its sums stand.
  void build(const NodeCells& cells, const Array<Index, Exec>& tile, Index tiles,
             const Array<Index, Exec>& node_of_cell, const Array<Index, Exec>& slot_of_node);

  /// Takes what particles will read from the nodes' sums: recipe(sums of a node, its place from the origin of the tile (m), out).
  template <class Recipe>
  void fill(const char* name, const float* sums, Index rows, const Recipe& recipe) {
    if (value_.size() != source_.size() * 4 * brick_groups) make_room();
    exec::parallel_for(
        exec_, name, static_cast<Index>(source_.size()),
        FillBricks<Recipe>{shape_, lattice_.spline(), list_.data(), source_.data(), sums, rows, recipe, value_.data()});
  }

  NodeBricksView view(const NodeCells& cells) const { return {cells, shape_, brick_.data(), value_.data()}; }

  /// The members that a checkpoint keeps (exec/state_archive.hpp).
  template <class Archive>
  void archive(Archive& a) {
    a(brick_, list_, source_);
  }

 private:
  void make_room() {
    value_.resize_discard(source_.size() * 4 * brick_groups);
    value_.fill_bytes(0);
  }

  Exec exec_;
  NodeLattice lattice_;
  BrickShape shape_;
  Array<Index, Exec> wanted_, brick_, list_, source_;
  Array<std::uint8_t, Exec> marked_;
  Array<float, Exec> value_;
};

}  // namespace gdesp::coupling
