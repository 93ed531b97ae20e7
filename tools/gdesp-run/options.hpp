// SPDX-License-Identifier: GPL-3.0-or-later
// The command line of gdesp-run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/cli.hpp"

namespace gdesp::tool {

/// The guard looks at the whole state so often; the log has a line at least as often.
inline constexpr int steps_between_diagnostics = 100;

struct RunOptions {
  std::string case_path;   ///< folder; "-": the next case record on standard input
  std::string run_folder;  ///< absolute; empty until the case is known
  std::string device = "auto";
  int threads = 0;                        ///< 0: OMP_NUM_THREADS, else all cores
  std::optional<double> t_end;            ///< s; default: the scene's
  std::optional<double> output_interval;  ///< s; set when a run goes on: that of its start
  std::vector<Override> overrides;        ///< --preset and --set, in this order
  double accuracy = 0.0, budget = 0.0;    ///< targets (target.hpp): share of the run-up, s of wall time; 0: none
  double checkpoint_every = 0.0;          ///< s of wall time; 0: only when interrupted
  int log_every = 0;                      ///< steps between lines of the log; 0: not said
  bool resume = false, explain = false, profile = false, force = false;
  std::vector<std::string> arguments;  ///< as typed
};

/// Parses and checks. nullopt when --help or --version has been answered. Throws Error(usage).
std::optional<RunOptions> parse_options(const std::vector<std::string>& arguments);

/// The case to run: the option itself, the path of the first case record on standard input (records before it go
/// to standard output unharmed), or the case of the run folder that is resumed. Fills case_path and run_folder, both
/// absolute. With --resume, what the interrupted run was told and this one is not (end, --set) is taken over.
void resolve_paths(RunOptions& options);

}  // namespace gdesp::tool
