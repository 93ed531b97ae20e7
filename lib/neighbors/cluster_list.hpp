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
  const std::uint32_t* count;    ///< per i cluster: entries in use; top bit: some entry lies in another tile
  const std::uint32_t* entries;  ///< j cluster << code_bits | code
  Vec3f tile_size;               ///< m

  static constexpr std::uint32_t crosses_bit = 0x80000000u;
};

/// What is added to r_i - r_j of the records for an entry, m.
GDESP_HD inline Vec3f entry_shift(const ClusterListView& list, std::uint32_t entry) {
  const std::uint32_t code = entry & ((1u << ClusterListView::code_bits) - 1);
  const int ox = static_cast<int>(code % 3) - 1, oy = static_cast<int>(code / 3 % 3) - 1;
  const int oz = static_cast<int>(code / 9) - 1;
  return {-static_cast<float>(ox) * list.tile_size.x, -static_cast<float>(oy) * list.tile_size.y,
          -static_cast<float>(oz) * list.tile_size.z};
}

/// visit(j_cluster, shift) for every entry of i cluster c; shift (m) is what is added to r_i - r_j of the records.
template <class Visit>
GDESP_HD inline void for_each_cluster(const ClusterListView& list, Index c, const Visit& visit) {
  const std::uint32_t begin = list.begin[c];
  const std::uint32_t packed = list.count[c];
  const std::uint32_t end = begin + (packed & ~ClusterListView::crosses_bit);
  if (packed & ClusterListView::crosses_bit) {
    for (std::uint32_t k = begin; k < end; ++k) {
      visit(static_cast<Index>(list.entries[k] >> ClusterListView::code_bits), entry_shift(list, list.entries[k]));
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

/// Called with an i cluster, brings the entries with a pair closer than the cutoff in the records now to the front of
/// its list, in their order, and leaves the others out of use until the next trim or build: much cheaper than build(),
/// so that lists can reach far and passes need not. A pass does it for its cluster before it reads the list, whose
/// records are then at hand (docs/decisions/0011).
struct ClusterTrim {
  ClusterListView list;
  const float* record_i;
  const float* record_j;
  float cutoff2;
  const std::uint32_t* total;
  std::uint32_t* count;
  std::uint32_t* entries;

  // visit(k, entry, near) for the entries begin <= k < end.
  template <bool Crosses, class Lanes, class Visit>
  GDESP_HD void for_each_entry(Index c, const Lanes& lanes, std::uint32_t begin, std::uint32_t end,
                               const Visit& visit) const {
    using Real = typename Lanes::Real;
    const float* ri = record_i + record_offset(c);
    const Real x = lanes.load_i(ri), y = lanes.load_i(ri + 4), z = lanes.load_i(ri + 8);
    for (std::uint32_t k = begin; k < end; ++k) {
      const std::uint32_t entry = entries[k];
      const float* rj = record_j + record_offset(static_cast<Index>(entry >> ClusterListView::code_bits));
      const Vec3f shift = Crosses ? entry_shift(list, entry) : Vec3f{};
      const Real dx = x + Real(shift.x) - lanes.load_j(rj), dy = y + Real(shift.y) - lanes.load_j(rj + 4);
      const Real dz = z + Real(shift.z) - lanes.load_j(rj + 8);
      visit(k, entry, lanes.any(dx * dx + dy * dy + dz * dz < Real(cutoff2)));
    }
  }

  template <bool Crosses, class Lanes>
  GDESP_HD std::uint32_t near_first(Index c, const Lanes& lanes, std::uint32_t begin, std::uint32_t end) const {
    std::uint32_t front = begin;
#if defined(__CUDA_ARCH__)
    for_each_entry<Crosses>(c, lanes, begin, end, [&](std::uint32_t k, std::uint32_t entry, bool near) {
      if (near && lanes.leader()) {
        entries[k] = entries[front];
        entries[front] = entry;
      }
      front += near ? 1u : 0u;
      lanes.share_memory();
    });
#else
    // Without reading what was just written, and without branches on `near`, which no predictor foresees (two counters
    // that change with it would make the compiler branch).
    constexpr std::uint32_t buffer_size = 2048;
    std::uint32_t far[buffer_size];
    if (end - begin > buffer_size) return end;
    for_each_entry<Crosses>(c, lanes, begin, end, [&](std::uint32_t k, std::uint32_t entry, bool near) {
      entries[front] = entry;
      far[k - front] = entry;
      front += near ? 1u : 0u;
    });
    for (std::uint32_t k = front; k < end; ++k) entries[k] = far[k - front];
#endif
    return front;
  }

  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    const std::uint32_t crosses = total[c] & ClusterListView::crosses_bit;
    const std::uint32_t begin = list.begin[c], end = begin + (total[c] & ~ClusterListView::crosses_bit);
    const std::uint32_t front =
        crosses ? near_first<true>(c, lanes, begin, end) : near_first<false>(c, lanes, begin, end);
    if (lanes.leader()) count[c] = (front - begin) | crosses;
    lanes.share_memory();
  }
};

template <class Exec>
class ClusterList {
 public:
  ClusterList() = default;
  explicit ClusterList(const Exec& exec)
      : exec_(exec), begin_(exec), count_(exec), total_(exec), entries_(exec), used_(exec) {}

  /// Lists, for each cluster of `i` (records `record_i`), the clusters of `j` with a pair closer than `cutoff` (m).
  /// i and j may be the same set; a cluster is then in its own list.
  void build(const CellGridView& i, const float* record_i, const CellGridView& j, const float* record_j, float cutoff,
             const ChosenIndex& chosen = {});

  /// What trims these lists to `cutoff` (m). Pairs beyond it are out of use until the next trim or build.
  ClusterTrim trim(const float* record_i, const float* record_j, float cutoff);

  ClusterListView view() const;
  std::size_t entries() const { return used_entries_; }  ///< in use or not

  /// The members that a checkpoint keeps (exec/state_archive.hpp).
  template <class Archive>
  void archive(Archive& a) {
    a(tile_size_, used_entries_, begin_, count_, total_);
    a.prefix(entries_, used_entries_);
  }

 private:
  Exec exec_{};
  Vec3f tile_size_;
  std::size_t used_entries_ = 0;
  Array<std::uint32_t, Exec> begin_, count_, total_, entries_, used_;
};

}  // namespace gdesp
