// SPDX-License-Identifier: GPL-3.0-or-later
#include "emulated_simulation.hpp"

#include "exec/backend.hpp"

namespace gdesp {

template <class Exec>
std::unique_ptr<Simulation> make_simulation_on(const Exec& exec, const SimulationInput& input);

namespace emulated {

__attribute__((visibility("default"))) std::unique_ptr<Simulation> make_simulation(const SimulationInput& input) {
  return make_simulation_on(exec::take_cuda_device(0), input);
}

}  // namespace emulated
}  // namespace gdesp
