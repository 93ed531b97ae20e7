// SPDX-License-Identifier: GPL-3.0-or-later
// The complete state of the grains. Wall lists are not kept: they are functions of the positions when grains were listed,
// which are, so that the loaded system sums in the same order as the saved one.
#include <type_traits>

#include "core/error.hpp"
#include "dem/grain_system.hpp"
#include "exec/state_archive.hpp"

namespace gdesp::dem {
namespace {

// Rows in the order of slots: where the overflow rows lie depends on the threads.
struct SavedRows {
  std::vector<RowRange> range;
  std::vector<ContactRow> rows;
  std::vector<RollingRow> rolling;
};

SavedRows in_order(const std::vector<RowRange>& range, const std::vector<ContactRow>& rows,
                   const std::vector<RollingRow>& rolling) {
  SavedRows ordered;
  auto next = static_cast<Index>(range.size());
  ordered.range = range;
  ordered.rows.assign(rows.begin(), rows.begin() + next);
  if (!rolling.empty()) ordered.rolling.assign(rolling.begin(), rolling.begin() + next);
  for (std::size_t i = 0; i < range.size(); ++i) {
    if (range[i].count == 0) {
      ordered.rows[i] = ContactRow{};
      if (!rolling.empty()) ordered.rolling[i] = RollingRow{};
    }
    const Index extra = range[i].count > 8 ? (range[i].count - 1) / 8 : 0;
    ordered.range[i].overflow = extra > 0 ? next : 0;
    for (Index k = 0; k < extra; ++k, ++next) {
      const auto from = static_cast<std::size_t>(range[i].overflow + k);
      ordered.rows.push_back(rows[from]);
      if (!rolling.empty()) ordered.rolling.push_back(rolling[from]);
    }
  }
  return ordered;
}

}  // namespace

template <class Exec>
template <class Archive>
void GrainSystem<Exec>::archive(Archive& a) {
  constexpr bool saving = std::is_same_v<Archive, exec::StateWriter>;
  std::int32_t must_rebuild = must_rebuild_ ? 1 : 0;
  a.mark("grains");
  a(time_, half_before_, drift_, odometer_, skin_, moved2_, speed2_, overlap_, must_rebuild);
  a(substeps_, rebuilds_, listed_at_, slots_, lost_);
  must_rebuild_ = must_rebuild != 0;
  a(set_, position_, id_, group_, now_, velocity_, spin_, quiet_until_);
  SavedRows rows;
  std::vector<WallHistory> wall_history;
  if constexpr (saving) {
    rows = in_order(contacts_.ranges().to_host(), contacts_.rows().to_host(), contacts_.rolling_rows().to_host());
    wall_history = walls_.history().to_host();
  }
  a(rows.range, rows.rows, rows.rolling, wall_history);
  a(walls_.impulse_units(), listed_poses_, bodies_, release_time_, held_group_);
  if constexpr (!saving) {
    const bool rolling = contact_.rolling_friction > 0.0;
    if (position_.size() != static_cast<std::size_t>(slots_) || set_.slots() != slots_ ||
        rows.rolling.empty() == rolling)
      throw Error(ErrorKind::input, "checkpoint: the state of the grains is not one of this simulation");
    restore_lists(rows.range, rows.rows, rows.rolling, wall_history);
  }
}

template <class Exec>
void GrainSystem<Exec>::restore_lists(const std::vector<RowRange>& range, const std::vector<ContactRow>& rows,
                                      const std::vector<RollingRow>& rolling,
                                      const std::vector<WallHistory>& wall_history) {
  contacts_.ranges().assign(range);
  contacts_.rows().assign(rows);
  contacts_.rolling_rows().assign(rolling);
  if (!walls_.empty()) {
    walls_.history().assign(wall_history);
    // Asks every grain, as the lists were made from readings that are gone; the readings saved are then put back.
    const std::vector<float> quiet_until = quiet_until_.to_host();
    quiet_until_.fill_bytes(0);
    walls_.build(set_, position_, now_.data(), listed_poses_, wall_reach(), false, next_);
    quiet_until_.assign(quiet_until);
  }
  next_.assign(now_.to_host());
  set_fluid({});
  listed_ = true;
}

template void GrainSystem<exec::CompiledBackend>::archive(exec::StateWriter&);
template void GrainSystem<exec::CompiledBackend>::archive(exec::StateReader&);

}  // namespace gdesp::dem
