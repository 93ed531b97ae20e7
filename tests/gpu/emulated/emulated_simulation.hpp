// SPDX-License-Identifier: GPL-3.0-or-later
// A simulation on the emulated device. What it is made of lies in a library of its own, hidden: inline functions of the
// solver have the same names there and another meaning.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "simulation/simulation.hpp"

namespace gdesp::emulated {

std::unique_ptr<Simulation> make_simulation(const SimulationInput& input);

/// See Faults and live_allocations() in device.hpp.
void let_fail(long allocations, long waits);
std::size_t allocations();

/// Bodies of kernels that have run so far, and how often each was launched.
std::vector<std::pair<std::string, long>> launches();

}  // namespace gdesp::emulated
