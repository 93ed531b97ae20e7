// SPDX-License-Identifier: GPL-3.0-or-later
// Grains in water against exact answers.
// @eq coupling.averaging
// @eq coupling.porosity
// @eq coupling.buoyancy
// @eq coupling.reaction
// @eq coupling.added-mass
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <tuple>

#include "support/surfaces.hpp"
#include "support/tank.hpp"

namespace gdesp {
namespace {

// A periodic box of water without gravity or walls, grains moving through it.
SimulationInput periodic_box(double dp, int n) {
  SimulationInput input;
  input.lower = {0, 0, 0};
  input.upper = {n * dp, n * dp, n * dp};
  for (bool& p : input.periodic) p = true;
  auto& p = input.fluid_parameters;
  p.dp = dp;
  p.h = 1.5 * dp;
  p.sound_speed = 10.0;
  p.kinematic_viscosity = 1e-6;
  p.gravity = {};
  test::fill_block(input.fluid, {0, 0, 0}, input.upper, dp, false);
  input.fluid.density.assign(input.fluid.position.size(), 1000.0f);
  input.contact.youngs_modulus = 1e6;
  return input;
}

TEST(Coupling, closed_system_keeps_its_momentum) {
  for (TimeScheme scheme : {TimeScheme::split, TimeScheme::verlet}) {
    SimulationInput input = periodic_box(0.01, 14);
    input.time.scheme = scheme;
    std::mt19937 random(4);
    std::uniform_real_distribution<double> u(0.0, 0.14);
    for (int k = 0; k < 60; ++k) {
      input.grains.position.push_back({u(random), u(random), u(random)});
      input.grains.velocity.push_back({0.5f, -0.2f, 0.1f});
      input.grains.diameter.push_back(0.005f);
      input.grains.density.push_back(2500.0f);
    }
    auto simulation = make_simulation(input, "cpu");
    const Diagnostics before = simulation->diagnostics();
    simulation->advance_to(0.05);
    const Diagnostics after = simulation->diagnostics();
    const Vec3d total = before.fluid_momentum + before.grain_momentum;
    const Vec3d change = after.fluid_momentum + after.grain_momentum - total;
    EXPECT_LT(norm(change), 1e-5 * norm(total)) << "scheme " << static_cast<int>(scheme);
    // The water took a good part of it: this is not a test of nothing happening.
    EXPECT_LT(norm(after.grain_momentum), 0.9 * norm(before.grain_momentum));
    EXPECT_GT(norm(after.fluid_momentum), 0.1 * norm(total));
  }
}

SimulationInput settling_tank(double dp, float d) {
  SimulationInput input = test::tank_input({0.1, 0.1, 0.2}, 0.15, dp, 3);
  input.fluid_parameters.h = 1.5 * dp;
  input.fluid_parameters.artificial_viscosity = 0.05;
  test::fill_block(input.fluid, {0, 0, 0}, {0.1, 0.1, 0.15}, dp, false);
  input.grains.position.push_back({0.05, 0.05, 0.12});
  input.grains.diameter.push_back(d);
  input.grains.density.push_back(2500.0f);
  input.contact.youngs_modulus = 1e5;
  return input;
}

TEST(Coupling, a_bead_settles_at_its_terminal_velocity) {
  // 2.7 mm glass bead in water. Dallavalle 0.287 m/s, Schiller-Naumann 0.343 m/s.
  SimulationInput input = settling_tank(0.01, 2.7e-3f);
  auto felice = make_simulation(input, "cpu");
  felice->advance_to(0.22);
  EXPECT_NEAR(-felice->grains().velocity[0].z, 0.287f, 0.03f * 0.287f);
  input.coupling.drag = coupling::Drag::ergun_wen_yu;
  auto ergun = make_simulation(input, "cpu");
  ergun->advance_to(0.22);
  EXPECT_NEAR(-ergun->grains().velocity[0].z, 0.343f, 0.03f * 0.343f);
}

TEST(Coupling, buoyancy_of_a_neutral_grain_is_its_weight) {
  SimulationInput input = settling_tank(0.01, 4e-3f);
  input.grains.density[0] = 1000.0f;
  auto simulation = make_simulation(input, "cpu");
  simulation->advance_to(0.2);
  EXPECT_LT(norm(simulation->grains().velocity[0]), 0.01f);  // a 1 % error of buoyancy gives 0.02 m/s at rest
}

TEST(Coupling, a_grain_above_the_water_falls_freely) {
  SimulationInput input = settling_tank(0.01, 2.7e-3f);
  input.grains.position[0].z = 0.19;
  auto simulation = make_simulation(input, "cpu");
  simulation->advance_to(0.03);
  EXPECT_NEAR(simulation->grains().velocity[0].z, -9.81f * 0.03f, 0.01f * 9.81f * 0.03f);
}

double energy(const Diagnostics& d) {
  return d.fluid_kinetic + d.fluid_potential + d.fluid_elastic + d.grain_kinetic + d.grain_potential + d.grain_elastic;
}

// A block of discs with a third of pores strikes water at 2 m/s, in the plane; `shift`: m, of the block along the water.
SimulationInput block_into_water(double shift = 0.0) {
  const double dp = 0.01;
  SimulationInput input = test::tank_input({0.4, 0.0, 0.4}, 0.1, dp, 2);
  input.fluid_parameters.h = 1.5 * dp;
  input.fluid_parameters.artificial_viscosity = 0.1;
  input.fluid_parameters.sound_speed = 40.0;
  test::fill_block(input.fluid, {0, 0, 0}, {0.4, 0, 0.1}, dp, true);
  for (int x = 0; x < 18; ++x)
    for (int z = 0; z < 9; ++z) {
      input.grains.position.push_back({0.15 + shift + 0.0055 * (x + 0.5), 0.0, 0.105 + 0.0055 * (z + 0.5)});
      input.grains.velocity.push_back({0.0f, 0.0f, -2.0f});
      input.grains.diameter.push_back(0.005f);
      input.grains.density.push_back(2650.0f);
    }
  input.contact.youngs_modulus = 1e7;
  return input;
}

struct Splash {
  double energy_made, largest_speed;  // share of the kinetic energy at the start; m/s
};
Splash splash(double length_over_h, double shift) {
  SimulationInput input = block_into_water(shift);
  input.coupling.smoothing_length = length_over_h * input.fluid_parameters.h;
  auto simulation = make_simulation(input, "cpu");
  const double kinetic = simulation->diagnostics().grain_kinetic;
  double lowest = energy(simulation->diagnostics()), rise = 0.0, speed = 0.0;
  while (simulation->time() < 0.15) {
    simulation->step(0.15);
    const Diagnostics now = simulation->diagnostics();
    rise = std::max(rise, energy(now) - lowest);
    lowest = std::min(lowest, energy(now));
    speed = std::max(speed, now.largest_speed);
  }
  return {rise / kinetic, speed};
}

// What the squeezed water gains, the grains pay. Of the kinetic energy 0.02 % is made at an averaging length of 2 h, half of the
// default. At h the nodes stand as close as the particles, the lattice shows through, and chance decides: 0.1 to 1.3 % (any
// change of the last digit moves it), 0.2 % in the mean of ten starts; hence the mean of six is asked. With a buoyancy
// interpolated from the water's acceleration, or porosity and forces that do not belong together, it was 6 to 30 %, and water at
// two and three times the block's speed.
TEST(Coupling, a_dense_block_into_water_makes_no_energy_and_no_spray) {
  for (const auto& [length_over_h, starts, share] : {std::tuple{2.0, 1, 5e-4}, std::tuple{1.0, 6, 6e-3}}) {
    double made = 0.0;
    for (int k = 0; k < starts; ++k) {
      const Splash s = splash(length_over_h, 0.00137 * k);
      made += s.energy_made / starts;
      EXPECT_LT(s.largest_speed, 4.0) << length_over_h;
      EXPECT_GT(s.largest_speed, 1.0) << length_over_h;
    }
    EXPECT_LT(made, share) << length_over_h;
  }
}

// A column of grains, full of water, in the corner of two walls; at first nothing holds it.
SimulationInput column_in_a_corner(double dp) {
  const double d = 0.004, side = 0.036;
  SimulationInput input = test::tank_input({0.09, 0.09, 0.06}, side, dp, 3);
  input.fluid_parameters.h = 1.5 * dp;
  input.fluid_parameters.artificial_viscosity = 0.05;
  input.fluid_parameters.density_diffusion = 0.1;
  input.fluid_parameters.sound_speed = 10.0;
  test::fill_block(input.fluid, {0, 0, 0}, {side, side, side}, dp, false);
  for (int x = 0; x < 9; ++x)
    for (int y = 0; y < 9; ++y)
      for (int z = 0; z < 9; ++z) {
        input.grains.position.push_back({d * (x + 0.5), d * (y + 0.5), d * (z + 0.5)});
        input.grains.diameter.push_back(static_cast<float>(d));
        input.grains.density.push_back(2660.0f);
      }
  input.contact.youngs_modulus = 2e7;
  return input;
}

// It collapses: what walls do to the water between grains makes no
// energy. Over the weight on one spacing: 0.03 %, with the walls' pressure taken from the water's own 0.3 % (docs/decisions/0048).
TEST(Coupling, walls_make_no_energy_in_pores) {
  const double dp = 0.003;
  auto simulation = make_simulation(column_in_a_corner(dp), "cpu");
  const Diagnostics start = simulation->diagnostics();
  double least = energy(start), rise = 0.0;
  while (simulation->time() < 0.01) {
    simulation->step(0.01);
    const double now = energy(simulation->diagnostics());
    rise = std::max(rise, now - least);
    least = std::min(least, now);
  }
  EXPECT_LT(rise, 1e-3 * (start.fluid_mass + start.grain_mass) * 9.81 * dp);
}

// Porosity and masses of the start belong together: the water's pressure does not jump in the first step. It is asked for by the work of its
// compression, which goes with the square of the pressure; after twelve rounds of
// settling, whatever was left, it was 1.08 times that (and three times in the saturated column of data/cases at 6 mm).
TEST(Coupling, pores_are_settled_before_the_first_step) {
  auto simulation = make_simulation(column_in_a_corner(0.006), "cpu");
  const double before = simulation->diagnostics().fluid_elastic;
  simulation->step(1.0);
  EXPECT_NEAR(simulation->diagnostics().fluid_elastic / before, 1.0, 0.03);
}

// Pores hold what the grains leave, whether the table has a full lattice there or one thinned to the pores. Counted exactly: a
// periodic box all full of evenly spread grains. A kernel sum that takes the particle itself for more than its room finds 3 %
// (plane) and 2 % less.
TEST(Coupling, pores_hold_the_water_that_grains_leave) {
  const double dp = 0.01;
  const int n = 16;
  for (const int dimensions : {2, 3}) {
    const auto spread = [&](int across, std::vector<Vec3d>& places) {
      const double step = n * dp / across;
      for (int i = 0; i < across; ++i)
        for (int j = 0; j < (dimensions == 2 ? 1 : across); ++j)
          for (int k = 0; k < across; ++k)
            places.push_back({(i + 0.5) * step, dimensions == 2 ? 0.0 : (j + 0.5) * step, (k + 0.5) * step});
    };
    const int thin = dimensions == 2 ? 10 : 12;
    const double eps = std::pow(static_cast<double>(thin) / n, dimensions),
                 solid = (1.0 - eps) * std::pow(dp, dimensions);
    const double d = dimensions == 2 ? std::sqrt(4.0 * solid / 3.14159265) : std::cbrt(6.0 * solid / 3.14159265);
    for (const int across : {n, thin}) {
      SimulationInput input = periodic_box(dp, n);
      input.fluid_parameters.dimensions = dimensions;
      if (dimensions == 2) {
        input.lower.y = -0.5 * dp;
        input.upper.y = 0.5 * dp;
        input.periodic[1] = false;
      }
      input.fluid = {};
      spread(across, input.fluid.position);
      input.fluid.density.assign(input.fluid.position.size(), 1000.0f);
      spread(n, input.grains.position);
      input.grains.diameter.assign(input.grains.position.size(), static_cast<float>(d));
      input.grains.density.assign(input.grains.position.size(), 2650.0f);
      auto simulation = make_simulation(input, "cpu");
      EXPECT_NEAR(simulation->diagnostics().fluid_mass / (1000.0 * eps * std::pow(n * dp, dimensions)), 1.0, 0.005)
          << dimensions << " " << across;
    }
  }
}

// A bed of grains lies still in still water, in a tank whose edges it fills. It did not (0.1 m/s and more, for ever) while the density
// diffusion or the walls saw another pressure than the momentum, or grains beside walls counted as half dry (docs/decisions/0043).
TEST(Coupling, a_bed_under_still_water_comes_to_rest) {
  const double dp = 0.01, d = 0.01, depth = 0.12;
  const Vec3d size{0.12, 0.08, 0.14};
  SimulationInput input = test::tank_input(size, depth, dp, 3);
  input.fluid_parameters.h = 1.5 * dp;
  input.fluid_parameters.artificial_viscosity = 0.02;
  input.fluid_parameters.density_diffusion = 0.1;
  test::fill_block(input.fluid, {0, 0, 0}, {size.x, size.y, depth}, dp, false);
  test::rest_rows(input, depth);
  for (int z = 0; z < 6; ++z)
    for (int y = 0; y < 7 - z % 2; ++y)
      for (int x = 0; x < 11 - z % 2; ++x) {
        const double odd = 0.5 * (z % 2);
        input.grains.position.push_back(
            {(x + odd + 0.5) * size.x / 11, (y + odd + 0.5) * size.y / 7, (0.5 + 0.8 * z) * d});
        input.grains.diameter.push_back(static_cast<float>(d));
        input.grains.density.push_back(2650.0f);
      }
  input.walls = test::tank({0, 0, 0}, size);
  input.contact.youngs_modulus = 1e6;
  auto simulation = make_simulation(input, "cpu");
  simulation->advance_to(1.0);
  const Diagnostics e = simulation->diagnostics();
  const double wave = std::sqrt(9.81 * depth);
  EXPECT_LT(std::sqrt(2.0 * e.fluid_kinetic / e.fluid_mass), 0.02 * wave);  // 0.9 %; before 10 %
  EXPECT_LT(std::sqrt(2.0 * e.grain_kinetic / e.grain_mass), 0.002 * wave);
  EXPECT_EQ(e.lost_fluid, 0);
}

}  // namespace
}  // namespace gdesp
