// SPDX-License-Identifier: GPL-3.0-or-later
// What an analysis knows about a run besides its frames: the case it belongs to, or what the user said instead.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/run_up.hpp"
#include "particles/particle_tables.hpp"
#include "scene/scene.hpp"

namespace gdesp::analysis {

struct RunInfo {
  std::string name;       ///< for titles and legends: the run folder's or file's name
  std::string run_path;   ///< run folder; empty for single files
  std::string case_path;  ///< empty: no case known
  bool has_case = false;
  Scene scene;   ///< defaults where there is no case
  Vec3d offset;  ///< m; scene coordinates = case coordinates + offset
  Box domain;    ///< m, case coordinates
  int dimensions = 3;
  double dp = 0.0;                          ///< m
  std::optional<double> still_water_level;  ///< m, case coordinates
  TriangleTable walls;                      ///< case coordinates; empty without a case
  Vec3d fluid_lower, fluid_upper;  ///< m, bounds of the fluid's particles at the start (first frame without a case)
  std::size_t fluid_count = 0;
  LongAxis lake;                      ///< of the fluid at the start, case coordinates
  std::optional<Vec3d> slide_centre;  ///< m, of the grains (or rigid bodies) at the start
  double fluid_density() const { return scene.fluid.density; }
  double gravity() const { return -scene.gravity.z; }
};

/// Where the regions, sections and gauges of the scene lie in case coordinates.
std::vector<BankRegion> bank_regions(const RunInfo& info);
std::vector<Section> sections_in_case(const RunInfo& info);
/// The scene's section of that name, case coordinates; throws Error(usage) that lists the sections there are.
Section find_section(const RunInfo& info, const std::string& name);

/// Reads the case folder; keeps what an analysis needs and drops the rest. Throws Error(input).
RunInfo read_run_info(const std::string& case_path);
/// Completes an info without a case from the first frame's fluid.
void complete_from_fluid(RunInfo& info, const FluidTable& fluid);

}  // namespace gdesp::analysis
