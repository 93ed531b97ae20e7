// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/averaging_nodes.hpp"

#include <algorithm>
#include <cmath>

#include "exec/flags.hpp"
#include "exec/parallel.hpp"

namespace gdesp::coupling {
namespace {

// Tiles that hold grains, and those around them.
struct WantTiles {
  Domain domain;
  const Index* grain_tile;  // per dense tile number: -1 without grains
  Index* wanted;
  GDESP_HD void operator()(Index t) const {
    const Vec3<std::int32_t> at = domain.tile_coordinates(t);
    Index any = 0;
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const std::int32_t tx = detail::neighbour_tile(at.x, x, domain.tiles.x, domain.periodic[0]);
          const std::int32_t ty = detail::neighbour_tile(at.y, y, domain.tiles.y, domain.periodic[1]);
          const std::int32_t tz = detail::neighbour_tile(at.z, z, domain.tiles.z, domain.periodic[2]);
          if (tx < 0 || ty < 0 || tz < 0) continue;
          if (grain_tile[(static_cast<std::int64_t>(tz) * domain.tiles.y + ty) * domain.tiles.x + tx] >= 0) any = 1;
        }
    wanted[t] = any;
  }
};

struct NumberTiles {
  const Index* wanted;
  const Index* storage;
  Index* tile;
  GDESP_HD void operator()(Index t) const {
    if (wanted[t]) tile[storage[t]] = t;
  }
};

template <class Position>
struct MarkOccupied {
  NodeCells cells;
  Position position;
  const std::uint32_t* id;
  std::uint8_t* occupied;
  GDESP_HD void operator()(Index s) const {
    if (id[s] == no_particle) return;
    const Domain& domain = cells.lattice.domain;
    const FixedPosition p = domain.wrapped(position[s]);
    if (!domain.inside(p)) return;
    const Index t = domain.tile_number(p);
    if (!cells.wanted[t]) return;
    exec::set_flag(occupied + cells.number(t, {cells.along(p.x, 0), cells.along(p.y, 1), cells.along(p.z, 2)}));
  }
};

// What lies within `reach` cells of an occupied one.
struct MarkNear {
  NodeCells cells;
  const Index* tile;
  const std::uint8_t* occupied;
  int reach;
  std::uint8_t* near;
  GDESP_HD void operator()(Index k) const {
    if (!occupied[k]) return;
    const Vec3<std::int32_t> at = cells.lattice.domain.tile_coordinates(tile[k / cells.lattice.nodes_of_tile()]);
    cells.for_each_around(at, cells.in_tile(k), reach,
                          [&](Index t, const Vec3<std::int32_t>& c) { exec::set_flag(near + cells.number(t, c)); });
  }
};

struct CountInRow {
  const std::uint8_t* near_grains;
  const std::uint8_t* near_water;
  std::int32_t width;
  Index* count;
  GDESP_HD void operator()(Index row) const {
    Index n = 0;
    for (std::int32_t x = 0; x < width; ++x) {
      const std::int64_t k = static_cast<std::int64_t>(row) * width + x;
      n += near_grains[k] && near_water[k] ? 1 : 0;
    }
    count[row] = n;
  }
};

struct WriteNodes {
  NodeCells cells;
  const Index* tile;
  const std::uint8_t* near_grains;
  const std::uint8_t* near_water;
  const Index* begin;
  std::int64_t plane_y;  // of all nodes in the plane
  FixedPosition* position;
  std::uint32_t* id;
  Index* node_of_cell;

  GDESP_HD std::int64_t place(std::int32_t t, std::int32_t c, int axis) const {
    const std::int64_t unit = std::int64_t{1} << Domain::fraction_bits;
    return t * unit + (2 * c + 1) * unit / (2 * cells.lattice.count[axis]);
  }
  GDESP_HD void operator()(Index row) const {
    const Vec3<std::int32_t> count = cells.lattice.count;
    const Index rows_of_tile = count.y * count.z;
    const Vec3<std::int32_t> at = cells.lattice.domain.tile_coordinates(tile[row / rows_of_tile]);
    const std::int32_t cz = row % rows_of_tile / count.y, cy = row % count.y;
    Index n = begin[row];
    for (std::int32_t x = 0; x < count.x; ++x) {
      const std::int64_t k = static_cast<std::int64_t>(row) * count.x + x;
      node_of_cell[k] = -1;
      if (!near_grains[k] || !near_water[k]) continue;
      const bool plane = cells.lattice.domain.dimensions == 2;
      position[n] = {place(at.x, x, 0), plane ? plane_y : place(at.y, cy, 1), place(at.z, cz, 2)};
      id[n] = static_cast<std::uint32_t>(n);
      node_of_cell[k] = n++;
    }
  }
};

struct InvertOrder {
  const Index* source;
  Index* slot_of_node;
  GDESP_HD void operator()(Index s) const {
    if (source[s] >= 0) slot_of_node[source[s]] = s;
  }
};

struct PackNodes {
  Domain domain;
  const Vec3<std::int32_t>* cluster_tile;
  const FixedPosition* position;
  const Index* source;
  float* record;
  GDESP_HD void operator()(Index s) const {
    const Index c = s / exec::cluster_size;
    float* r = record + record_offset(c) + s % exec::cluster_size;
    const Vec3f x = source[s] >= 0 ? domain.relative_to_tile(position[source[s]], cluster_tile[c])
                                   : Vec3f{padding_coordinate, padding_coordinate, padding_coordinate};
    r[0] = x.x;
    r[4] = x.y;
    r[8] = x.z;
  }
};

}  // namespace

template <class Exec>
AveragingNodes<Exec>::AveragingNodes(const Exec& exec, const NodeLattice& lattice)
    : exec_(exec), lattice_(lattice), set_(exec, lattice.domain, 2.0 * lattice.widest_spacing()),
      bricks_(exec, lattice), wanted_(exec), storage_(exec), tile_(exec), row_count_(exec), row_begin_(exec),
      node_of_cell_(exec), slot_of_node_(exec), occupied_(exec), near_grains_(exec), near_water_(exec), position_(exec),
      id_(exec), record_(exec), room_(exec) {}

template <class Exec>
template <class Position>
void AveragingNodes<Exec>::mark_near(const PlacesOfSet<Position>& places, Index cells, int reach,
                                     Array<std::uint8_t, Exec>& near) {
  occupied_.resize_discard(static_cast<std::size_t>(cells));
  near.resize_discard(static_cast<std::size_t>(cells));
  occupied_.fill_bytes(0);
  near.fill_bytes(0);
  exec::parallel_for(exec_, "nodes::occupied", places.slots,
                     MarkOccupied<Position>{node_cells(), places.position, places.id, occupied_.data()});
  exec::parallel_for(exec_, "nodes::near", cells,
                     MarkNear{node_cells(), tile_.data(), occupied_.data(), reach, near.data()});
}

template <class Exec>
void AveragingNodes<Exec>::build(const CellGridView& grain_grid, const PlacesOfSet<dem::GrainPlaces>& grains,
                                 const PlacesOfSet<const FixedPosition*>& water, double skin) {
  const Domain& domain = lattice_.domain;
  const Index tiles = domain.tiles.x * domain.tiles.y * domain.tiles.z;
  wanted_.resize_discard(static_cast<std::size_t>(tiles));
  storage_.resize_discard(static_cast<std::size_t>(tiles) + 1);
  exec::parallel_for(exec_, "nodes::tiles", tiles, WantTiles{domain, grain_grid.tile_slot, wanted_.data()});
  const Index used = exec::exclusive_scan(exec_, "nodes::tiles", wanted_.data(), storage_.data(), tiles);
  tile_.resize_discard(static_cast<std::size_t>(used));
  exec::parallel_for(exec_, "nodes::tiles", tiles, NumberTiles{wanted_.data(), storage_.data(), tile_.data()});

  const Index cells = used * lattice_.nodes_of_tile();
  // A node half a cell away from the far side of the cell of a particle that moves by a skin.
  const int reach = static_cast<int>(std::ceil((lattice_.reach() + skin) / lattice_.narrowest_spacing() - 0.5));
  mark_near(grains, cells, reach, near_grains_);
  mark_near(water, cells, reach, near_water_);

  const Index rows = used * lattice_.count.y * lattice_.count.z;
  row_count_.resize_discard(static_cast<std::size_t>(rows));
  row_begin_.resize_discard(static_cast<std::size_t>(rows) + 1);
  exec::parallel_for(exec_, "nodes::choose", rows,
                     CountInRow{near_grains_.data(), near_water_.data(), lattice_.count.x, row_count_.data()});
  const Index nodes = exec::exclusive_scan(exec_, "nodes::choose", row_count_.data(), row_begin_.data(), rows);
  position_.resize_discard(static_cast<std::size_t>(nodes));
  id_.resize_discard(static_cast<std::size_t>(nodes));
  node_of_cell_.resize_discard(static_cast<std::size_t>(cells));
  exec::parallel_for(exec_, "nodes::write", rows,
                     WriteNodes{node_cells(), tile_.data(), near_grains_.data(), near_water_.data(), row_begin_.data(),
                                domain.fixed({}).y, position_.data(), id_.data(), node_of_cell_.data()});
  set_.build(position_, id_, nodes, room_);
  slot_of_node_.resize_discard(static_cast<std::size_t>(nodes));
  exec::parallel_for(exec_, "nodes::order", set_.slots(), InvertOrder{set_.source(), slot_of_node_.data()});
  bricks_.build(node_cells(), tile_, used, node_of_cell_, slot_of_node_);
  record_.resize_discard(static_cast<std::size_t>(clusters()) * record_size);
  exec::parallel_for(exec_, "nodes::pack", set_.slots(),
                     PackNodes{domain, set_.view().cluster_tile, position_.data(), set_.source(), record_.data()});
}

template class AveragingNodes<exec::CompiledBackend>;

}  // namespace gdesp::coupling
