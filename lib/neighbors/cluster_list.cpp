// SPDX-License-Identifier: GPL-3.0-or-later
#include "neighbors/cluster_list.hpp"

#include <type_traits>

#include "core/error.hpp"

namespace gdesp {
namespace {

// The box around the real particles of a cluster; false when it holds padding only.
GDESP_HD bool cluster_box(const float* record, Vec3f& low, Vec3f& high) {
  bool any = false;
  for (int k = 0; k < exec::cluster_size; ++k) {
    const Vec3f r{record[k], record[4 + k], record[8 + k]};
    if (r.x > 0.5f * padding_coordinate) continue;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = any ? exec::min(low[axis], r[axis]) : r[axis];
      high[axis] = any ? exec::max(high[axis], r[axis]) : r[axis];
    }
    any = true;
  }
  return any;
}

struct BuildList {
  CellGridView grid_i, grid_j;
  const float* record_i;
  const float* record_j;
  float cutoff;
  std::uint32_t capacity;
  std::uint32_t* used;
  std::uint32_t* begin;
  std::uint32_t* count;
  std::uint32_t* total;
  std::uint32_t* entries;
  const Index* chosen;     // null: all
  ClusterListView shifts;  // what tile offsets mean

  // visit(first, last, code) for the j clusters that may have a pair inside the cutoff.
  template <class Visit>
  GDESP_HD void for_each_range(Index c, const Visit& visit) const {
    Vec3f low, high;
    if (!cluster_box(record_i + record_offset(c), low, high)) return;
    for_each_candidate(grid_j, grid_i.cluster_tile[c], low, high, cutoff,
                       [&](Index first, Index last, const Vec3<std::int32_t>& o) {
                         visit(first, last, static_cast<std::uint32_t>((o.z + 1) * 9 + (o.y + 1) * 3 + (o.x + 1)));
                       });
  }
  // accept(entry, hit) for each of them; hit: it has one.
  template <class Lanes, class Accept>
  GDESP_HD void for_each_accepted(Index c, const Lanes& lanes, const Accept& accept) const {
    using Real = typename Lanes::Real;
    const float* ri = record_i + record_offset(c);
    const Real x = lanes.load_i(ri), y = lanes.load_i(ri + 4), z = lanes.load_i(ri + 8), cutoff2(cutoff * cutoff);
    for_each_range(c, [&](Index first, Index last, std::uint32_t code) {
      const Vec3f shift = entry_shift(shifts, code);
      const Real xs = x + Real(shift.x), ys = y + Real(shift.y), zs = z + Real(shift.z);
      for (Index j = first; j <= last; ++j) {
        const float* rj = record_j + record_offset(j);
        const Real dx = xs - lanes.load_j(rj), dy = ys - lanes.load_j(rj + 4), dz = zs - lanes.load_j(rj + 8);
        accept((static_cast<std::uint32_t>(j) << ClusterListView::code_bits) | code,
               lanes.any(dx * dx + dy * dy + dz * dz < cutoff2));
      }
    });
  }

  GDESP_HD static bool changes_tile(std::uint32_t entry) {
    return (entry & ((1u << ClusterListView::code_bits) - 1)) != ClusterListView::same_tile;
  }
  GDESP_HD void write_header(Index c, std::uint32_t first, std::uint32_t n, bool crosses) const {
    begin[c] = first;
    total[c] = count[c] = n | (crosses ? ClusterListView::crosses_bit : 0u);
  }

  template <class Lanes>
  GDESP_HD void operator()(Index k, const Lanes& lanes) const {
    build(chosen ? chosen[k] : k, lanes);
  }

  // Two walks: count, fill.
  template <class Lanes>
  GDESP_HD void build_long(Index c, const Lanes& lanes) const {
    std::uint32_t n = 0;
    for_each_accepted(c, lanes, [&](std::uint32_t, bool hit) { n += hit ? 1u : 0u; });
    std::uint32_t next = lanes.allocate(used, n);
    const bool fits = next + n <= capacity;
    write_header(c, next, fits ? n : 0u, true);
    if (!fits) return;
    for_each_accepted(c, lanes, [&](std::uint32_t entry, bool hit) {
      if (hit) entries[next++] = entry;
    });
  }

  template <class Lanes>
  GDESP_HD void build(Index c, const Lanes& lanes) const {
#if defined(__CUDA_ARCH__)
    // Two walks through one piece of code (twice the code would be called, with registers put away): count, take the
    // space, fill.
    std::uint32_t first = 0;
    bool crosses = false;
#pragma unroll 1
    for (int walk = 0; walk < 2; ++walk) {
      const bool fills = walk == 1;
      std::uint32_t n = 0;
      for_each_accepted(c, lanes, [&](std::uint32_t entry, bool hit) {
        if (!hit) return;
        if (fills && lanes.leader()) entries[first + n] = entry;
        crosses = crosses || changes_tile(entry);
        ++n;
      });
      if (fills) return;
      first = lanes.allocate(used, n);
      const bool fits = first + n <= capacity;
      if (lanes.leader()) write_header(c, first, fits ? n : 0u, crosses);
      if (!fits) return;
    }
#else
    // Candidates, then hits, into buffers, without branches that no predictor foresees: sixteen candidates are written
    // where there may be fewer, and every entry, hit or not. Lists longer than any sane one take two walks more.
    constexpr std::uint32_t buffer_size = 2048, at_once = 16;
    std::uint32_t candidates[buffer_size + at_once], hits[buffer_size];
    std::uint32_t found = 0, n = 0;
    bool crosses = false;
    for_each_range(c, [&](Index first, Index last, std::uint32_t code) {
      crosses = crosses || code != ClusterListView::same_tile;
      for (Index j = first; j <= last && found < buffer_size; j += static_cast<Index>(at_once)) {
        for (std::uint32_t k = 0; k < at_once; ++k) {
          candidates[found + k] = ((static_cast<std::uint32_t>(j) + k) << ClusterListView::code_bits) | code;
        }
        const auto left = static_cast<std::uint32_t>(last - j + 1);
        found += left < at_once ? left : at_once;
      }
    });
    if (found >= buffer_size) return build_long(c, lanes);
    const auto test = [&](auto with_shift) {
      using Real = typename Lanes::Real;
      const float* ri = record_i + record_offset(c);
      const Real x = lanes.load_i(ri), y = lanes.load_i(ri + 4), z = lanes.load_i(ri + 8), cutoff2(cutoff * cutoff);
      for (std::uint32_t k = 0; k < found; ++k) {
        const float* rj = record_j + record_offset(static_cast<Index>(candidates[k] >> ClusterListView::code_bits));
        const Vec3f shift = with_shift ? entry_shift(shifts, candidates[k]) : Vec3f{};
        const Real dx = x + Real(shift.x) - lanes.load_j(rj), dy = y + Real(shift.y) - lanes.load_j(rj + 4),
                   dz = z + Real(shift.z) - lanes.load_j(rj + 8);
        hits[n] = candidates[k];
        n += lanes.any(dx * dx + dy * dy + dz * dz < cutoff2) ? 1u : 0u;
      }
    };
    crosses ? test(std::true_type{}) : test(std::false_type{});
    crosses = false;
    for (std::uint32_t k = 0; k < n; ++k) crosses = crosses | changes_tile(hits[k]);
    const std::uint32_t next = lanes.allocate(used, n);
    const bool fits = next + n <= capacity;
    write_header(c, next, fits ? n : 0u, crosses);
    for (std::uint32_t k = 0; fits && k < n; ++k) entries[next + k] = hits[k];
#endif
  }
};

}  // namespace

template <class Exec>
void ClusterList<Exec>::build(const CellGridView& i, const float* record_i, const CellGridView& j,
                              const float* record_j, float cutoff, const ChosenIndex& chosen) {
  tile_size_ = static_cast<Vec3f>(i.domain.tile_size);
  const auto n = static_cast<std::size_t>(i.clusters);
  begin_.resize_discard(n);
  count_.resize_discard(n);
  total_.resize_discard(n);
  used_.resize_discard(1);
  if (i.clusters == 0 || j.clusters == 0) {
    count_.fill_bytes(0);
    total_.fill_bytes(0);
    begin_.fill_bytes(0);
    used_entries_ = 0;
    return;
  }
  if (j.clusters >= (1 << (32 - ClusterListView::code_bits))) {
    throw Error(ErrorKind::resource, "too many particles in one set: at most 536 million");
  }
  // A set with itself: about what 1.3 spacings of h take. Two sets meet at a border only; else this grows once.
  if (entries_.empty()) entries_.resize_discard((i.cell_begin == j.cell_begin ? 40 : 4) * n + 1024);
  for (;;) {
    used_.fill_bytes(0);
    if (chosen.list) {
      count_.fill_bytes(0);
      total_.fill_bytes(0);
    }
    exec::pair_pass(
        exec_, "list::build", chosen.list ? chosen.count : i.clusters,
        BuildList{i, j, record_i, record_j, cutoff, static_cast<std::uint32_t>(entries_.size()), used_.data(),
                  begin_.data(), count_.data(), total_.data(), entries_.data(), chosen.list, view()});
    used_entries_ = used_.read(0);
    if (used_entries_ <= entries_.size()) return;
    entries_.resize_discard(used_entries_ + used_entries_ / 16);
  }
}

template <class Exec>
ClusterTrim ClusterList<Exec>::trim(const float* record_i, const float* record_j, float cutoff) {
  return {view(), record_i, record_j, cutoff * cutoff, total_.data(), count_.data(), entries_.data()};
}

template <class Exec>
ClusterListView ClusterList<Exec>::view() const {
  return {begin_.data(), count_.data(), entries_.data(), tile_size_};
}

template class ClusterList<exec::CompiledBackend>;

}  // namespace gdesp
