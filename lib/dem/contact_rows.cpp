// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem/contact_rows.hpp"

#include "exec/permute.hpp"

namespace gdesp::dem {
namespace {

constexpr int search_floats = 16;  // x y z radius, four each, of a cluster

// Places relative to the origin of the cluster's tile, for the search.
struct PackSearch {
  CellGridView grid;
  const GrainRecord* records;
  const FixedPosition* position;
  float* search;
  GDESP_HD void operator()(Index slot) const {
    const Index c = slot / exec::cluster_size;
    float* out = search + search_floats * static_cast<std::int64_t>(c) + slot % exec::cluster_size;
    const float radius = records[slot].radius;
    Vec3f place{};
    if (radius > 0.0f) place = grid.domain.relative_to_tile(position[slot], grid.cluster_tile[c]);
    out[0] = place.x;
    out[4] = place.y;
    out[8] = place.z;
    out[12] = radius;
  }
};

// A contact with a history, kept while the lists that held it are made anew; slots as they were then. Both grains have
// the same history but for the sign: one keeps it, the one of the lower slot. Histories of a grain that is held stand
// still: then it is the other.
struct alignas(16) KeptContact {
  Index neighbour;
  float fx, fy, fz;  // N
};

struct OldRows {
  const RowRange* range;
  const ContactRow* rows;
  const RollingRow* rolling;  // null without rolling resistance

  GDESP_HD bool keeps(Index i, Index j) const { return range[i].held == range[j].held ? i < j : range[j].held != 0; }
  // visit(row, lane, number) for the contacts that grain i keeps.
  template <class Visit>
  GDESP_HD void for_each_history(Index i, const Visit& visit) const {
    const RowRange of = range[i];
    Index number = 0;
    for (Index k = 0; k * 8 < of.count; ++k) {
      const Index r = k == 0 ? i : of.overflow + k - 1;
      for (int l = 0; l < 8; ++l) {
        bool remembers = rows[r].fx[l] != 0.0f || rows[r].fy[l] != 0.0f || rows[r].fz[l] != 0.0f;
        if (rolling)
          remembers = remembers || rolling[r].mx[l] != 0.0f || rolling[r].my[l] != 0.0f || rolling[r].mz[l] != 0.0f;
        if (remembers && keeps(i, rows[r].neighbour[l])) visit(r, l, number++);
      }
    }
  }
};
struct CountKept {
  OldRows old;
  Index* count;
  GDESP_HD void operator()(Index i) const {
    Index kept = 0;
    old.for_each_history(i, [&](Index, int, Index) { ++kept; });
    count[i] = kept;
  }
};
struct KeepHistory {
  OldRows old;
  const Index* begin;
  KeptContact* kept;
  Vec3f* kept_rolling;
  GDESP_HD void operator()(Index i) const {
    old.for_each_history(i, [&](Index r, int l, Index number) {
      const ContactRow& row = old.rows[r];
      kept[begin[i] + number] = {row.neighbour[l], row.fx[l], row.fy[l], row.fz[l]};
      if (old.rolling)
        kept_rolling[begin[i] + number] = {old.rolling[r].mx[l], old.rolling[r].my[l], old.rolling[r].mz[l]};
    });
  }
};

// Four counts of sixteen bits, one for each grain of a cluster.
struct FourCounts {
  std::uint64_t packed = 0;
  GDESP_HD Index operator[](int i) const { return static_cast<Index>((packed >> (16 * i)) & 0xffffu); }
  // bits: four for each grain.
  GDESP_HD void add(unsigned bits) {
    const unsigned pairs = (bits & 0x5555u) + ((bits >> 1) & 0x5555u);
    const unsigned fours = (pairs & 0x3333u) + ((pairs >> 2) & 0x3333u);
    for (int i = 0; i < 4; ++i) packed += static_cast<std::uint64_t>((fours >> (4 * i)) & 15u) << (16 * i);
  }
};
GDESP_HD inline Index ones_below(unsigned bits, int i, int j) {
  unsigned b = (bits >> (4 * i)) & ((1u << j) - 1u);
  Index count = 0;
  for (; b != 0; b &= b - 1) ++count;
  return count;
}

// Lists of the four grains of a cluster. Those about to touch come first, so that later rows are mostly idle.
struct BuildRows {
  CellGridView grid;
  const float* search;
  const GrainRecord* records;
  const Index* source;
  ListReach reach;
  Index slots;
  const Index* kept_begin;  // by old slot; null: no contacts so far
  const KeptContact* kept;
  const Vec3f* kept_rolling;
  RowRange* range;
  ContactRow* rows;
  RollingRow* rolling;
  std::uint32_t* overflow_used;
  Index overflow_capacity;

  // Box around the grains of a cluster and the largest of their radii; false when there are none.
  GDESP_HD static bool cluster_box(const float* r, Vec3f& low, Vec3f& high, float& radius) {
    radius = -1.0f;
    for (int k = 0; k < exec::cluster_size; ++k) {
      if (r[12 + k] < 0.0f) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const float x = r[4 * axis + k];
        low[axis] = radius > 0.0f ? real::min(low[axis], x) : x;
        high[axis] = radius > 0.0f ? real::max(high[axis], x) : x;
      }
      radius = real::max(radius, r[12 + k]);
    }
    return radius > 0.0f;
  }

  // Pairs with j cluster j, as bits.
  struct Found {
    Index j;
    std::uint16_t near, all;
  };
  // visit(found) for each j cluster with pairs within the skin; near: those about to touch.
  template <class Lanes, class Visit>
  GDESP_HD void for_each_near(Index c, const Lanes& lanes, const Visit& visit) const {
    using Real = typename Lanes::Real;
    using real::max;
    const float* own = search + search_floats * static_cast<std::int64_t>(c);
    Vec3f low, high;
    float radius;
    if (!cluster_box(own, low, high, radius)) return;
    const Real x = lanes.load_i(own), y = lanes.load_i(own + 4), z = lanes.load_i(own + 8), r = lanes.load_i(own + 12);
    const Vec3f tile = static_cast<Vec3f>(grid.domain.tile_size);
    const float cutoff = radius + reach.largest_radius + reach.skin + reach.drift;
    for_each_candidate(grid, grid.cluster_tile[c], low, high, cutoff,
                       [&](Index first_cluster, Index last_cluster, const Vec3<std::int32_t>& o) {
                         const Real xs = x - Real(static_cast<float>(o.x) * tile.x),
                                    ys = y - Real(static_cast<float>(o.y) * tile.y);
                         const Real zs = z - Real(static_cast<float>(o.z) * tile.z);
                         for (Index j = first_cluster; j <= last_cluster; ++j) {
                           const float* other = search + search_floats * static_cast<std::int64_t>(j);
                           const Real dx = xs - lanes.load_j(other), dy = ys - lanes.load_j(other + 4),
                                      dz = zs - lanes.load_j(other + 8);
                           const Real r2 = dx * dx + dy * dy + dz * dz;
                           const Real sum = r + lanes.load_j(other + 12);
                           const Real limit = max(sum + Real(reach.skin), Real(0.0f)),
                                      touch = max(sum + Real(0.1f * reach.skin), Real(0.0f));
                           unsigned all = lanes.bits(r2 < limit * limit);
                           if (all == 0) continue;
                           if (j == c && o.x == 0 && o.y == 0 && o.z == 0) all &= ~0x8421u;
                           if (all != 0) {
                             visit(Found{j, static_cast<std::uint16_t>(all & lanes.bits(r2 < touch * touch)),
                                         static_cast<std::uint16_t>(all)});
                           }
                         }
                       });
  }

  GDESP_HD Index row_index(Index slot, Index overflow, Index k) const { return k == 0 ? slot : overflow + k - 1; }
  GDESP_HD void clear(Index index) const {
    ContactRow& row = rows[index];
    for (int l = 0; l < 8; ++l) row.neighbour[l] = slots;
    for (int l = 0; l < 8; ++l) row.fx[l] = row.fy[l] = row.fz[l] = 0.0f;
    if (!rolling) return;
    RollingRow& roll = rolling[index];
    for (int l = 0; l < 8; ++l) roll.mx[l] = roll.my[l] = roll.mz[l] = 0.0f;
  }
  // Number of the contact with j that i kept, or -1; old slots.
  GDESP_HD Index kept_by(Index i, Index j) const {
    for (Index k = kept_begin[i]; k < kept_begin[i + 1]; ++k) {
      if (kept[k].neighbour == j) return k;
    }
    return -1;
  }
  GDESP_HD void copy_history(Index i, Index j, Index index, int lane) const {
    const Index old_i = source ? source[i] : i, old_j = source ? source[j] : j;
    Index k = kept_by(old_i, old_j);
    const float sign = k >= 0 ? 1.0f : -1.0f;
    if (k < 0) k = kept_by(old_j, old_i);
    if (k < 0) return;
    rows[index].fx[lane] = sign * kept[k].fx;
    rows[index].fy[lane] = sign * kept[k].fy;
    rows[index].fz[lane] = sign * kept[k].fz;
    if (!rolling) return;
    rolling[index].mx[lane] = sign * kept_rolling[k].x;
    rolling[index].my[lane] = sign * kept_rolling[k].y;
    rolling[index].mz[lane] = sign * kept_rolling[k].z;
  }

  // Where the pairs of the next j cluster go.
  struct Places {
    FourCounts near, far;
    Index overflow[4];
  };
  template <class Lanes>
  GDESP_HD void put(Index c, const Lanes& lanes, const Found& found, Places& places) const {
    const unsigned near = found.near, all = found.all, far = all & ~near;
    lanes.for_each_bit(all, [&](int lane) {
      const int i = lane >> 2, jj = lane & 3;
      const bool touching = (near >> lane) & 1u;
      const Index place = touching ? places.near[i] + ones_below(near, i, jj) : places.far[i] + ones_below(far, i, jj);
      const Index slot = exec::cluster_size * c + i, other = exec::cluster_size * found.j + jj;
      const Index index = row_index(slot, places.overflow[i], place / 8);
      rows[index].neighbour[place % 8] = other;
      if (touching && kept_begin) copy_history(slot, other, index, place % 8);
    });
    places.near.add(near);
    places.far.add(far);
  }

  // Takes the rows behind the first of each grain; false when there is no room (the caller enlarges and repeats).
  template <class Lanes>
  GDESP_HD bool take_rows(Index c, const Lanes& lanes, const FourCounts& all, Index overflow[4]) const {
    Index extra[4], total = 0;
    for (int i = 0; i < 4; ++i) {
      extra[i] = all[i] > 8 ? (all[i] - 1) / 8 : 0;
      total += extra[i];
    }
    Index next = slots;
    if (total > 0) next += static_cast<Index>(lanes.allocate(overflow_used, static_cast<std::uint32_t>(total)));
    const bool fits = next + total <= slots + overflow_capacity;
    for (int i = 0; i < 4; ++i) {
      overflow[i] = extra[i] > 0 ? next : 0;
      next += extra[i];
    }
    lanes.for_each_i([&](int i) {
      const Index slot = exec::cluster_size * c + i;
      const std::uint16_t held = records[slot].mobility == 0.0f ? 1 : 0;
      range[slot] = fits ? RowRange{static_cast<std::uint16_t>(all[i]), held, overflow[i]} : RowRange{};
      if (!fits || all[i] == 0) return;
      for (Index k = 0; k <= extra[i]; ++k) clear(row_index(slot, overflow[i], k));
    });
    lanes.share_memory();
    return fits;
  }

  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    Places places;
#if defined(__CUDA_ARCH__)
    // Two walks through one piece of code (twice the code would be called, with registers put away): count, fill. Far
    // neighbours follow the near ones; until these are counted, places.near counts all.
#pragma unroll 1
    for (int walk = 0; walk < 2; ++walk) {
      const bool fills = walk == 1;
      for_each_near(c, lanes, [&](const Found& found) {
        if (fills) {
          put(c, lanes, found, places);
        } else {
          places.far.add(found.near);
          places.near.add(found.all);
        }
      });
      if (fills || !take_rows(c, lanes, places.near, places.overflow)) return;
      places.near = {};
    }
#else
    FourCounts near_count, all_count;
    // One walk into a buffer; a second walk when it does not hold all.
    constexpr Index buffer_size = 512;
    Found buffer[buffer_size];
    Index count = 0;
    for_each_near(c, lanes, [&](const Found& found) {
      if (count < buffer_size) buffer[count] = found;
      ++count;
      near_count.add(found.near);
      all_count.add(found.all);
    });
    if (!take_rows(c, lanes, all_count, places.overflow)) return;
    places.far = near_count;
    if (count <= buffer_size) {
      for (Index k = 0; k < count; ++k) put(c, lanes, buffer[k], places);
      return;
    }
    for_each_near(c, lanes, [&](const Found& found) { put(c, lanes, found, places); });
#endif
  }
};

}  // namespace

template <class Exec>
ContactRows<Exec>::ContactRows(const Exec& exec, bool rolling)
    : exec_(exec), rolling_on_(rolling), range_(exec), rows_(exec), rolling_(exec), overflow_used_(exec) {
  overflow_used_.resize_discard(1);
}

template <class Exec>
void ContactRows<Exec>::build(const ClusterSet<Exec>& set, const Index* source, const GrainRecord* records,
                              const FixedPosition* position, const ListReach& reach, bool first,
                              Array<GrainRecord, Exec>& room) {
  const Index slots = set.slots(), old_slots = first ? 0 : static_cast<Index>(range_.size());
  const CellGridView grid = set.view();
  const OldRows old{range_.data(), rows_.data(), rolling_on_ ? rolling_.data() : nullptr};
  // The room holds, by old slot, the number of the first contact kept; places and radii by cluster; the contacts kept.
  const std::size_t numbers = (static_cast<std::size_t>(old_slots) / 16 + 1) * 16;  // what follows begins at 64 bytes
  Index* begin = exec::room_for<Index>(room, 2 * numbers);
  const auto number_kept = [&] {
    Index* count = begin + numbers;  // where places will be
    exec::parallel_for(exec_, "dem::contact_rows", old_slots, CountKept{old, count});
    return exec::exclusive_scan(exec_, "dem::contact_rows", count, begin, old_slots);
  };
  const Index kept_count = number_kept();
  const std::size_t before = room.size(), places = 4 * static_cast<std::size_t>(slots);
  begin = exec::room_for<Index>(room, numbers + places + (rolling_on_ ? 7 : 4) * static_cast<std::size_t>(kept_count));
  if (room.size() != before) number_kept();  // it grew, and forgot
  float* search = reinterpret_cast<float*>(begin + numbers);
  KeptContact* kept = reinterpret_cast<KeptContact*>(search + places);
  Vec3f* kept_rolling = reinterpret_cast<Vec3f*>(kept + kept_count);
  exec::parallel_for(exec_, "dem::contact_rows", old_slots, KeepHistory{old, begin, kept, kept_rolling});
  exec::parallel_for(exec_, "dem::contact_rows", slots, PackSearch{grid, records, position, search});
  overflow_capacity_ = overflow_capacity_ > slots / 8 ? overflow_capacity_ : slots / 8 + 16;
  while (true) {
    const auto total = static_cast<std::size_t>(slots) + static_cast<std::size_t>(overflow_capacity_);
    range_.resize_discard(static_cast<std::size_t>(slots));
    rows_.resize_discard(total);
    if (rolling_on_) rolling_.resize_discard(total);
    overflow_used_.fill_bytes(0);
    exec::pair_pass(exec_, "dem::contact_rows", set.clusters(),
                    BuildRows{grid, search, records, source, reach, slots, first ? nullptr : begin, kept, kept_rolling,
                              range_.data(), rows_.data(), rolling_on_ ? rolling_.data() : nullptr,
                              overflow_used_.data(), overflow_capacity_});
    const Index used = static_cast<Index>(overflow_used_.read(0));
    if (used <= overflow_capacity_) break;
    overflow_capacity_ = used + used / 32;
  }
}

template class ContactRows<exec::CompiledBackend>;

}  // namespace gdesp::dem
