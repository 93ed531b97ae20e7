// SPDX-License-Identifier: GPL-3.0-or-later
// The [case] table of case.toml: what the scene alone does not say.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/case.hpp"

namespace gdesp {

inline constexpr int case_format = 1;

struct CaseCounts {
  std::uint64_t fluid = 0, boundary = 0, grains = 0, wall_vertices = 0, wall_triangles = 0, bodies = 0;
};
CaseCounts counts_of(const Case& c);

/// The table as TOML text; `files` are the names of everything else in the folder.
std::string case_table(const Case& c, const std::vector<std::string>& files);

/// Fills everything but scene and particles from the [case] table of the file; returns the counts it states.
CaseCounts read_case_table(const std::string& path, Case& c);

}  // namespace gdesp
