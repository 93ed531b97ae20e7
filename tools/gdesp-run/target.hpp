// SPDX-License-Identifier: GPL-3.0-or-later
// Targets instead of knobs: gdesp-run SCENE.toml --accuracy 5% --budget 10min. Coarse pilot runs (mesh2particles,
// gdesp-run and surge-analyze as programs of their own) tell how the run-up and the cost depend on dp; the dp that meets the
// targets is chosen and said, the case is built and run, and what was reached is compared with what was promised.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "options.hpp"
#include "scene/scene.hpp"

namespace gdesp::tool {

/// One run: dp (m), highest run-up over all regions (m), wall time of the run (s), processor time of all its threads (s), the share
/// of a step that wall particles take, as estimated when it started, and how the cost of a particle grows: with that power of
/// their number.
struct Pilot {
  double dp = 0.0, run_up = 0.0, seconds = 0.0, processor_seconds = 0.0, wall_share = 0.0, growth = 0.0;
};

/// Run-up against dp: a straight line through the pilots (first order), R = limit + slope dp; scatter: root mean square.
struct RunUpFit {
  double limit = 0.0, slope = 0.0, scatter = 0.0;
  /// Share of the limit that a run with dp is wrong by, scatter included.
  double error(double dp) const;
  /// m; the dp that has this error, 0 when none has.
  double dp_for(double error) const;
};
RunUpFit fit_run_up(const std::vector<Pilot>& pilots);

/// A run's cost over the pilot's: water and grains go with the power dimensions + 1 of the pilot's dp over dp (particles and
/// steps), walls, a layer some particles thick, with the power dimensions; both times what a particle costs more among more.
double cost_ratio(const Pilot& pilot, double dp, int dimensions);
/// s of wall time, from the finest pilot's.
double predicted_seconds(const std::vector<Pilot>& pilots, double dp, int dimensions);
/// m; the dp that takes so many s of wall time.
double dp_for_seconds(const std::vector<Pilot>& pilots, double seconds, int dimensions);

struct Targets {
  double accuracy = 0.0, budget = 0.0;
};  ///< share of the run-up; s; 0: none
/// "5%" or "0.05"; "10min", "2h", "90s", "90". Throws Error(usage).
double parse_accuracy(const std::string& text);
double parse_duration(const std::string& text);

/// What was chosen and why.
struct Choice {
  double dp = 0.0, seconds = 0.0, error = 0.0;
  bool accuracy_met = true;
  std::string reason;
  double processor_seconds = 0.0;
};
/// The coarsest dp that is accurate enough; else, or without an accuracy, the finest that the budget pays for. With a unit (m) it is
/// a whole part of that. Never coarser than the coarsest pilot.
Choice choose_dp(const std::vector<Pilot>& pilots, const Targets& targets, int dimensions, double unit = 0.0);

/// m: the largest length of which the inner lengths of tanks, periods and depths of the scene are multiples, as its dp has them; its
/// whole parts are the spacings that fit the walls. 0 where there is none: no tank, or its dp does not fit either.
double common_length(const Scene& scene);
/// m: the largest dp whose grains, which keep their ratio to dp, fit the periods of the scene: six diameters (dem::check_reach) at
/// least. Infinity without grains or periods.
double coarsest_dp(const Scene& scene);
/// m: the next whole part of unit that is at most, or at least, dp; dp itself where unit is less than two of it.
double finer_part(double unit, double dp);
double coarser_part(double unit, double dp);

/// Pilots, choice, case and run of options.case_path, a scene. Returns the exit code.
int run_to_target(const RunOptions& options);

}  // namespace gdesp::tool
