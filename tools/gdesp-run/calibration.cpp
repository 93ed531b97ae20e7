// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/error.hpp"
#include "simulation/simulation.hpp"

namespace gdesp::tool {
namespace {

constexpr double wall_share = 0.3, coupling_share = 1.4;

/// Positions of a cube (or square) of n^dimensions points, spacing a, its lower corner half a spacing above the origin.
template <class Visit>
void for_each_site(int n, int dimensions, const Visit& visit) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < (dimensions == 2 ? 1 : n); ++j)
      for (int k = 0; k < n; ++k) visit(i, j, k);
}

SimulationInput empty_like(const SimulationInput& scene, double size, double margin) {
  SimulationInput input;
  input.fluid_parameters = scene.fluid_parameters;
  input.fluid_parameters.activity.sleep = false;
  input.contact = scene.contact;
  input.time = scene.time;
  input.time.fixed_step = input.time.cfl = 0.0;  // the cost of a step, not its length: it must hold
  input.lower = {-margin, scene.fluid_parameters.dimensions == 2 ? -scene.fluid_parameters.dp : -margin, -margin};
  input.upper = {size + margin, scene.fluid_parameters.dimensions == 2 ? scene.fluid_parameters.dp : size + margin,
                 size + margin};
  return input;
}

/// A tank of water that shears, so that lists are made anew as often as in moving water.
SimulationInput small_tank(const SimulationInput& scene, int n) {
  constexpr int layers = 3;
  const sph::FluidParameters& p = scene.fluid_parameters;
  const double dp = p.dp, size = n * dp;
  SimulationInput input = empty_like(scene, size, 8.0 * dp);
  const double y0 = p.dimensions == 2 ? -0.5 * dp : 0.0;
  for_each_site(n + 2 * layers, p.dimensions, [&](int i, int j, int k) {
    const int x = i - layers, y = p.dimensions == 2 ? 0 : j - layers, z = k - layers;
    const Vec3d r{(x + 0.5) * dp, y0 + (y + 0.5) * dp, (z + 0.5) * dp};
    const bool inside = x >= 0 && x < n && y >= 0 && (p.dimensions == 2 || y < n) && z >= 0 && z < n;
    if (!inside) {
      if (z < n) input.boundary.position.push_back(r);
      return;
    }
    input.fluid.position.push_back(r);
    input.fluid.velocity.push_back(Vec3f{static_cast<float>(0.05 * p.sound_speed * r.z / size), 0.0f, 0.0f});
  });
  return input;
}

/// Grains on a lattice that touch, without weight.
SimulationInput small_lattice(const SimulationInput& scene, int n) {
  double sum = 0.0;
  for (const float d : scene.grains.diameter) sum += static_cast<double>(d);
  const double diameter = sum / static_cast<double>(scene.grains.diameter.size()), spacing = 0.9999 * diameter;
  SimulationInput input = empty_like(scene, n * spacing, 4.0 * diameter);
  input.fluid_parameters.gravity = {};
  const bool plane = scene.fluid_parameters.dimensions == 2;
  for_each_site(n, scene.fluid_parameters.dimensions, [&](int i, int j, int k) {
    input.grains.position.push_back({(i + 0.5) * spacing, plane ? 0.0 : (j + 0.5) * spacing, (k + 0.5) * spacing});
    input.grains.diameter.push_back(static_cast<float>(diameter));
    input.grains.density.push_back(scene.grains.density.front());
  });
  return input;
}

/// s of wall time a step, the first not counted: it touches the memory for the first time.
double seconds_per_step(const SimulationInput& input, const std::string& device, int steps) {
  const auto simulation = make_simulation(input, device);
  double least = INFINITY;
  try {
    simulation->step(1.0e30);
  } catch (const Error& problem) {  // a scene beyond all numbers: the run itself will say so
    if (problem.kind() != ErrorKind::numerical) throw;
    return least;
  }
  for (int repeat = 0; repeat < 2; ++repeat) {  // the better of two: others may use the machine
    const auto begin = std::chrono::steady_clock::now();
    for (int k = 0; k < steps; ++k) simulation->step(1.0e30);
    if (device != "cpu") simulation->diagnostics();  // waits for the device
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / steps);
  }
  return least;
}

}  // namespace

StepCosts measure_step_costs(const SimulationInput& scene, const std::string& device) {
  StepCosts costs;
  const sph::FluidParameters& p = scene.fluid_parameters;
  const bool plane = p.dimensions == 2;
  const int side = device == "cpu" ? (plane ? 70 : 18) : (plane ? 500 : 64);
  if (!scene.fluid.position.empty()) {
    const SimulationInput tank = small_tank(scene, side);
    const double work = static_cast<double>(tank.fluid.position.size()) +
                        wall_share * static_cast<double>(tank.boundary.position.size());
    costs.water = seconds_per_step(tank, device, 8) / work;
    costs.wall = wall_share * costs.water;
  }
  if (!scene.grains.position.empty()) {
    const SimulationInput lattice = small_lattice(scene, plane ? 50 : 14);
    constexpr double substeps = 50.0;  // of a run without water
    costs.grain = seconds_per_step(lattice, device, 2) / substeps / static_cast<double>(lattice.grains.position.size());
    if (scene.coupling.enabled && costs.water > 0.0) {
      const float largest = *std::max_element(scene.grains.diameter.begin(), scene.grains.diameter.end());
      costs.coupling =
          coupling_share * costs.water * (1.0 + std::pow(static_cast<double>(largest) / p.dp, p.dimensions));
    }
  }
  return costs;
}

double step_seconds(const StepCosts& costs, const StepWork& work) {
  return costs.water * work.water + costs.wall * work.walls + costs.grain * work.grains * work.grain_steps +
         costs.coupling * work.grains;
}

}  // namespace gdesp::tool
