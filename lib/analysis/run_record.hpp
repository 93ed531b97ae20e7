// SPDX-License-Identifier: GPL-3.0-or-later
// What a run says about itself: run.json and log.ndjson of its folder.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace gdesp::analysis {

struct RunRecord {
  std::string command, device, device_name, version, commit, status;
  int threads = 0;
  double wall_seconds = 0.0, simulated = 0.0, score = 0.0;                          ///< s, s, the paper's N = n t / T
  nlohmann::ordered_json json;                                                      ///< all of it
  double cost() const { return simulated > 0.0 ? wall_seconds / simulated : 0.0; }  ///< wall s per simulated s
};

/// nullopt without a run.json; throws Error(input) when it is no JSON object.
std::optional<RunRecord> read_run_record(const std::string& run_folder);

/// The log's numbers, by name: one value per line, NaN where a line lacks it; of a vector its magnitude. Empty without a log. A last line cut
/// short by a running solver is left out.
struct RunLog {
  std::vector<std::string> name;
  std::vector<std::vector<double>> value;
  const std::vector<double>* find(const std::string& wanted) const;
};
RunLog read_run_log(const std::string& run_folder);

}  // namespace gdesp::analysis
