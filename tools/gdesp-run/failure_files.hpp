// SPDX-License-Identifier: GPL-3.0-or-later
// RUN/failure: what a run that could not go on leaves for people to look at.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "io/frame.hpp"

namespace gdesp::tool {

/// Writes NAME_fluid.vtp and NAME_grains.vtp into RUN/failure. Particles with a value that is not finite are left out: no file
/// holds one. Returns what was written: paths, counts, and the ids left out (the first hundred). Throws Error(resource).
nlohmann::ordered_json write_failure_state(const std::string& run_folder, const std::string& name, Frame frame);

/// Writes failure.json beside them.
void write_failure_report(const std::string& run_folder, const nlohmann::ordered_json& report);

}  // namespace gdesp::tool
