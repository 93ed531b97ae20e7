// SPDX-License-Identifier: GPL-3.0-or-later
#include "emulated_simulation.hpp"

#include "device.hpp"
#include "exec/backend.hpp"

namespace gdesp {

template <class Exec>
std::unique_ptr<Simulation> make_simulation_on(const Exec& exec, const SimulationInput& input);

namespace emulated {

#pragma GCC visibility push(default)

std::unique_ptr<Simulation> make_simulation(const SimulationInput& input) {
  return make_simulation_on(exec::take_cuda_device(0), input);
}

void let_fail(long allocations, long waits) { set_faults({allocations, waits}); }

std::size_t allocations() { return live_allocations(); }

std::vector<std::pair<std::string, long>> launches() { return work_done(); }

#pragma GCC visibility pop

}  // namespace emulated
}  // namespace gdesp
