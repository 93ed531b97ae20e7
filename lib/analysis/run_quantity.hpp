// SPDX-License-Identifier: GPL-3.0-or-later
// One number of a whole run, for convergence studies and the chart of error against cost.
#pragma once

#include <string>

#include "analysis/frame_source.hpp"

namespace gdesp::analysis {

struct RunQuantity {
  double value = 0.0;
  std::string unit;
  double dp = 0.0;  ///< m
  std::size_t particles = 0;
  std::string preset;  ///< of the case; empty without one
};

/// `quantity`: "runup" or "runup:REGION" (highest run-up, m), "front" or "front:DIR" (leading edge of the water in the last frame, m
/// from the start), "arrival:GAUGE" (s), "level:GAUGE" (highest level, m). Throws Error(usage) with what is valid.
RunQuantity measure_quantity(const SourceOptions& source, const std::string& quantity);

/// For --help.
inline const char* quantity_help() { return "runup, runup:REGION, front, front:DIR, arrival:GAUGE or level:GAUGE"; }

}  // namespace gdesp::analysis
