// SPDX-License-Identifier: GPL-3.0-or-later
// A set of particles sorted for neighbour loops: by tile, then by pencil (a column of cells along x), then along x;
// each pencil starts a new cluster of four. A particle's place in the sorted order is its slot; slots at pencil ends
// are padding (FixedPosition with x = padding_mark, id = no_particle). Cells give the clusters near a point without
// a search. Grains, fluid and wall particles are three sets with cells of their own size on the same tiles: the
// dual grid of the paper.
#pragma once

#include "exec/permute.hpp"
#include "neighbors/domain.hpp"

namespace gdesp {

using exec::Array;
using exec::Index;

inline constexpr std::uint32_t no_particle = 0xffffffffu;

/// What kernels see of the grid of a ClusterSet.
struct CellGridView {
  Domain domain;
  Vec3<std::int32_t> cells;        ///< per tile and axis
  Vec3f inverse_cell_size;         ///< 1/m
  const Index* tile_slot;          ///< per dense tile number: storage slot, -1 when the tile holds no particle
  const Index* cell_begin;         ///< [storage slot][pencil = cz * cells.y + cy][cell x 0..cells.x]: first slot
  const std::uint64_t* block;      ///< [storage slot][z block 0..7]: bit 8 y + x of blocks that hold a particle
  Vec3<std::int32_t> block_shift;  ///< cell >> block_shift is its block, 0..7, along each axis
  const Vec3<std::int32_t>* cluster_tile;  ///< per cluster: tile coordinates
  Index clusters;

  /// Row of cells.x + 1 starts of a pencil.
  GDESP_HD const Index* pencil(Index storage, std::int32_t cy, std::int32_t cz) const {
    const std::int64_t row = (static_cast<std::int64_t>(storage) * cells.z + cz) * cells.y + cy;
    return cell_begin + row * (cells.x + 1);
  }
};

/// Sorts and indexes; the owner keeps its own arrays by slot and permutes them with `source()`.
template <class Exec>
class ClusterSet {
 public:
  ClusterSet() = default;
  /// Cells of about `cell_size` metres in y and z (the largest whole share of a tile that is at least that), and of a
  /// 1/finer to half of that in x, where they make searches shorter and take four bytes each.
  ClusterSet(const Exec& exec, const Domain& domain, double cell_size, int finer = 2);

  /// Sorts. position[old], id[old] for old in [0, old_slots): padding (id = no_particle) and particles outside
  /// the domain are left out. Afterwards source()[slot] is the old slot (or -1: padding), and the owner
  /// gathers (with Domain::wrapped for positions). What is in `room` (24 bytes a slot are needed) is lost.
  template <class R>
  void build(const Array<FixedPosition, Exec>& position, const Array<std::uint32_t, Exec>& id, Index old_slots,
             Array<R, Exec>& room) {
    build_in(position, id, old_slots, exec::room_for<std::uint64_t>(room, sorting_words(old_slots)));
  }

  /// Gives back the memory that only build() uses, of a set that will not be built again.
  void free_workspace();

  Index slots() const { return slots_; }  ///< 4 x clusters
  Index clusters() const { return slots_ / exec::cluster_size; }
  Index particles() const { return particles_; }  ///< real ones
  Index lost() const { return lost_; }            ///< left out by the last build because outside the domain
  const Index* source() const { return source_.data(); }
  CellGridView view() const;

  /// The members that a checkpoint keeps (exec/state_archive.hpp).
  template <class Archive>
  void archive(Archive& a) {
    a(slots_, particles_, lost_, source_, tile_slot_, cell_begin_, block_, cluster_tile_);
  }

 private:
  // Two sets of keys (and one more: see MarkPencilHeads) and of old slots.
  static std::size_t sorting_words(Index old_slots) { return 3 * static_cast<std::size_t>(old_slots) + 3; }
  void build_in(const Array<FixedPosition, Exec>& position, const Array<std::uint32_t, Exec>& id, Index old_slots,
                std::uint64_t* room);

  Exec exec_{};
  Domain domain_;
  Vec3<std::int32_t> cells_{1, 1, 1}, block_shift_{0, 0, 0};
  int pencil_bits_ = 0, tile_bits_ = 0;
  Index slots_ = 0, particles_ = 0, lost_ = 0;
  Array<Index, Exec> pencil_first_, padded_count_, padded_begin_;
  Array<Index, Exec> tile_head_, tile_ordinal_;
  Array<Index, Exec> source_, tile_slot_, cell_begin_;
  Array<std::uint64_t, Exec> block_;
  Array<Vec3<std::int32_t>, Exec> cluster_tile_;
};

/// Particles within `cutoff` (m) of the box [low, high] (m, local to tile `tile`; a point is a box) lie in the
/// clusters this visits: visit(first_cluster, last_cluster, offset), last inclusive. Adding offset * tile_size to the
/// local coordinates of those clusters brings them into the frame of `tile`. The cutoff must be smaller than a tile.
template <class Visit>
GDESP_HD inline void for_each_candidate(const CellGridView& grid, const Vec3<std::int32_t>& tile, const Vec3f& low,
                                        const Vec3f& high, float cutoff, const Visit& visit);

}  // namespace gdesp

#include "neighbors/cluster_set.inl"
