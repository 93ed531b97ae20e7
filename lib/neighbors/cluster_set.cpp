// SPDX-License-Identifier: GPL-3.0-or-later
#include "neighbors/cluster_set.hpp"

#include <algorithm>

#include "core/error.hpp"

namespace gdesp {
namespace {

constexpr int x_bits = 10;  // order along a pencil: 1/1024 of a tile, a sixteenth of a spacing

// Pencils follow each other in Z order (bits of y and z interleaved), so that the pencils around a pencil are near it in
// memory too, whatever the size of a cache (docs/decisions/0012).
GDESP_HD inline std::uint32_t spread_bits(std::uint32_t n) {  // sixteen bits to every second place
  n = (n | (n << 8)) & 0x00ff00ffu;
  n = (n | (n << 4)) & 0x0f0f0f0fu;
  n = (n | (n << 2)) & 0x33333333u;
  return (n | (n << 1)) & 0x55555555u;
}
GDESP_HD inline std::int32_t gathered_bits(std::uint32_t n) {
  n &= 0x55555555u;
  n = (n | (n >> 1)) & 0x33333333u;
  n = (n | (n >> 2)) & 0x0f0f0f0fu;
  n = (n | (n >> 4)) & 0x00ff00ffu;
  return static_cast<std::int32_t>((n | (n >> 8)) & 0x0000ffffu);
}
GDESP_HD inline std::uint32_t pencil_number(std::int32_t cy, std::int32_t cz) {
  return spread_bits(static_cast<std::uint32_t>(cy)) | (spread_bits(static_cast<std::uint32_t>(cz)) << 1);
}

// A particle's place among the cells, and its sort key.
struct KeyMaker {
  Domain domain;
  Vec3<std::int32_t> cells;
  int pencil_bits;
  std::int64_t tiles;

  GDESP_HD static std::int32_t cell(std::int64_t p, std::int32_t count) {
    return static_cast<std::int32_t>(
        (static_cast<std::uint64_t>(Domain::fraction_of(p)) * static_cast<std::uint64_t>(count)) >>
        Domain::fraction_bits);
  }
  GDESP_HD std::uint64_t key(const FixedPosition& p) const {
    const std::uint64_t pencil = pencil_number(cell(p.y, cells.y), cell(p.z, cells.z));
    const std::uint64_t x = Domain::fraction_of(p.x) >> (Domain::fraction_bits - x_bits);
    return (((static_cast<std::uint64_t>(domain.tile_number(p)) << pencil_bits) | pencil) << x_bits) | x;
  }
  GDESP_HD std::uint64_t last_key() const { return (static_cast<std::uint64_t>(tiles) << pencil_bits) << x_bits; }
};

struct MakeKeys {
  KeyMaker maker;
  const FixedPosition* position;
  const std::uint32_t* id;
  std::uint64_t* keys;
  Index* order;

  GDESP_HD void operator()(Index i) const {
    const FixedPosition p = maker.domain.wrapped(position[i]);
    const bool stays = id[i] != no_particle && maker.domain.inside(p);
    keys[i] = stays ? maker.key(p) : maker.last_key();
    order[i] = i;
  }
};

struct Tally {
  Index particles, lost;
};
struct CountParticles {
  const std::uint64_t* keys;  // not sorted yet
  std::uint64_t last_key;
  const std::uint32_t* id;
  GDESP_HD Tally operator()(Index i) const {
    if (keys[i] != last_key) return {1, 0};
    return {0, id[i] == no_particle ? 0 : 1};
  }
};
struct AddTally {
  GDESP_HD Tally operator()(const Tally& a, const Tally& b) const {
    return {a.particles + b.particles, a.lost + b.lost};
  }
};

struct MarkPencilHeads {
  const std::uint64_t* keys;
  Index* head;
  GDESP_HD void operator()(Index k) const {
    head[k] = (k == 0 || (keys[k] >> x_bits) != (keys[k - 1] >> x_bits)) ? 1 : 0;
  }
};

struct WritePencilFirsts {
  const Index* head;
  const Index* ordinal;
  Index* pencil_first;
  GDESP_HD void operator()(Index k) const {
    if (head[k]) pencil_first[ordinal[k]] = k;
  }
};

struct CountPadded {
  const std::uint64_t* keys;
  const Index* pencil_first;
  Index pencils, particles;
  int tile_shift;
  Index* padded_count;
  Index* tile_head;
  GDESP_HD void operator()(Index o) const {
    const Index end = o + 1 < pencils ? pencil_first[o + 1] : particles;
    padded_count[o] = (end - pencil_first[o] + 3) / 4 * 4;
    const std::uint64_t tile = keys[pencil_first[o]] >> tile_shift;
    tile_head[o] = (o == 0 || (keys[pencil_first[o] - 1] >> tile_shift) != tile) ? 1 : 0;
  }
};

struct WriteTileSlots {
  const std::uint64_t* keys;
  const Index* pencil_first;
  const Index* tile_head;
  const Index* tile_ordinal;
  int tile_shift;
  Index* tile_slot;
  GDESP_HD void operator()(Index o) const {
    if (tile_head[o]) tile_slot[keys[pencil_first[o]] >> tile_shift] = tile_ordinal[o];
  }
};

struct PlaceParticles {
  KeyMaker maker;
  const std::uint64_t* keys;
  const Index* order;
  const Index* head;
  const Index* ordinal;
  const Index* pencil_first;
  const Index* padded_begin;
  const Index* tile_slot;
  Index particles;
  int tile_shift;
  Index* source;
  Index* cell_begin;
  Vec3<std::int32_t>* cluster_tile;

  GDESP_HD std::int32_t cell_x(Index k) const {
    const auto x = static_cast<std::int32_t>(keys[k] & ((1u << x_bits) - 1u));
    return (x * maker.cells.x) >> x_bits;
  }
  GDESP_HD void operator()(Index k) const {
    const Index o = ordinal[k] + head[k] - 1;
    const Index slot = padded_begin[o] + (k - pencil_first[o]);
    const std::uint64_t tile = keys[k] >> tile_shift;
    source[slot] = order[k];
    if (slot % exec::cluster_size == 0) {
      cluster_tile[slot / exec::cluster_size] = maker.domain.tile_coordinates(static_cast<std::int32_t>(tile));
    }

    const auto pencil = static_cast<std::uint32_t>((keys[k] >> x_bits) & ((std::uint64_t{1} << maker.pencil_bits) - 1));
    const std::int64_t plane = static_cast<std::int64_t>(tile_slot[tile]) * maker.cells.z + gathered_bits(pencil >> 1);
    Index* row = cell_begin + (plane * maker.cells.y + gathered_bits(pencil)) * (maker.cells.x + 1);
    const std::int32_t cx = cell_x(k);
    for (std::int32_t c = head[k] ? 0 : cell_x(k - 1) + 1; c <= cx; ++c) row[c] = slot;
    if (k + 1 == particles || head[k + 1]) {
      const Index end = padded_begin[o + 1];
      for (std::int32_t c = cx + 1; c <= maker.cells.x; ++c) row[c] = end;
      for (Index s = slot + 1; s < end; ++s) source[s] = -1;
    }
  }
};

// Which of the 8 x 8 x 8 blocks of a tile hold a particle: one word for each layer of blocks.
struct MarkBlocks {
  CellGridView grid;
  std::uint64_t* block;

  GDESP_HD std::uint64_t blocks_of(const Index* row) const {
    std::uint64_t bits = 0;
    const std::int32_t step = 1 << grid.block_shift.x;
    for (std::int32_t first = 0, b = 0; first < grid.cells.x; first += step, ++b) {
      const std::int32_t end = first + step < grid.cells.x ? first + step : grid.cells.x;
      if (row[end] > row[first]) bits |= std::uint64_t{1} << b;
    }
    return bits;
  }
  GDESP_HD void operator()(Index i) const {
    const std::int32_t first = (i & 7) << grid.block_shift.z, beyond = first + (1 << grid.block_shift.z);
    std::uint64_t bits = 0;
    for (std::int32_t cz = first; cz < beyond && cz < grid.cells.z; ++cz) {
      for (std::int32_t cy = 0; cy < grid.cells.y; ++cy) {
        bits |= blocks_of(grid.pencil(i >> 3, cy, cz)) << (8 * (cy >> grid.block_shift.y));
      }
    }
    block[i] = bits;
  }
};

int bits_for(std::uint64_t largest) {
  int bits = 1;
  while (largest >>= 1) ++bits;
  return bits;
}

}  // namespace

template <class Exec>
ClusterSet<Exec>::ClusterSet(const Exec& exec, const Domain& domain, double cell_size, int finer)
    : exec_(exec), domain_(domain), pencil_first_(exec), padded_count_(exec), padded_begin_(exec), tile_head_(exec),
      tile_ordinal_(exec), source_(exec), tile_slot_(exec), cell_begin_(exec), block_(exec), cluster_tile_(exec) {
  for (int axis = 0; axis < 3; ++axis) {
    cells_[axis] = std::max(1, static_cast<std::int32_t>(domain.tile_size[axis] / cell_size + 1e-6));
  }
  if (domain.dimensions == 2) cells_.y = 1;
  // A power of two along the pencil, so that borders of cells are borders of sort keys.
  const std::int32_t fine = finer * cells_.x;
  cells_.x = 1;
  while (cells_.x < fine && cells_.x < (1 << x_bits)) cells_.x *= 2;
  for (int axis = 0; axis < 3; ++axis) {
    while ((cells_[axis] - 1) >> block_shift_[axis] > 7) ++block_shift_[axis];
  }
  const std::int64_t tiles = static_cast<std::int64_t>(domain.tiles.x) * domain.tiles.y * domain.tiles.z;
  if (tiles > (std::int64_t{1} << 28)) {
    throw Error(ErrorKind::input,
                "the domain is too large for its resolution: " + std::to_string(tiles) +
                    " blocks of 64 spacings, at most 268435456; give a smaller domain or a larger dp");
  }
  pencil_bits_ = bits_for(pencil_number(cells_.y - 1, 0) | pencil_number(0, cells_.z - 1));
  tile_bits_ = bits_for(static_cast<std::uint64_t>(tiles));
  tile_slot_.resize_discard(static_cast<std::size_t>(tiles));
  tile_slot_.fill_bytes(0xff);
}

template <class Exec>
void ClusterSet<Exec>::build_in(const Array<FixedPosition, Exec>& position, const Array<std::uint32_t, Exec>& id,
                                Index old_slots, std::uint64_t* room) {
  const std::int64_t tiles = static_cast<std::int64_t>(domain_.tiles.x) * domain_.tiles.y * domain_.tiles.z;
  const KeyMaker maker{domain_, cells_, pencil_bits_, tiles};
  const int tile_shift = x_bits + pencil_bits_;
  const auto n = static_cast<std::size_t>(old_slots);
  Index* orders = reinterpret_cast<Index*>(room + 2 * (n + 1));
  exec::SortedPairs sorted{room, orders, room + n + 1, orders + n};
  exec::parallel_for(exec_, "sort::keys", old_slots,
                     MakeKeys{maker, position.data(), id.data(), sorted.keys, sorted.values});
  const Tally tally = exec::reduce(exec_, "sort::count", old_slots, Tally{0, 0},
                                   CountParticles{sorted.keys, maker.last_key(), id.data()}, AddTally{});
  particles_ = tally.particles;
  lost_ = tally.lost;
  exec::sort_pairs(exec_, "sort::radix", sorted, old_slots, tile_shift + tile_bits_);
  const std::uint64_t* keys = sorted.keys;

  const auto count = static_cast<std::size_t>(particles_);
  Index* head = reinterpret_cast<Index*>(sorted.other_keys);  // idle now; it holds n + 1 words
  Index* ordinal = head + count + 1;
  exec::parallel_for(exec_, "sort::heads", particles_, MarkPencilHeads{keys, head});
  const Index pencils = exec::exclusive_scan(exec_, "sort::scan", head, ordinal, particles_);
  const auto p = static_cast<std::size_t>(pencils);
  for (auto* array : {&pencil_first_, &padded_count_, &padded_begin_, &tile_head_, &tile_ordinal_}) {
    array->resize_discard(p + 1);
  }
  exec::parallel_for(exec_, "sort::heads", particles_, WritePencilFirsts{head, ordinal, pencil_first_.data()});
  exec::parallel_for(exec_, "sort::heads", pencils,
                     CountPadded{keys, pencil_first_.data(), pencils, particles_, tile_shift, padded_count_.data(),
                                 tile_head_.data()});
  slots_ = exec::exclusive_scan(exec_, "sort::scan", padded_count_.data(), padded_begin_.data(), pencils);
  const Index used_tiles = exec::exclusive_scan(exec_, "sort::scan", tile_head_.data(), tile_ordinal_.data(), pencils);

  tile_slot_.fill_bytes(0xff);
  cell_begin_.resize_discard(static_cast<std::size_t>(used_tiles) * static_cast<std::size_t>(cells_.z) *
                             static_cast<std::size_t>(cells_.y) * (static_cast<std::size_t>(cells_.x) + 1));
  cell_begin_.fill_bytes(0);
  source_.resize_discard(static_cast<std::size_t>(slots_));
  cluster_tile_.resize_discard(static_cast<std::size_t>(clusters()));
  exec::parallel_for(exec_, "sort::tiles", pencils,
                     WriteTileSlots{keys, pencil_first_.data(), tile_head_.data(), tile_ordinal_.data(), tile_shift,
                                    tile_slot_.data()});
  exec::parallel_for(exec_, "sort::place", particles_,
                     PlaceParticles{maker, keys, sorted.values, head, ordinal, pencil_first_.data(),
                                    padded_begin_.data(), tile_slot_.data(), particles_, tile_shift, source_.data(),
                                    cell_begin_.data(), cluster_tile_.data()});
  block_.resize_discard(8 * static_cast<std::size_t>(used_tiles));
  exec::parallel_for(exec_, "sort::blocks", 8 * used_tiles, MarkBlocks{view(), block_.data()});
}

template <class Exec>
void ClusterSet<Exec>::free_workspace() {
  for (auto* array : {&pencil_first_, &padded_count_, &padded_begin_, &tile_head_, &tile_ordinal_}) array->free();
}

template <class Exec>
CellGridView ClusterSet<Exec>::view() const {
  CellGridView view{};
  view.domain = domain_;
  view.cells = cells_;
  for (int axis = 0; axis < 3; ++axis) {
    view.inverse_cell_size[axis] = static_cast<float>(cells_[axis] / domain_.tile_size[axis]);
  }
  view.tile_slot = tile_slot_.data();
  view.cell_begin = cell_begin_.data();
  view.block = block_.data();
  view.block_shift = block_shift_;
  view.cluster_tile = cluster_tile_.data();
  view.clusters = clusters();
  return view;
}

template class ClusterSet<exec::CompiledBackend>;

}  // namespace gdesp
