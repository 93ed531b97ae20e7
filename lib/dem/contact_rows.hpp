// SPDX-License-Identifier: GPL-3.0-or-later
// Who may touch whom: for each grain a full list of the grains nearer than radius_i + radius_j + skin, in rows of
// eight, with the history of each contact in the row. A contact stands in the rows of both grains.
#pragma once

#include "dem/grain_views.hpp"

namespace gdesp::dem {

/// What the force pass sees.
struct ContactRowsView {
  const RowRange* range;  ///< by slot
  ContactRow* rows;
  RollingRow* rolling;  ///< null without rolling resistance
};

/// How far to look, m. `drift`: no grain has moved farther since the set was sorted.
struct ListReach {
  float largest_radius = 0.0f, skin = 0.0f, drift = 0.0f;
};

template <class Exec>
class ContactRows {
 public:
  ContactRows() = default;
  ContactRows(const Exec& exec, bool rolling);

  /// Lists anew for records (slots + 1 of them, the last a dummy) and positions by slot, and takes over the history of
  /// contacts that go on. `source` says where each slot was when the old rows were made (null: where it is now);
  /// first: there were none. What is in `room` is lost.
  void build(const ClusterSet<Exec>& set, const Index* source, const GrainRecord* records,
             const FixedPosition* position, const ListReach& reach, bool first, Array<GrainRecord, Exec>& room);

  ContactRowsView view() { return {range_.data(), rows_.data(), rolling_on_ ? rolling_.data() : nullptr}; }
  Index row_count() const { return static_cast<Index>(rows_.size()); }

  const Array<RowRange, Exec>& ranges() const { return range_; }
  const Array<ContactRow, Exec>& rows() const { return rows_; }
  const Array<RollingRow, Exec>& rolling_rows() const { return rolling_; }
  Array<RowRange, Exec>& ranges() { return range_; }
  Array<ContactRow, Exec>& rows() { return rows_; }
  Array<RollingRow, Exec>& rolling_rows() { return rolling_; }

 private:
  Exec exec_{};
  bool rolling_on_ = false;
  Array<RowRange, Exec> range_;
  Array<ContactRow, Exec> rows_;
  Array<RollingRow, Exec> rolling_;
  Array<std::uint32_t, Exec> overflow_used_;
  Index overflow_capacity_ = 0;
};

}  // namespace gdesp::dem
