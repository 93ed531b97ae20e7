// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem/contact_rows.hpp"

namespace gdesp::dem {
namespace {

constexpr int buffer_size = 40;

// Candidates of one grain: those about to touch first, so that later rows are mostly idle.
struct Candidates {
  Index near[buffer_size], far[buffer_size];
  Index near_count = 0, far_count = 0;

  GDESP_HD void add(Index j, bool touching) {
    if (touching) {
      if (near_count < buffer_size) near[near_count] = j;
      ++near_count;
    } else {
      if (far_count < buffer_size) far[far_count] = j;
      ++far_count;
    }
  }
  GDESP_HD bool overflowed() const { return near_count > buffer_size || far_count > buffer_size; }
  GDESP_HD Index count() const { return near_count + far_count; }
};

struct BuildRows {
  CellGridView grid;
  PositionUnit unit;
  const GrainRecord* records;
  const FixedPosition* position;
  const Index* source;
  ListReach reach;
  Index slots;
  bool first;
  const RowRange* old_range;
  const ContactRow* old_rows;
  const RollingRow* old_rolling;
  RowRange* range;
  ContactRow* rows;
  RollingRow* rolling;
  std::uint32_t* overflow_used;
  Index overflow_capacity;

  // visit(j, touching) for each grain j within the skin of grain i.
  template <class Visit>
  GDESP_HD void for_each_near(Index i, const Visit& visit) const {
    const GrainRecord& own = records[i];
    const float cutoff = own.radius + reach.largest_radius + reach.skin + reach.drift;
    const Vec3<std::int32_t> tile = grid.cluster_tile[i / exec::cluster_size];
    const Vec3f place = grid.domain.relative_to_tile(position[i], tile);
    for_each_candidate(grid, tile, place, place, cutoff,
                       [&](Index first_cluster, Index last_cluster, const Vec3<std::int32_t>& offset) {
      const Index end = (last_cluster + 1) * exec::cluster_size;
      for (Index j = first_cluster * exec::cluster_size; j < end; ++j) {
        const GrainRecord& other = records[j];
        const Vec3f r = separation(unit, own, other);
        const float limit = own.radius + other.radius + reach.skin;
        const float r2 = dot(r, r);
        if (limit > 0.0f && r2 < limit * limit && j != i && nearest_image(i, j, offset)) {
          const float touch = own.radius + other.radius + 0.1f * reach.skin;
          visit(j, r2 < touch * touch);
        }
      }
    });
  }
  // One block along a periodic axis shows the same grain in several images: only the nearest counts.
  GDESP_HD bool nearest_image(Index i, Index j, const Vec3<std::int32_t>& offset) const {
    const Vec3<std::int32_t> tile_i = grid.cluster_tile[i / exec::cluster_size];
    const Vec3<std::int32_t> tile_j = grid.cluster_tile[j / exec::cluster_size];
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t tiles = static_cast<std::int64_t>(tile_i[axis]) + offset[axis] - tile_j[axis];
      const std::int64_t apart = position[i][axis] - position[j][axis];
      const std::int64_t image = apart - tiles * (std::int64_t{1} << Domain::fraction_bits);
      if (image != static_cast<std::int32_t>(apart)) return false;
    }
    return true;
  }

  GDESP_HD void copy_history(Index i, Index j, ContactRow& row, RollingRow* roll, int lane) const {
    const Index old_i = source ? source[i] : i, old_j = source ? source[j] : j;
    const RowRange old = old_range[old_i];
    for (Index k = 0; k * 8 < old.count; ++k) {
      const Index index = k == 0 ? old_i : old.overflow + k - 1;
      const ContactRow& from = old_rows[index];
      for (int l = 0; l < 8; ++l) {
        if (from.neighbour[l] != old_j) continue;
        row.fx[lane] = from.fx[l];
        row.fy[lane] = from.fy[l];
        row.fz[lane] = from.fz[l];
        if (!roll) return;
        roll->mx[lane] = old_rolling[index].mx[l];
        roll->my[lane] = old_rolling[index].my[l];
        roll->mz[lane] = old_rolling[index].mz[l];
        return;
      }
    }
  }
  GDESP_HD void put(Index i, Index place, Index overflow, Index j, bool touching) const {
    const Index k = place / 8;
    const Index index = k == 0 ? i : overflow + k - 1;
    rows[index].neighbour[place % 8] = j;
    if (touching && !first) copy_history(i, j, rows[index], rolling ? rolling + index : nullptr, place % 8);
  }
  GDESP_HD void clear(Index index) const {
    ContactRow& row = rows[index];
    for (int l = 0; l < 8; ++l) {
      row.neighbour[l] = slots;
      row.fx[l] = row.fy[l] = row.fz[l] = 0.0f;
    }
    if (!rolling) return;
    RollingRow& roll = rolling[index];
    for (int l = 0; l < 8; ++l) roll.mx[l] = roll.my[l] = roll.mz[l] = 0.0f;
  }

  GDESP_HD void operator()(Index i) const {
    range[i] = RowRange{};
    if (records[i].radius < 0.0f) return;
    Candidates found;
    for_each_near(i, [&](Index j, bool touching) { found.add(j, touching); });
    const Index extra = found.count() > 8 ? (found.count() - 1) / 8 : 0;
    Index overflow = 0;
    if (extra > 0) {
      const Index used = static_cast<Index>(exec::add_to_counter(overflow_used, static_cast<std::uint32_t>(extra)));
      if (used + extra > overflow_capacity) return;  // the caller sees the count, enlarges and repeats
      overflow = slots + used;
    }
    range[i] = {found.count(), overflow};
    clear(i);
    for (Index k = 0; k < extra; ++k) clear(overflow + k);
    if (!found.overflowed()) {
      for (Index k = 0; k < found.near_count; ++k) put(i, k, overflow, found.near[k], true);
      for (Index k = 0; k < found.far_count; ++k) put(i, found.near_count + k, overflow, found.far[k], false);
      return;
    }
    Index near_place = 0, far_place = found.near_count;
    for_each_near(i, [&](Index j, bool touching) { put(i, touching ? near_place++ : far_place++, overflow, j, touching); });
  }
};

}  // namespace

template <class Exec>
ContactRows<Exec>::ContactRows(const Exec& exec, bool rolling)
    : exec_(exec), rolling_on_(rolling), range_(exec), old_range_(exec), rows_(exec), old_rows_(exec), rolling_(exec),
      old_rolling_(exec), overflow_used_(exec) {
  overflow_used_.resize_discard(1);
}

template <class Exec>
void ContactRows<Exec>::build(const ClusterSet<Exec>& set, const Index* source, const GrainRecord* records,
                              const FixedPosition* position, const ListReach& reach, bool first) {
  range_.swap(old_range_);
  rows_.swap(old_rows_);
  rolling_.swap(old_rolling_);
  const Index slots = set.slots();
  const CellGridView grid = set.view();
  overflow_capacity_ = overflow_capacity_ > slots / 4 ? overflow_capacity_ : slots / 4 + 16;
  while (true) {
    const auto total = static_cast<std::size_t>(slots) + static_cast<std::size_t>(overflow_capacity_);
    range_.resize_discard(static_cast<std::size_t>(slots));
    rows_.resize_discard(total);
    if (rolling_on_) rolling_.resize_discard(total);
    overflow_used_.fill_bytes(0);
    exec::parallel_for(exec_, "dem::contact_rows", slots,
                       BuildRows{grid, position_unit(grid.domain), records, position, source, reach, slots,
                                 first, old_range_.data(), old_rows_.data(), old_rolling_.data(), range_.data(),
                                 rows_.data(), rolling_on_ ? rolling_.data() : nullptr, overflow_used_.data(),
                                 overflow_capacity_});
    const Index used = static_cast<Index>(overflow_used_.read(0));
    if (used <= overflow_capacity_) break;
    overflow_capacity_ = used + used / 8;
  }
}

template class ContactRows<exec::CompiledBackend>;

}  // namespace gdesp::dem
