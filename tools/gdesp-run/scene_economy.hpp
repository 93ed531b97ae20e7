// SPDX-License-Identifier: GPL-3.0-or-later
// Model no more than a scene needs: what a step is made of, what is left out and what else could be, with what each
// saves. Errors and savings as measured: docs/economy.md.
#pragma once

#include "calibration.hpp"
#include "scene_summary.hpp"

namespace gdesp::tool {

/// Adds to the summary: the cost of a step by part, the wall time expected, and the economies, in use or proposed.
void describe_economies(SceneSummary& summary, const Scene& scene, const SimulationInput& input,
                        const ExpectedSpeed& expected, const StepCosts& costs);

/// Share (0..1) of water particle steps within reach of a wave that leaves slides and bodies at the start and runs at
/// sqrt(g H); 1 where nothing is known to disturb the water from a place of its own.
struct WaveReach {
  double particles = 1.0, steps = 1.0;
};
WaveReach wave_reach(const SimulationInput& input, double end);

/// Wall particles within a support of water at the start.
std::size_t walls_beside_water(const SimulationInput& input);

/// Overlaps over diameter of the largest grain: under the slide's weight, and in impacts at a third of the expected speed
/// (Hertz; a linear spring); and the stiffness (Pa or N/m) that makes them 1 % and 5 %, whichever needs more.
struct ContactSoftness {
  double at_rest = 0.0, on_impact = 0.0, stiffness = 0.0;
};
ContactSoftness contact_softness(const SimulationInput& input, double expected_speed);

/// "dimensions", "periodic" or "half" where boxes and tanks alone make the scene and leave y out, or mirror it; else "".
std::string needless_width(const Scene& scene);

}  // namespace gdesp::tool
