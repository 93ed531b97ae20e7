// SPDX-License-Identifier: GPL-3.0-or-later
// What lies in a run folder besides frames and checkpoints: log.ndjson (diagnostics) and run.json (what was run, on
// what, how it ended). docs/formats/run.md describes both.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "simulation/simulation.hpp"

namespace gdesp::tool {

/// One line of log.ndjson.
nlohmann::ordered_json diagnostics_record(const Diagnostics& d);

/// Appends whole lines to log.ndjson.
class DiagnosticsLog {
 public:
  /// A new log; or, from `last_step` >= 0 on, one that goes on: later and torn lines are dropped, and all that follow a
  /// recovery beyond the first `recoveries` of them (it has not happened yet).
  DiagnosticsLog(const std::string& run_folder, std::int64_t last_step, int recoveries = 0);
  ~DiagnosticsLog();
  DiagnosticsLog(const DiagnosticsLog&) = delete;
  DiagnosticsLog& operator=(const DiagnosticsLog&) = delete;
  void add(const Diagnostics& d);
  /// Drops what is later than `step` and adds the record of the recovery that made the run go back there (its member
  /// "recovery" counts them from 1).
  void go_back(std::int64_t step, const nlohmann::ordered_json& record);
  /// Everything added so far is with the operating system.
  std::int64_t last_step() const { return last_step_; }

 private:
  void open_at_end();
  void put(const std::string& line);
  std::string path_;
  int descriptor_ = -1;
  std::int64_t last_step_ = -1;
};

/// Writes run.json (aside, then renamed).
void write_run_json(const std::string& run_folder, const nlohmann::ordered_json& content);
/// Reads run.json; null when there is none or it is not JSON.
nlohmann::ordered_json read_run_json(const std::string& run_folder);

/// Removes what an earlier run left besides its frames (`resume` false), and half-written files in any case.
void tidy_run_folder(const std::string& run_folder, bool resume);

/// Now, as 2024-05-17T08:30:00Z.
std::string utc_now();

}  // namespace gdesp::tool
