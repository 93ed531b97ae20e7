// SPDX-License-Identifier: GPL-3.0-or-later
// `surge-analyze report`: everything that a run has to say, on one page.
#pragma once

#include <string>
#include <vector>

#include "analysis/frame_source.hpp"

namespace gdesp::analysis {

struct ReportOptions {
  std::vector<std::string> coarser;   ///< runs of the same scene at other resolutions: error bars by GCI
  std::vector<std::string> pictures;  ///< PNGs to put in front
  double map_cell = 0.0;              ///< m; 0: dp, or what keeps the map below a million cells
};

/// Reads every frame once and writes the page aside, then renames it. What the run lacks (gauges, grains, a case, a
/// log) is left out, and said where it matters. `progress` as in run_measurements. Returns the warnings on the page.
std::vector<std::string> write_report(FrameSource& source, const SourceOptions& options, const ReportOptions& report,
                                      const std::string& path,
                                      const std::function<void(double, double)>& progress = {});

}  // namespace gdesp::analysis
