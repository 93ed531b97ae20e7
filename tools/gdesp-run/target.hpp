// SPDX-License-Identifier: GPL-3.0-or-later
// Targets instead of knobs: gdesp-run SCENE.toml --accuracy 5% --budget 10min. Coarse pilot runs (mesh2particles,
// gdesp-run and surge-analyze as programs of their own) tell how the run-up and the cost depend on dp; the dp that meets the
// targets is chosen and said, the case is built and run, and what was reached is compared with what was promised.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "options.hpp"

namespace gdesp::tool {

/// One run: dp (m), highest run-up over all regions (m), wall time of the run (s), processor time of all its threads (s).
struct Pilot {
  double dp = 0.0, run_up = 0.0, seconds = 0.0, processor_seconds = 0.0;
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

/// s: the finest pilot's wall time, scaled by the power dimensions + 1 of its dp over dp (particles and steps).
double predicted_seconds(const std::vector<Pilot>& pilots, double dp, int dimensions);

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
};
/// The coarsest dp that is accurate enough; else, or without an accuracy, the finest that the budget pays for.
Choice choose_dp(const std::vector<Pilot>& pilots, const Targets& targets, int dimensions);

/// Pilots, choice, case and run of options.case_path, a scene. Returns the exit code.
int run_to_target(const RunOptions& options);

}  // namespace gdesp::tool
