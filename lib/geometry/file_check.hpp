// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh or raster file judged by itself: usable, repairable (and how), refused (and why).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "geometry/mesh_check.hpp"

namespace gdesp::geometry {

struct FileReport {
  std::string path;
  MeshVerdict verdict = MeshVerdict::usable;
  std::string kind;                                     ///< "solid", "sheet", "raster", "points", "" when refused
  std::vector<std::pair<std::string, double>> numbers;  ///< counts, bounds (m), volume
  std::vector<std::string> found;                       ///< what is wrong or odd
  std::vector<std::string> repair;                      ///< what repair does
  std::string refusal;                                  ///< why, and where
};

/// Never throws for a bad file: the report says so.
FileReport check_file(const std::string& path);
const char* verdict_name(MeshVerdict verdict);
/// A few lines for people.
std::string describe(const FileReport& report);

}  // namespace gdesp::geometry
