// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"

namespace gdesp::tool {

const std::vector<Command>& commands() {
  static const std::vector<Command> all{
      {"runup", "climb height above still water against time, per bank; its maximum along the shore", run_runup},
      {"front", "leading edge of water and solids against time, also as x*, t*", run_front},
      {"profile", "surface of water and slide along a line at given times", run_profile},
      {"gauge", "water level and pressure at points against time; arrival times", run_gauge},
      {"slide", "centre, velocity, front and submerged share of the slide", run_slide},
      {"energy", "energy budget by phase and kind", run_energy},
      {"surface", "free surface as triangles (VTP) and level set (VDB)", run_surface},
      {"map", "highest level, depth, arrival as GeoTIFF or ESRI ASCII; run-up line as GeoJSON", run_map},
      {"compare", "differences from a reference table: RMS, bias, largest, inside its band", run_compare},
      {"converge", "several resolutions: observed order, extrapolated value, error bar", run_converge},
      {"tradeoff", "several runs: error against cost, with the Pareto front", run_tradeoff},
      {"plot", "curves of several tables in one figure, with measurements", run_plot},
      {"report", "one HTML page with the plots and tables of a run", run_report},
      {"render", "one picture in three dimensions: terrain, water by speed, slide", run_render},
  };
  return all;
}

}  // namespace gdesp::tool
