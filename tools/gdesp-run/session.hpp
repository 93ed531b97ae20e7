// SPDX-License-Identifier: GPL-3.0-or-later
// A case made ready to run: read, checked, mapped, on its device.
#pragma once

#include <memory>

#include "io/frame.hpp"
#include "options.hpp"
#include "output_times.hpp"
#include "scene_summary.hpp"
#include "simulation/simulation.hpp"

namespace gdesp::tool {

struct Session {
  RunOptions options;
  Case scene_case;        ///< scene, walls, bodies; its particles have gone into the simulation
  SimulationInput input;  ///< particles and all, until start()
  SceneSummary summary;
  OutputTimes times;
  std::string device;       ///< cpu or cuda:N
  std::string device_name;  ///< for people
  int threads = 1;
  std::uint64_t fingerprint = 0;  ///< of the case and its parameters, not of the end and the output
  std::unique_ptr<Simulation> simulation;
};

/// Reads the case and maps it; takes no device memory yet. Throws Error(input), Error(resource).
Session prepare(RunOptions options);

/// Builds the simulation and frees the input tables.
void start(Session& session);

/// The state now, as a frame.
Frame frame_of(Session& session);

}  // namespace gdesp::tool
