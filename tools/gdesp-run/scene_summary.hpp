// SPDX-License-Identifier: GPL-3.0-or-later
// What is about to run, in words and numbers: models on and off with the reason, counts, limits of the time step,
// memory. People read the lines, run.json keeps the rest.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "case_to_input.hpp"

namespace gdesp::tool {

struct SceneSummary {
  std::vector<std::string> lines;
  nlohmann::ordered_json json;
  std::size_t moving_particles = 0;  ///< water and grains: the n of the score N = n t / T
  double time_step = 0.0;            ///< s, estimated for water at the expected speed
  double memory = 0.0;               ///< bytes, estimated
  double wall_seconds = 0.0;         ///< estimated from step costs (scene_economy.hpp)
};

/// `device` as resolve_device gives it; `expected` belongs to the case that `input` came from.
SceneSummary summarize(const Scene& scene, const SimulationInput& input, const ExpectedSpeed& expected,
                       const std::string& device, int threads);

/// Free memory of the device, bytes: of the machine or its control group (cpu), of the card (cuda:N).
double available_memory(const std::string& device);

/// Throws Error(resource) with the memory needed, what the device has free (bytes), and the dp that would fit.
void check_memory(const SceneSummary& summary, const Scene& scene, const std::string& device, double free);

/// 1536 -> "1.5 KiB"
std::string memory_text(double bytes);
/// Up to `digits` significant digits, no trailing zeros.
std::string number_text(double value, int digits = 4);
/// Overlaps of grains, of a diameter, that a contact is stiff enough for.
inline constexpr double overlap_at_rest = 0.01, overlap_on_impact = 0.05;
/// 93784 s -> "26 h 3 min"
std::string duration_text(double seconds);

}  // namespace gdesp::tool
