// SPDX-License-Identifier: GPL-3.0-or-later
// What is left out because it does not change the answer: the answer with it and without it.
#include <gtest/gtest.h>

#include "support/tank.hpp"

namespace gdesp {
namespace {

constexpr double dp = 0.02;

/// A column of water that collapses in a long tank, in the plane.
SimulationInput collapse() {
  SimulationInput input = test::tank_input({1.6, 0.0, 0.6}, 0.3, dp, 2);
  input.fluid_parameters.h = 1.5 * dp;
  input.fluid_parameters.artificial_viscosity = 0.05;
  input.fluid_parameters.skin = 0.0;
  test::fill_block(input.fluid, {0, 0, 0}, {0.4, 0, 0.3}, dp, true);
  return input;
}

FluidTable water_after(const SimulationInput& input, double end) {
  auto simulation = make_simulation(input, "cpu");
  simulation->advance_to(end);
  return simulation->fluid();
}

void expect_same_bytes(const FluidTable& a, const FluidTable& b) {
  ASSERT_EQ(a.position.size(), b.position.size());
  for (std::size_t i = 0; i < a.position.size(); ++i) {
    ASSERT_EQ(a.position[i], b.position[i]) << i;
    ASSERT_EQ(a.velocity[i], b.velocity[i]) << i;
    ASSERT_EQ(a.density[i], b.density[i]) << i;
  }
}

/// m: the mean of the ten foremost particles.
double front(FluidTable water) {
  std::sort(water.position.begin(), water.position.end(), [](const Vec3d& a, const Vec3d& b) { return a.x > b.x; });
  double sum = 0.0;
  for (std::size_t i = 0; i < 10; ++i) sum += water.position[i].x / 10.0;
  return sum;
}

TEST(LeftOut, walls_away_from_water_change_nothing) {
  for (const bool extrapolated : {true, false}) {
    SimulationInput input = collapse();
    input.fluid_parameters.extrapolated_walls = extrapolated;
    input.fluid_parameters.activity.near_walls = true;
    const FluidTable near = water_after(input, 0.4);
    input.fluid_parameters.activity.near_walls = false;
    expect_same_bytes(near, water_after(input, 0.4));
  }
}

TEST(LeftOut, grains_away_from_water_change_nothing_for_it) {
  SimulationInput input = collapse();
  input.upper.z = 4.0;
  const FluidTable alone = water_after(input, 0.2);
  for (int k = 0; k < 20; ++k) {
    input.grains.position.push_back({0.1 + 0.05 * k, 0.0, 3.0});
    input.grains.diameter.push_back(0.02f);
    input.grains.density.push_back(2650.0f);
  }
  input.contact.youngs_modulus = 1.0e6;
  expect_same_bytes(alone, water_after(input, 0.2));
}

TEST(LeftOut, viscosity_with_an_unresolved_layer_moves_the_front_by_less_than_a_percent) {
  SimulationInput input = collapse();
  input.fluid_parameters.viscosity = sph::Viscosity::morris;
  const double end = 0.4;
  input.fluid_parameters.kinematic_viscosity =
      std::pow(0.2 * dp, 2.0) / end;  // the largest that counts as without effect
  for (std::size_t i = 0; i < input.boundary.position.size(); ++i) input.boundary.friction.push_back(1.0f);
  const double with = front(water_after(input, end));
  input.fluid_parameters.viscosity = sph::Viscosity::none;
  const double without = front(water_after(input, end));
  EXPECT_GT(with, 1.0) << "the water has run";
  EXPECT_NEAR(without, with, 0.01 * with);
}

}  // namespace
}  // namespace gdesp
