// SPDX-License-Identifier: GPL-3.0-or-later
// What running a case would take on this machine's processor: the same estimate for gdesp-run and mesh2particles --explain.
#pragma once

#include "scene_summary.hpp"

namespace gdesp::tool {

/// Models, limits of the step, memory, cost and economies with all threads. Measures for about 0.1 s what a step costs. The
/// particle tables are moved out of `c`. Throws Error(input) for an option the solver does not have.
SceneSummary estimate_here(Case& c);

}  // namespace gdesp::tool
