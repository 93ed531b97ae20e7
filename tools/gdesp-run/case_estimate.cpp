// SPDX-License-Identifier: GPL-3.0-or-later
#include "case_estimate.hpp"

#include "exec/backend.hpp"
#include "scene_economy.hpp"

namespace gdesp::tool {

SceneSummary estimate_here(Case& c) {
  const int threads = exec::set_threads(0);
  const ExpectedSpeed expected = expected_speed(c);
  const SimulationInput input = case_to_input(c);
  SceneSummary summary = summarize(c.scene, input, expected, "cpu", threads);
  describe_economies(summary, c.scene, input, expected, measure_step_costs(input, "cpu"));
  return summary;
}

}  // namespace gdesp::tool
