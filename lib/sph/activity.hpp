// SPDX-License-Identifier: GPL-3.0-or-later
// Still water sleeps. The domain is cut into blocks eight particle spacings wide. A block is disturbed when the water in
// it moves as a whole, when one particle in it flies, when a wall in it moves, or when there is a grain in it; it is awake while it, or a
// block within `halo` of it, was disturbed not longer than `rest_time` ago. The particles of sleeping blocks keep place,
// density and pressure, and stand still: awake water feels them as neighbours. Work follows the list of awake clusters.
// Thresholds, the error they make and what they save: docs/economy.md.
#pragma once

#include "exec/parallel.hpp"
#include "exec/permute.hpp"
#include "neighbors/cluster_set.hpp"
#include "sph/activity_blocks.hpp"
#include "sph/activity_parameters.hpp"

namespace gdesp::sph {

/// Things that wake the water around them: grains (always, water between grains does not sleep) or wall particles (when
/// they move), by slot.
struct Movers {
  const FixedPosition* position = nullptr;
  const Vec3f* velocity = nullptr;  ///< m/s
  const std::uint32_t* id = nullptr;
  Index count = 0;
  bool always = false;  ///< even at rest
};

/// Clusters chosen from a set, in their order.
template <class Exec>
class ClusterSelection {
 public:
  ClusterSelection() = default;
  explicit ClusterSelection(const Exec& exec) : exec_(exec), flag_(exec), place_(exec), list_(exec) {}

  /// Those with a particle in a block whose mark is not 0; without marks all.
  void choose(const BlockGrid& grid, const Index* mark, const FixedPosition* position, const std::uint32_t* id,
              Index clusters);
  const Index* list() const { return list_.data(); }
  const Index* flag() const { return flag_.data(); }  ///< per cluster
  Index count() const { return count_; }

  template <class Archive>
  void archive(Archive& a) {
    a(count_, flag_, list_);
  }

 private:
  Exec exec_{};
  Index count_ = 0;
  Array<Index, Exec> flag_, place_, list_;
};

template <class Exec>
class Activity {
 public:
  Activity() = default;
  /// `dp` (m), `gravity` (m/s2, magnitude): scales of the thresholds.
  Activity(const Exec& exec, const Domain& domain, const ActivityParameters& parameters, double dp, double gravity);

  /// Until then all blocks with water in them are awake.
  void set_sleeping();

  /// Tells what moves at time t (s), part by part, then decides. At the start, when nothing moves yet, accelerations
  /// (m/s2) are judged as well: begin(), add_accelerations(), judge(t, true).
  void begin();
  void add_water(const FixedPosition* position, const Vec3f* velocity, const std::uint32_t* id, Index count);
  void add_accelerations(const FixedPosition* position, const Vec3f* acceleration, const std::uint32_t* id,
                         Index count);
  void add_movers(const Movers& movers);
  void judge(double t, bool accelerations);
  void decide(double t);

  const BlockGrid& grid() const { return grid_; }
  const Index* awake() const { return awake_.data(); }  ///< per block
  const Index* near() const { return near_.data(); }    ///< per block: awake or beside an awake one

  template <class Archive>
  void archive(Archive& a) {
    a(sleeps_, disturbed_at_, awake_, near_);
  }

 private:
  double speed_scale() const;  // m/s, sqrt(g dp)

  Exec exec_{};
  ActivityParameters parameters_;
  double dp_ = 0.0, gravity_ = 0.0;
  bool sleeps_ = false;
  BlockGrid grid_;
  Array<std::int64_t, Exec> sums_;    ///< block_rows per block
  Array<double, Exec> disturbed_at_;  ///< s
  Array<Index, Exec> awake_, near_;
};

/// body(index[k]): a loop over chosen clusters; null: over all.
template <class Body>
struct ChosenClusters {
  const Index* index;
  Body body;
  template <class Lanes>
  GDESP_HD void operator()(Index k, const Lanes& lanes) const {
    body(index ? index[k] : k, lanes);
  }
};

/// The same for the slots of chosen clusters.
template <class Body>
struct ChosenSlots {
  const Index* index;
  Body body;
  GDESP_HD Index slot(Index k) const {
    return index ? exec::cluster_size * index[k / exec::cluster_size] + k % exec::cluster_size : k;
  }
  GDESP_HD auto operator()(Index k) const { return body(slot(k)); }
};

template <class Body>
ChosenClusters<Body> chosen_clusters(const Index* index, const Body& body) {
  return {index, body};
}
template <class Body>
ChosenSlots<Body> chosen_slots(const Index* index, const Body& body) {
  return {index, body};
}

}  // namespace gdesp::sph
