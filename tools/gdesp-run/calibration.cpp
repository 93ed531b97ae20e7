// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "core/error.hpp"
#include "exec/profile.hpp"
#include "particles/largest_distance.hpp"
#include "scene_summary.hpp"
#include "simulation/simulation.hpp"

namespace gdesp::tool {
namespace {

constexpr double wall_share = 0.3;

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

double mean_diameter(const SimulationInput& scene) {
  double sum = 0.0;
  for (const float d : scene.grains.diameter) sum += static_cast<double>(d);
  return sum / static_cast<double>(scene.grains.diameter.size());
}

/// Adds a cube (or square) of n grains a side that just touch.
void add_lattice(SimulationInput& input, const SimulationInput& scene, int n) {
  const double diameter = mean_diameter(scene), spacing = 0.9999 * diameter;
  const bool plane = scene.fluid_parameters.dimensions == 2;
  for_each_site(n, scene.fluid_parameters.dimensions, [&](int i, int j, int k) {
    input.grains.position.push_back({(i + 0.5) * spacing, plane ? 0.0 : (j + 0.5) * spacing, (k + 0.5) * spacing});
    input.grains.diameter.push_back(static_cast<float>(diameter));
    input.grains.density.push_back(scene.grains.density.front());
  });
}

/// Grains alone, without weight.
SimulationInput small_lattice(const SimulationInput& scene, int n) {
  const double diameter = mean_diameter(scene);
  SimulationInput input = empty_like(scene, n * diameter, 4.0 * diameter);
  input.fluid_parameters.gravity = {};
  add_lattice(input, scene, n);
  return input;
}

/// The small tank with grains in its corner: as many as fit into 0.8 of its width, at most n a side.
SimulationInput small_mixture(const SimulationInput& scene, const SimulationInput& tank, double width, int n) {
  SimulationInput input = tank;
  input.coupling = scene.coupling;
  input.coupling.real_diameter.resize(std::min<std::size_t>(scene.coupling.real_diameter.size(), 1));
  add_lattice(input, scene, std::clamp(static_cast<int>(0.8 * width / mean_diameter(scene)), 1, n));
  return input;
}

/// Measures loops by name while it lives.
class Profiling {
 public:
  Profiling() {
    exec::reset_profile();
    exec::set_profiling(true);
  }
  ~Profiling() {
    exec::set_profiling(false);
    exec::reset_profile();
  }
  Profiling(const Profiling&) = delete;
  Profiling& operator=(const Profiling&) = delete;
  /// s so far, of the loops of the coupling.
  static double of_coupling() {
    double sum = 0.0;
    for (const exec::ProfileRow& row : exec::profile()) {
      for (const char* name : {"coupling::", "nodes::", "bricks::"})
        if (row.name.rfind(name, 0) == 0) sum += row.seconds;
    }
    return sum;
  }
};

/// s of wall time a step, the loops of the coupling in it (on the processor; a device is not waited for after each loop), s of
/// processor time (on a device: of wall time), and the steps of the grains in it.
struct StepTime {
  double seconds = INFINITY, coupling_seconds = INFINITY, processor_seconds = INFINITY, grain_steps = 0.0;
};

/// The first step is not counted: it touches the memory for the first time.
StepTime time_of_step(const SimulationInput& input, const std::string& device, int steps, int repeats = 2) {
  const Profiling profiling;
  const auto simulation = make_simulation(input, device);
  StepTime least;
  try {
    simulation->step(1.0e30);
  } catch (const Error& problem) {  // a scene beyond all numbers: the run itself will say so
    if (problem.kind() != ErrorKind::numerical) throw;
    return least;
  }
  for (int repeat = 0; repeat < repeats; ++repeat) {  // the best of them: others may use the machine
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t processor_begin = std::clock();
    const double coupling_begin = Profiling::of_coupling();
    for (int k = 0; k < steps; ++k) simulation->step(1.0e30);
    if (device != "cpu") simulation->diagnostics();  // waits for the device
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const double processor = static_cast<double>(std::clock() - processor_begin) / CLOCKS_PER_SEC;
    least.seconds = std::min(least.seconds, seconds / steps);
    least.coupling_seconds = std::min(least.coupling_seconds, (Profiling::of_coupling() - coupling_begin) / steps);
    least.processor_seconds = std::min(least.processor_seconds, (device == "cpu" ? processor : seconds) / steps);
  }
  least.grain_steps = static_cast<double>(simulation->diagnostics().grain_substeps) / (1 + repeats * steps);
  return least;
}

}  // namespace

StepCosts measure_step_costs(const SimulationInput& scene, const std::string& device) {
  StepCosts costs;
  const sph::FluidParameters& p = scene.fluid_parameters;
  const bool plane = p.dimensions == 2;
  const int side = device == "cpu" ? (plane ? 70 : 18) : (plane ? 500 : 64);
  const int grains_a_side = plane ? 50 : 14;
  SimulationInput tank;
  double tank_seconds = 0.0;
  if (!scene.fluid.position.empty()) {
    tank = small_tank(scene, side);
    const double work = static_cast<double>(tank.fluid.position.size()) +
                        wall_share * static_cast<double>(tank.boundary.position.size());
    tank_seconds = time_of_step(tank, device, 8).seconds;
    costs.water = tank_seconds / work;
    costs.wall = wall_share * costs.water;
  }
  if (!scene.grains.position.empty()) {
    const SimulationInput lattice = small_lattice(scene, grains_a_side);
    const StepTime grains = time_of_step(lattice, device, 2);
    costs.grain = grains.seconds / grains.grain_steps / static_cast<double>(lattice.grains.position.size());
    if (scene.coupling.enabled && costs.water > 0.0) {
      const SimulationInput mixture = small_mixture(scene, tank, side * p.dp, grains_a_side);
      const StepTime both = time_of_step(mixture, device, 8);
      const auto n = static_cast<double>(mixture.grains.position.size());
      costs.coupling = device == "cpu"
                           ? both.coupling_seconds / n
                           : std::max(0.0, (both.seconds - tank_seconds) / n - costs.grain * both.grain_steps);
    }
  }
  return costs;
}

double growth_of_cost(const SimulationInput& scene, const std::string& device, double few, double many) {
  constexpr double most = 1.0e6;
  constexpr int steps = 8;
  const auto cost = [&](double particles) {
    const int side =
        static_cast<int>(std::lround(std::pow(std::min(particles, most), 1.0 / scene.fluid_parameters.dimensions)));
    const SimulationInput tank = small_tank(scene, std::max(side, 4));
    const double work = static_cast<double>(tank.fluid.position.size()) +
                        wall_share * static_cast<double>(tank.boundary.position.size());
    const int repeats =
        std::clamp(static_cast<int>(1.0e5 / work), 2, 12);  // small tanks are soon done, and soon disturbed
    return time_of_step(tank, device, steps, repeats).processor_seconds / work;
  };
  return cost(many) / cost(few);
}

double disagreement(const SimulationInput& scene, const std::string& device) {
  const double dp = scene.fluid_parameters.dp;
  const bool water = !scene.fluid.position.empty(), grains = !scene.grains.position.empty();
  constexpr int side = 16, grains_a_side = 6;
  SimulationInput input = water ? small_tank(scene, side) : small_lattice(scene, grains_a_side);
  if (water && grains) input = small_mixture(scene, input, side * dp, grains_a_side);
  try {
    const auto here = make_simulation(input, "cpu"), there = make_simulation(input, device);
    for (int k = 0; k < 8; ++k) {
      here->step(1.0e30);
      there->step(1.0e30);
    }
    const double of_water = largest_distance(here->fluid().position, there->fluid().position) / dp;
    if (!grains) return of_water;
    const double of_grains = largest_distance(here->grains().position, there->grains().position) / mean_diameter(scene);
    return of_water > of_grains || std::isnan(of_water) ? of_water : of_grains;
  } catch (const Error& problem) {  // a scene beyond all numbers: the run itself will say so
    if (problem.kind() != ErrorKind::numerical) throw;
    return 0.0;
  }
}

void refuse_disagreement(double disagreement, const std::string& device) {
  constexpr double allowed = 1.0e-3;
  if (disagreement <= allowed) return;
  throw Error(
      ErrorKind::resource,
      device + " does not compute what the processor computes: after eight steps of a small tank places differ by " +
          number_text(disagreement, 3) + " spacings (allowed: 0.001). Take --device cpu; scripts/gpu-check says more");
}

double step_seconds(const StepCosts& costs, const StepWork& work) {
  return costs.water * work.water + costs.wall * work.walls + costs.grain * work.grains * work.grain_steps +
         costs.coupling * work.grains;
}

}  // namespace gdesp::tool
