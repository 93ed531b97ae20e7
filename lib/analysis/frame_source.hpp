// SPDX-License-Identifier: GPL-3.0-or-later
// Frames from wherever they come, one after the other: a run folder (finished or still growing), frame files of
// this or another program, or the records of a running solver on standard input. The next frame is read while the
// present one is measured; no more than two are in memory.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analysis/run_info.hpp"
#include "io/frame.hpp"

namespace gdesp::analysis {

struct SourceOptions {
  std::vector<std::string> inputs;  ///< one run folder; one or several frame files; or "-"
  std::vector<FieldMapping> mapping;
  double dp = 0.0;                    ///< m; for files that do not carry it
  int dimensions = 0;                 ///< 0: from the case, or from the data
  std::string case_path;              ///< overrides what the run says
  std::optional<double> still_water;  ///< m, scene coordinates; overrides the case
  double from = -std::numeric_limits<double>::infinity(), until = std::numeric_limits<double>::infinity();  ///< s
  int every = 1;                      ///< of the frames
  double frame_interval = 0.0;        ///< s, for several files without times
  bool grains = true, bodies = true;  ///< read these parts too
  /// The next record of the producer when the input is "-"; nullopt at its end. Called from a thread of its own.
  std::function<std::optional<nlohmann::ordered_json>()> next_record;
};

class FrameSource {
 public:
  /// Finds the case and the first frame. Throws Error(input) when there is none.
  explicit FrameSource(SourceOptions options);
  ~FrameSource();
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;

  const RunInfo& info() const { return info_; }
  /// The next frame in time order; nullopt at the end, or when `stop` says so while waiting.
  std::optional<Frame> next(const std::function<bool()>& stop = {});
  /// The producer ended with a "failed" record; its reason.
  bool failed() const;
  std::string failure() const;
  /// The producer's records ended without a "done", "interrupted" or "failed": it was killed.
  bool cut_short() const;
  /// Number of frames when it is known beforehand (folders and files), else 0.
  std::size_t expected() const;

 private:
  struct Reader;
  void read_ahead();

  SourceOptions options_;
  RunInfo info_;
  std::shared_ptr<Reader> reader_;
};

}  // namespace gdesp::analysis
