// SPDX-License-Identifier: GPL-3.0-or-later
// Good states in memory, and the way back to them.
#pragma once

#include <deque>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "guard.hpp"

namespace gdesp::tool {

/// A state that the guard had nothing against, whole.
struct GoodState {
  std::vector<char> bytes;
  Guard guard;
  std::int64_t step = 0;
  double time = 0.0;  ///< s
};

/// What a checkpoint keeps of the guard and the recovery, so that a resumed run judges as the unbroken one.
struct Watch {
  Guard guard;
  int tries = 0, recoveries = 0;
  double step_factor = 1.0;
  double clear_after = 0.0;  ///< s: past this time the trouble lies behind
};

/// Keeps the last two states that the guard had nothing against, whole, as a checkpoint holds them. After trouble a
/// simulation goes back to one of them and on with a smaller step (half, a quarter, an eighth) and, where the water
/// outran its sound, with a higher sound speed. When it has come through, the step grows again.
class Recovery {
 public:
  static constexpr int most_tries = 3;         ///< for one trouble
  static constexpr int most_recoveries = 12;   ///< in one run
  static constexpr double sound_factor = 1.5;  ///< each try

  static constexpr std::size_t most_states = 2;  ///< good, held at a time

  /// `memory`: bytes that the states may take; 0: none are kept.
  explicit Recovery(double memory) : memory_(memory) {}

  /// Lets the step grow again, once what went wrong lies behind.
  void relax(Simulation& simulation);
  /// The state now is good.
  void keep(Simulation& simulation, const Guard& guard);
  bool has_state() const { return !kept_.empty(); }
  bool may_try() const { return has_state() && tries_ < most_tries && recoveries_ < most_recoveries; }

  /// Back to a good state, with more caution; the record for log.ndjson.
  nlohmann::ordered_json go_back(Simulation& simulation, Guard& guard, const Trouble& trouble);
  /// Back to the newest good state as it was, for the files of a run that has failed.
  void restore_newest(Simulation& simulation);
  Watch watch(const Guard& guard) const { return {guard, tries_, recoveries_, step_factor_, clear_after_}; }
  const std::deque<GoodState>& good_states() const { return kept_; }
  void take_over(const Watch& watch, std::deque<GoodState> good);
  /// "3 tries from t = 0.2 s on, with steps down to 1/8 and a sound speed up to 67.5 m/s, ended alike"
  std::string tries_text(const Simulation& simulation) const;

 private:
  void load(const GoodState& kept, Simulation& simulation);

  double memory_;
  std::deque<GoodState> kept_;  ///< oldest first
  int tries_ = 0, recoveries_ = 0;
  double step_factor_ = 1.0;
  double clear_after_ = 0.0;  ///< s: past this time the trouble lies behind
};

}  // namespace gdesp::tool
