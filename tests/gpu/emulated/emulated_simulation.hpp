// SPDX-License-Identifier: GPL-3.0-or-later
// A simulation on the emulated device. What it is made of lies in a library of its own, hidden: inline functions of the
// solver have the same names there and another meaning.
#pragma once

#include <memory>

#include "device.hpp"
#include "simulation/simulation.hpp"

namespace gdesp::emulated {

std::unique_ptr<Simulation> make_simulation(const SimulationInput& input);

}  // namespace gdesp::emulated
