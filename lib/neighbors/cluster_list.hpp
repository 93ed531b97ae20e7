// SPDX-License-Identifier: GPL-3.0-or-later
// Neighbour lists of clusters. For each cluster of four i particles: the clusters of four j particles with at least
// one pair closer than the cutoff (exact test, "union-pruned"). An entry holds the j cluster and the code of the
// tile offset between the two, so that lists cross tiles and periodic borders. One list format for both back ends.
#pragma once

#include "neighbors/cluster_set.hpp"

namespace gdesp {

/// Eight floats a particle, cluster by cluster: 8 quantities x 4 particles, the first three x, y, z (m, relative to
/// the tile of the cluster). Padding has x = padding_coordinate, further away than any cutoff.
inline constexpr Index record_size = 8 * exec::cluster_size;
inline constexpr float padding_coordinate = 1.0e15f;

GDESP_HD inline std::int64_t record_offset(Index cluster) { return static_cast<std::int64_t>(cluster) * record_size; }

struct ClusterListView {
  static constexpr int code_bits = 5;
  static constexpr std::uint32_t same_tile = 13;  ///< code of offset (0, 0, 0)

  const std::uint32_t* begin;    ///< per i cluster: first entry
  const std::uint32_t* count;    ///< per i cluster: entries; top bit: some entry lies in another tile
  const std::uint32_t* entries;  ///< j cluster << code_bits | code
  Vec3f tile_size;               ///< m

  static constexpr std::uint32_t crosses_bit = 0x80000000u;
};

/// visit(j_cluster, shift) for every entry of i cluster c; shift (m) is what is added to r_i - r_j of the records.
template <class Visit>
GDESP_HD inline void for_each_cluster(const ClusterListView& list, Index c, const Visit& visit) {
  const std::uint32_t begin = list.begin[c];
  const std::uint32_t packed = list.count[c];
  const std::uint32_t end = begin + (packed & ~ClusterListView::crosses_bit);
  if (packed & ClusterListView::crosses_bit) {
    for (std::uint32_t k = begin; k < end; ++k) {
      const std::uint32_t code = list.entries[k] & ((1u << ClusterListView::code_bits) - 1);
      const int ox = static_cast<int>(code % 3) - 1, oy = static_cast<int>(code / 3 % 3) - 1;
      const int oz = static_cast<int>(code / 9) - 1;
      visit(static_cast<Index>(list.entries[k] >> ClusterListView::code_bits),
            Vec3f{-static_cast<float>(ox) * list.tile_size.x, -static_cast<float>(oy) * list.tile_size.y,
                  -static_cast<float>(oz) * list.tile_size.z});
    }
  } else {
    for (std::uint32_t k = begin; k < end; ++k) {
      visit(static_cast<Index>(list.entries[k] >> ClusterListView::code_bits), Vec3f{0.0f, 0.0f, 0.0f});
    }
  }
}

/// The clusters that get lists (others get empty ones); null: all.
struct ChosenIndex {
  const Index* list = nullptr;
  Index count = 0;
};

template <class Exec>
class ClusterList {
 public:
  ClusterList() = default;
  explicit ClusterList(const Exec& exec) : exec_(exec), begin_(exec), count_(exec), entries_(exec), used_(exec) {}

  /// Lists, for each cluster of `i` (records `record_i`), the clusters of `j` with a pair closer than `cutoff` (m).
  /// i and j may be the same set; a cluster is then in its own list.
  void build(const CellGridView& i, const float* record_i, const CellGridView& j, const float* record_j, float cutoff,
             const ChosenIndex& chosen = {});

  ClusterListView view() const;
  std::size_t entries() const { return used_entries_; }

  /// The members that a checkpoint keeps (exec/state_archive.hpp).
  template <class Archive>
  void archive(Archive& a) {
    a(tile_size_, used_entries_, begin_, count_);
    a.prefix(entries_, used_entries_);
  }

 private:
  Exec exec_{};
  Vec3f tile_size_;
  std::size_t used_entries_ = 0;
  Array<std::uint32_t, Exec> begin_, count_, entries_, used_;
};

}  // namespace gdesp
