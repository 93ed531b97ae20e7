// SPDX-License-Identifier: GPL-3.0-or-later
// What a step costs on this device: measured when a run starts, on a small tank of water with the numerics of the scene,
// on a small lattice of grains with its contact law, and on the lattice in the tank (some tenths of a second on one core).
#pragma once

#include <string>

#include "simulation/simulation_input.hpp"

namespace gdesp::tool {

/// s; 0 where the scene has no such thing.
struct StepCosts {
  double water = 0.0;     ///< per water particle and step of the fluid
  double wall = 0.0;      ///< per wall particle beside water and step of the fluid
  double grain = 0.0;     ///< per grain and step of the grains
  double coupling = 0.0;  ///< per grain and step of the fluid, while it is in water
};

/// Walls are taken in proportion to water: 0.3 a wall particle (two of its passes are light). Coupling is what its loops take in the
/// tank with grains in its water; on a device, where loops are not waited for, what that tank takes more, contacts not counted.
StepCosts measure_step_costs(const SimulationInput& scene, const std::string& device);

/// What a water particle costs a step among `many`, over what it costs among `few`: more data than the caches hold take longer.
/// Both on a tank with the numerics of the scene; processor time on cpu, else wall time.
double growth_of_cost(const SimulationInput& scene, const std::string& device, double few, double many);

/// How far water and grains of the small tank lie apart after eight steps on this device and on the processor, over dp and over the
/// diameter: some 1e-6 where both compute the same. infinite when they do not even count the same particles.
double disagreement(const SimulationInput& scene, const std::string& device);
/// Throws Error(resource) when that is more than a thousandth: the device or its driver is not to be trusted with a run.
void refuse_disagreement(double disagreement, const std::string& device);

/// s of wall time for one step of the fluid with `grain_steps` steps of the grains.
struct StepWork {
  double water = 0.0, walls = 0.0, grains = 0.0, grain_steps = 1.0;
};
double step_seconds(const StepCosts& costs, const StepWork& work);

}  // namespace gdesp::tool
