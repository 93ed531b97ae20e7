// SPDX-License-Identifier: GPL-3.0-or-later
// The same short runs on two devices: what each particle does must agree within the tolerances stated in the table.
// A plain program: it builds with the solver alone (no GoogleTest), so that it runs on a bare machine with a GPU.
// usage: parity [--small] [DEVICE]        DEVICE: cuda (default), cuda:N, cpu (one thread against all: no difference), or,
//                                         in the program parity_emulated, emulated (tests/gpu/emulated)
// Exit status: 0 all agree, 1 some do not, 77 no such device.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "exec/array.hpp"
#include "exec/backend.hpp"
#include "parity_scenes.hpp"
#include "particles/largest_distance.hpp"
#include "simulation/simulation.hpp"
#if defined(GDESP_EMULATED_DEVICE)
#include "../emulated/emulated_simulation.hpp"
#endif

namespace gdesp {
namespace {

// Both back ends sum in the same order; what differs is the rounding of quotients, roots and fused products. Measured
// per step it is a few units in the last place of single precision, and contacts and violent water amplify it.
constexpr double place_tolerance = 2.0e-4;    // of dp or of the smallest diameter
constexpr double speed_tolerance = 2.0e-4;    // of the sound speed or of the largest grain speed
constexpr double density_tolerance = 2.0e-6;  // of the reference density
constexpr double energy_tolerance = 1.0e-5;   // of the kinetic and elastic energy

struct State {
  FluidTable fluid;
  GrainTable grains;
  std::vector<BodyPose> bodies;
  Diagnostics sums;
};

State state_of(Simulation& simulation) {
  return {simulation.fluid(), simulation.grains(), simulation.bodies(), simulation.diagnostics()};
}

std::unique_ptr<Simulation> make(const SimulationInput& input, const std::string& device) {
#if defined(GDESP_EMULATED_DEVICE)
  if (device == "emulated") return emulated::make_simulation(input);
#endif
  return make_simulation(input, device);
}

/// In the middle of the run the water becomes a tenth stiffer, as in a run in trouble.
State run(const SimulationInput& input, const std::string& device, int steps) {
  const auto simulation = make(input, device);
  for (int k = 0; k < steps; ++k) {
    if (k == steps / 2) simulation->set_caution(1.0, 1.1 * simulation->sound_speed());
    simulation->step(1.0e3);
  }
  return state_of(*simulation);
}

class Table {
 public:
  void row(const std::string& scene, const char* quantity, double difference, double tolerance) {
    const bool agrees = difference <= tolerance;  // false for NaN
    std::printf("%-26s %-26s %10.2e %10.1e  %s\n", scene.c_str(), quantity, difference, tolerance,
                agrees ? "ok" : "FAILED");
    ++(agrees ? passed : failed);
  }
  int passed = 0, failed = 0;
};

std::vector<Vec3d> each(const std::vector<BodyPose>& bodies, Vec3d BodyPose::*quantity) {
  std::vector<Vec3d> values;
  for (const BodyPose& body : bodies) values.push_back(body.*quantity);
  return values;
}
double largest_distance(const std::vector<BodyPose>& a, const std::vector<BodyPose>& b, Vec3d BodyPose::*quantity) {
  return gdesp::largest_distance(each(a, quantity), each(b, quantity));
}

void compare(const parity::Scene& scene, const State& a, const State& b, Table& table) {
  const sph::FluidParameters& p = scene.input.fluid_parameters;
  if (!a.fluid.position.empty()) {
    table.row(scene.name, "water, place / dp", gdesp::largest_distance(a.fluid.position, b.fluid.position) / p.dp,
              place_tolerance);
    table.row(scene.name, "water, velocity / c",
              gdesp::largest_distance(a.fluid.velocity, b.fluid.velocity) / p.sound_speed, speed_tolerance);
    table.row(scene.name, "water, density / rho0",
              gdesp::largest_distance(a.fluid.density, b.fluid.density) / p.reference_density, density_tolerance);
  }
  if (!a.grains.position.empty()) {
    const double d = static_cast<double>(scene.smallest_diameter);
    table.row(scene.name, "grains, place / d", gdesp::largest_distance(a.grains.position, b.grains.position) / d,
              place_tolerance);
    table.row(scene.name, "grains, velocity / largest",
              gdesp::largest_distance(a.grains.velocity, b.grains.velocity) / a.sums.largest_grain_speed,
              speed_tolerance);
  }
  if (!a.bodies.empty() && !a.fluid.position.empty()) {
    table.row(scene.name, "bodies, place / dp", largest_distance(a.bodies, b.bodies, &BodyPose::centre) / p.dp,
              place_tolerance);
    table.row(scene.name, "bodies, velocity / c",
              largest_distance(a.bodies, b.bodies, &BodyPose::velocity) / p.sound_speed, speed_tolerance);
  }
  const double energy = a.sums.fluid_kinetic + a.sums.fluid_elastic + a.sums.grain_kinetic + a.sums.grain_elastic;
  const double other = b.sums.fluid_kinetic + b.sums.fluid_elastic + b.sums.grain_kinetic + b.sums.grain_elastic;
  table.row(scene.name, "energy", std::fabs(energy - other) / energy, energy_tolerance);
  table.row(scene.name, "steps, lists, sub-steps",
            std::fabs(static_cast<double>(a.sums.step - b.sums.step)) +
                std::fabs(static_cast<double>(a.sums.rebuilds - b.sums.rebuilds)) +
                std::fabs(static_cast<double>(a.sums.grain_substeps - b.sums.grain_substeps)),
            0.0);
}

// Exactly: not a bit differs in what particles do. (Where a list lies in memory may differ, and does no harm.)
double differences(const State& a, const State& b) {
  return gdesp::largest_distance(a.fluid.position, b.fluid.position) +
         gdesp::largest_distance(a.fluid.velocity, b.fluid.velocity) +
         gdesp::largest_distance(a.fluid.density, b.fluid.density) +
         gdesp::largest_distance(a.grains.position, b.grains.position) +
         gdesp::largest_distance(a.grains.velocity, b.grains.velocity) +
         gdesp::largest_distance(a.grains.angular_velocity, b.grains.angular_velocity) +
         largest_distance(a.bodies, b.bodies, &BodyPose::centre) +
         largest_distance(a.bodies, b.bodies, &BodyPose::angular_velocity);
}

// On one device: the same twice, and a run resumed from its checkpoint ends as the unbroken one.
void repeat_and_resume(const parity::Scene& scene, const std::string& device, Table& table) {
  const State first = run(scene.input, device, scene.steps);
  table.row(scene.name, "the same twice", differences(first, run(scene.input, device, scene.steps)), 0.0);
  const auto broken = make(scene.input, device);
  for (int k = 0; k < scene.steps / 2; ++k) broken->step(1.0e3);
  std::stringstream checkpoint;
  broken->save(checkpoint);
  const auto resumed = make(scene.input, device);
  resumed->load(checkpoint);
  resumed->set_caution(1.0, 1.1 * resumed->sound_speed());
  for (int k = scene.steps / 2; k < scene.steps; ++k) resumed->step(1.0e3);
  table.row(scene.name, "resumed as unbroken", differences(state_of(*resumed), first), 0.0);
}

int check(const std::string& device, bool small) {
  Table table;
  std::printf("%-26s %-26s %10s %10s\n", "scene", "quantity", "difference", "tolerance");
  for (const parity::Scene& scene : parity::scenes(small)) {
    exec::set_threads(device == "cpu" ? 1 : 0);
    const State reference = run(scene.input, "cpu", scene.steps);
    exec::set_threads(0);
    compare(scene, reference, run(scene.input, device, scene.steps), table);
    repeat_and_resume(scene, device, table);
  }
#if defined(GDESP_EMULATED_DEVICE)
  for (const auto& [body, launches] : emulated::work_done())
    std::printf("%8ld launches of %s\n", launches, body.c_str());
#endif
  std::printf("%d passed, %d failed\n", table.passed, table.failed);
  return table.failed == 0 ? 0 : 1;
}

}  // namespace
}  // namespace gdesp

int main(int argc, char** argv) {
  std::string device = "cuda";
  bool small = false;
  for (int k = 1; k < argc; ++k) {
    if (std::strcmp(argv[k], "--small") == 0)
      small = true;
    else
      device = argv[k];
  }
  if (device.rfind("cuda", 0) == 0 && gdesp::exec::cuda_devices().empty()) {
    std::printf("SKIPPED: no CUDA device is seen%s\n",
                gdesp::exec::cuda_built() ? "" : ", and no CUDA back end is built");
    return 77;
  }
  try {
    return gdesp::check(device, small);
  } catch (const gdesp::Error& problem) {
    std::fprintf(stderr, "parity: %s\n", problem.what());
    return 1;
  }
}
