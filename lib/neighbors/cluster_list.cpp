// SPDX-License-Identifier: GPL-3.0-or-later
#include "neighbors/cluster_list.hpp"

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
  const Index* chosen;  // null: all

  // accept(entry, hit) for each j cluster that may have a pair inside the cutoff; hit: it has one.
  template <class Lanes, class Accept>
  GDESP_HD void for_each_accepted(Index c, const Lanes& lanes, const Accept& accept) const {
    using Real = typename Lanes::Real;
    const float* ri = record_i + record_offset(c);
    Vec3f low, high;
    if (!cluster_box(ri, low, high)) return;
    const Real x = lanes.load_i(ri), y = lanes.load_i(ri + 4), z = lanes.load_i(ri + 8);
    const Vec3<std::int32_t> tile = grid_i.cluster_tile[c];
    const Domain& domain = grid_i.domain;
    const Real cutoff2(cutoff * cutoff);
    for_each_candidate(grid_j, tile, low, high, cutoff, [&](Index first, Index last, const Vec3<std::int32_t>& o) {
      const Real xs = x - Real(static_cast<float>(o.x) * static_cast<float>(domain.tile_size.x));
      const Real ys = y - Real(static_cast<float>(o.y) * static_cast<float>(domain.tile_size.y));
      const Real zs = z - Real(static_cast<float>(o.z) * static_cast<float>(domain.tile_size.z));
      const std::uint32_t code = static_cast<std::uint32_t>((o.z + 1) * 9 + (o.y + 1) * 3 + (o.x + 1));
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
  GDESP_HD void operator()(Index k, const Lanes& lanes) const { build(chosen ? chosen[k] : k, lanes); }

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
    // One walk into a buffer; a second walk when a list is longer than any sane one. Without branches on hits, which
    // no predictor foresees: every entry is written, and the next one over it when it was no hit.
    constexpr std::uint32_t buffer_size = 2048;
    std::uint32_t buffer[buffer_size + 1];
    std::uint32_t n = 0;
    for_each_accepted(c, lanes, [&](std::uint32_t entry, bool hit) {
      buffer[n < buffer_size ? n : buffer_size] = entry;
      n += hit ? 1u : 0u;
    });
    bool crosses = n > buffer_size;
    for (std::uint32_t k = 0; k < n && k < buffer_size; ++k) crosses = crosses | changes_tile(buffer[k]);
    std::uint32_t next = lanes.allocate(used, n);
    const bool fits = next + n <= capacity;
    write_header(c, next, fits ? n : 0u, crosses);
    if (!fits) return;
    if (n <= buffer_size) {
      for (std::uint32_t k = 0; k < n; ++k) entries[next + k] = buffer[k];
    } else {
      for_each_accepted(c, lanes, [&](std::uint32_t entry, bool hit) {
        if (hit) entries[next++] = entry;
      });
    }
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
    exec::pair_pass(exec_, "list::build", chosen.list ? chosen.count : i.clusters,
                    BuildList{i, j, record_i, record_j, cutoff, static_cast<std::uint32_t>(entries_.size()),
                              used_.data(), begin_.data(), count_.data(), total_.data(), entries_.data(), chosen.list});
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
