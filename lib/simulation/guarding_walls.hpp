// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "simulation/simulation_input.hpp"

namespace gdesp {

/// The walls as the guard of the water sees them: particles of bodies that move under the water's load have no say there (no
/// normal), for what the guard does is not given back to a body.
BoundaryTable guarding_walls(const SimulationInput& input);

}  // namespace gdesp
