// SPDX-License-Identifier: GPL-3.0-or-later
// Short scenes that between them take every pass of the solver.
#pragma once

#include <string>
#include <vector>

#include "simulation/simulation_input.hpp"

namespace gdesp::parity {

struct Scene {
  std::string name;
  SimulationInput input;
  int steps = 0;
  float smallest_diameter = 0.0f;  ///< m, of the grains
};

/// `small`: a few hundred particles each, for compute-sanitizer.
std::vector<Scene> scenes(bool small);

}  // namespace gdesp::parity
