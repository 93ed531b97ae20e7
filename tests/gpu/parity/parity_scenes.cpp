// SPDX-License-Identifier: GPL-3.0-or-later
#include "parity_scenes.hpp"

#include <algorithm>
#include <cmath>

#include "../../support/surfaces.hpp"
#include "../../support/tank.hpp"

namespace gdesp::parity {
namespace {

double random_unit(std::uint64_t& state) {
  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return static_cast<double>(state >> 11) / 9007199254740992.0;
}

// A block of water that collapses in a tank.
SimulationInput dam_break(double dp, int dimensions) {
  const bool flat = dimensions == 2;
  SimulationInput input = test::tank_input({0.6, flat ? 0.0 : 0.1, 0.3}, 0.2, dp, dimensions);
  test::fill_block(input.fluid, {0, 0, 0}, {0.2, flat ? 0.0 : 0.1, 0.2}, dp, flat);
  input.fluid_parameters.h = 1.5 * dp;
  input.fluid_parameters.artificial_viscosity = 0.05;
  return input;
}

void set_paper(SimulationInput& input) {
  input.time.scheme = TimeScheme::verlet;
  input.time.multirate = false;
  auto& p = input.fluid_parameters;
  p.viscosity = sph::Viscosity::morris;
  p.density_diffusion = 0.0;
  p.artificial_viscosity = 0.0;
  p.extrapolated_walls = false;
  p.paper_form = true;
  p.cavitates = false;
  input.coupling.drag = coupling::Drag::ergun_wen_yu;
  input.coupling.added_mass = 0.0;
}

// Floor and four walls around [0, size], seen from inside.
void box_walls(TriangleTable& t, const Vec3d& s) {
  test::add_rectangle(t, {0, 0, 0}, {s.x, 0, 0}, {s.x, s.y, 0}, {0, s.y, 0});
  test::add_rectangle(t, {0, 0, 0}, {0, s.y, 0}, {0, s.y, s.z}, {0, 0, s.z});
  test::add_rectangle(t, {s.x, 0, 0}, {s.x, 0, s.z}, {s.x, s.y, s.z}, {s.x, s.y, 0});
  test::add_rectangle(t, {0, 0, 0}, {0, 0, s.z}, {s.x, 0, s.z}, {s.x, 0, 0});
  test::add_rectangle(t, {0, s.y, 0}, {s.x, s.y, 0}, {s.x, s.y, s.z}, {0, s.y, s.z});
}

// Grains on a jittered lattice from `low` up, of diameters between 0.8 and 1 d.
void drop_grains(GrainTable& table, const Vec3d& low, const Vec3<int>& count, double d) {
  std::uint64_t state = 88172645463325252ull;
  for (int i = 0; i < count.x; ++i)
    for (int j = 0; j < count.y; ++j)
      for (int k = 0; k < count.z; ++k) {
        const auto at = [&](int n) { return (n + 0.5) * 1.02 * d + 0.01 * d * (random_unit(state) - 0.5); };
        table.position.push_back(low + Vec3d{at(i), at(j), at(k)});
        table.diameter.push_back(static_cast<float>(d * (1.0 - 0.2 * random_unit(state))));
        table.density.push_back(2500.0f);
        const auto v = [&] { return static_cast<float>(0.4 * (random_unit(state) - 0.5)); };
        table.velocity.push_back({v(), v(), v()});
      }
}

// A heap behind a gate that moves up; no water. Rolling resistance or not, Hertz or linear.
SimulationInput heap(int across, bool linear) {
  const double d = 0.01;
  const Vec3d size{0.3, 0.01 * 1.1 * across, 0.3};
  SimulationInput input;
  input.lower = {-0.05, -0.05, -0.05};
  input.upper = {size.x + 0.05, size.y + 0.05, size.z + 0.05};
  input.fluid_parameters.dp = d;
  input.fluid_parameters.h = 1.3 * d;
  input.fluid_parameters.sound_speed = 30.0;
  box_walls(input.walls, size);
  const double gate = 1.1 * d * across;
  test::add_rectangle(input.walls, {gate, 0, 0}, {gate, 0, 0.2}, {gate, size.y, 0.2}, {gate, size.y, 0}, 1);
  Body body;
  body.name = "gate";
  body.motion.time = {0.0, 0.001, 1.0};
  body.motion.displacement = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0.68}};
  input.bodies.push_back(body);
  drop_grains(input.grains, {0.0005, 0.0005, 0.0005}, {across, across, 2 * across}, d);
  input.contact.youngs_modulus = 2e7;
  input.contact.rolling_friction = linear ? 0.0 : 0.1;
  if (linear) input.contact.law = dem::ContactLawKind::linear;
  return input;
}

// Grains that fall into a tank of water and reach its floor.
SimulationInput splash(double dp, int across) {
  const Vec3d size{0.1, 0.1, 0.2};
  SimulationInput input = test::tank_input(size, 0.08, dp, 3);
  test::fill_block(input.fluid, {0, 0, 0}, {size.x, size.y, 0.08}, dp, false);
  input.fluid_parameters.h = 1.5 * dp;
  input.fluid_parameters.artificial_viscosity = 0.1;
  box_walls(input.walls, size);
  drop_grains(input.grains, {0.03, 0.03, 0.06}, {across, across, across}, 0.5 * dp);
  for (Vec3f& v : input.grains.velocity) v.z -= 0.5f;
  input.contact.youngs_modulus = 1e6;
  return input;
}

// Water that a free box falls into and a piston pushes, over a floor that the water sticks to; `length` of the tank over dp.
SimulationInput box_and_piston(double dp, int length = 40) {
  const Vec3d size{length * dp, 0.0, 20 * dp}, low{12 * dp, -0.5, 8 * dp}, high{20 * dp, 0.5, 14 * dp};
  SimulationInput input = test::tank_input(size, 10 * dp, dp, 2);
  input.fluid_parameters.h = 1.5 * dp;
  for (int i = 0; i < length; ++i)
    for (int k = 0; k < 10; ++k) {
      const Vec3d r{(i + 0.5) * dp, 0.0, (k + 0.5) * dp};
      if (r.x < 3 * dp || (r.x > low.x && r.x < high.x && r.z > low.z)) continue;
      input.fluid.position.push_back(r);
    }
  BoundaryTable& walls = input.boundary;
  walls.body.assign(walls.position.size(), 0);
  for (int i = 12; i < 20; ++i)
    for (int k = 8; k < 14; ++k) {
      walls.position.push_back({(i + 0.5) * dp, 0.0, (k + 0.5) * dp});
      walls.body.push_back(1);
    }
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 14; ++k) {
      walls.position.push_back({(i + 0.5) * dp, 0.0, (k + 0.5) * dp});
      walls.body.push_back(2);
    }
  walls.friction.assign(walls.position.size(), 1.0f);
  for (const Vec3d& r : walls.position) {
    walls.normal.push_back(r.z < 0.0 ? Vec3f{0, 0, 1} : Vec3f{});
    walls.depth.push_back(r.z < 0.0 ? static_cast<float>(-r.z) : 0.0f);
  }
  test::add_box(input.walls, 1, low, high);
  input.bodies.push_back(test::box_body(low, high, 600.0));
  input.bodies[0].velocity = {0.0, 0.0, -0.5};
  Body piston;
  piston.name = "piston";
  piston.motion.time = {0.0, 1.0};
  piston.motion.displacement = {{0, 0, 0}, {0.5, 0, 0}};
  input.bodies.push_back(piston);
  return input;
}

// A disc of water without walls in a period that it crosses the edge of: under tension, shifted, without viscosity.
SimulationInput drop(double dp, TimeScheme scheme) {
  SimulationInput input = test::tank_input({20 * dp, 0.0, 20 * dp}, 10 * dp, dp, 2);
  input.boundary = {};
  input.periodic[0] = true;
  input.lower.x = 0.0;
  input.upper.x = 20 * dp;
  input.time.scheme = scheme;
  auto& p = input.fluid_parameters;
  p.h = 2.0 * dp;
  p.gravity = {};
  p.viscosity = sph::Viscosity::none;
  p.cavitates = false;
  p.tensile_control = true;
  p.shifting = 0.5;
  for (int i = 0; i < 16; ++i)
    for (int k = 0; k < 16; ++k) {
      const Vec3d r{(i + 3.5) * dp, 0.0, (k + 2.5) * dp};
      const Vec3d off{r.x - 11.5 * dp, 0.0, r.z - 10.5 * dp};
      if (norm(off) > 8 * dp) continue;
      input.fluid.position.push_back(r);
      input.fluid.velocity.push_back({static_cast<float>(6.0 + off.z), 0.0f, static_cast<float>(-off.x)});
    }
  input.fluid.density.assign(input.fluid.position.size(), 1000.0f);
  return input;
}

SimulationInput with_morris(SimulationInput input, TimeScheme scheme) {
  input.time.scheme = scheme;
  input.fluid_parameters.viscosity = sph::Viscosity::morris;
  input.fluid_parameters.kinematic_viscosity = 1.0e-3;
  return input;
}
// Most of a long tank asleep, and no viscosity.
SimulationInput half_asleep(double dp) {
  SimulationInput input = box_and_piston(dp, 120);
  input.fluid_parameters.activity.sleep = true;
  input.fluid_parameters.viscosity = sph::Viscosity::none;
  return input;
}
SimulationInput with_verlet(SimulationInput input) {
  input.time.scheme = TimeScheme::verlet;
  return input;
}
SimulationInput with_rolling(SimulationInput input) {
  input.contact.rolling_friction = 0.1;
  return input;
}

Scene scene(const char* name, SimulationInput input, int steps) {
  Scene s{name, std::move(input), steps, 0.0f};
  if (!s.input.grains.diameter.empty())
    s.smallest_diameter = *std::min_element(s.input.grains.diameter.begin(), s.input.grains.diameter.end());
  return s;
}

SimulationInput with_paper(SimulationInput input) {
  set_paper(input);
  return input;
}

}  // namespace

std::vector<Scene> scenes(bool small) {
  const int steps = small ? 6 : 40;
  std::vector<Scene> all;
  all.push_back(scene("dam break, 2D", dam_break(small ? 0.02 : 0.005, 2), steps));
  all.push_back(scene("dam break, 2D, paper", with_paper(dam_break(small ? 0.02 : 0.005, 2)), steps));
  all.push_back(scene("dam break, 3D", dam_break(small ? 0.02 : 0.01, 3), steps));
  const double dp = small ? 0.02 : 0.01;
  // A hundred sub-steps. After two hundred, a unit in the last place of some grains' velocities can have become 3e-3 of the
  // largest velocity (measured on one back end), and the comparison would say nothing.
  const int heap_steps = 2;
  all.push_back(scene("box and piston", box_and_piston(dp), steps));
  all.push_back(scene("box and piston, sleep", half_asleep(dp), steps));
  all.push_back(scene("box and piston, verlet", with_verlet(box_and_piston(dp)), steps));
  all.push_back(scene("box and piston, morris", with_morris(box_and_piston(dp), TimeScheme::split), steps));
  all.push_back(scene("drop, periodic, tension", drop(dp, TimeScheme::split), steps));
  all.push_back(scene("drop, the same, verlet", drop(dp, TimeScheme::verlet), steps));
  all.push_back(scene("heap, hertz, rolling", heap(small ? 4 : 10, false), heap_steps));
  all.push_back(scene("heap, linear", heap(small ? 4 : 10, true), heap_steps));
  all.push_back(scene("heap, linear, rolling", with_rolling(heap(small ? 4 : 10, true)), heap_steps));
  all.push_back(scene("grains in water", splash(small ? 0.02 : 0.01, small ? 4 : 8), steps));
  all.push_back(scene("grains in water, paper", with_paper(splash(small ? 0.02 : 0.01, small ? 4 : 8)), steps));
  return all;
}

}  // namespace gdesp::parity
