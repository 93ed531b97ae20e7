// SPDX-License-Identifier: GPL-3.0-or-later
// Water that sleeps: it keeps its state, and a wave that runs into it is the wave of water that is always awake.
#include <gtest/gtest.h>

#include <sstream>

#include "exec/backend.hpp"
#include "support/tank.hpp"

namespace gdesp {
namespace {

constexpr double depth = 0.3, g = 9.81, dp = 0.03;

SimulationInput lake(double length, bool sleep) {
  SimulationInput input = test::tank_input({length, 0.0, 0.6}, depth, dp, 2);
  input.fluid_parameters.h = 1.5 * dp;
  input.fluid_parameters.artificial_viscosity = 0.05;
  input.fluid_parameters.skin = 0.0;
  test::fill_block(input.fluid, {0, 0, 0}, {length, 0, depth}, dp, true);
  input.fluid_parameters.activity.sleep = sleep;
  input.fluid_parameters.activity.rest_time = 5.0 * std::sqrt(depth / g);
  return input;
}

/// Puts a solitary wave of height a depth/10 on the lake, its crest at x = 2 m, moving to the right (Boussinesq 1872).
SimulationInput with_solitary_wave(SimulationInput input) {
  const double a = 0.1 * depth, k = std::sqrt(0.75 * a / (depth * depth * depth)), c = std::sqrt(g * (depth + a));
  for (Vec3d& r : input.fluid.position) {
    const double shape = 1.0 / std::pow(std::cosh(k * (r.x - 2.0)), 2.0), eta = a * shape;
    r.z *= 1.0 + eta / depth;
    const double u = c * eta / (depth + eta);
    input.fluid.mass_share.push_back(static_cast<float>(1.0 + eta / depth));
    input.fluid.velocity.push_back(
        {static_cast<float>(u), 0.0f, static_cast<float>(r.z * u * 2.0 * k * std::tanh(k * (r.x - 2.0)))});
  }
  return input;
}

TEST(SleepingWater, stays_as_it_is_to_the_last_bit) {
  auto simulation = make_simulation(lake(2.0, true), "cpu");
  const FluidTable before = simulation->fluid();
  simulation->advance_to(0.5);
  const FluidTable after = simulation->fluid();
  for (std::size_t i = 0; i < before.position.size(); ++i) {
    ASSERT_EQ(before.position[i], after.position[i]);
    ASSERT_EQ(after.velocity[i], Vec3f{});
    ASSERT_EQ(before.density[i], after.density[i]);
    ASSERT_NEAR(static_cast<double>(after.pressure[i]), 1000.0 * g * (depth - after.position[i].z),
                0.001 * 1000.0 * g * depth);
  }
  EXPECT_EQ(simulation->diagnostics().awake_share, 0.0);
}

/// m3/m of water that has passed x, and the time (s) at which half of it had: the wave's size and arrival.
struct Passage {
  double volume = 0.0, arrival = 0.0, awake = 0.0;
};
Passage passage(const SimulationInput& input, double x, double end) {
  auto simulation = make_simulation(input, "cpu");
  std::vector<double> beyond;
  Passage p;
  constexpr int frames = 60;
  for (int k = 0; k <= frames; ++k) {
    simulation->advance_to(end * k / frames);
    const FluidTable water = simulation->fluid();
    double volume = 0.0;
    for (std::size_t i = 0; i < water.position.size(); ++i)  // a particle counts by the part of it that has passed
      volume += std::clamp((water.position[i].x - x) / dp + 0.5, 0.0, 1.0) * static_cast<double>(water.mass_share[i]) *
                dp * dp;
    beyond.push_back(volume);
    p.awake += simulation->diagnostics().awake_share / (frames + 1);
  }
  p.volume = beyond.back() - beyond.front();
  const double half = beyond.front() + 0.5 * p.volume;
  for (std::size_t k = 1; k < beyond.size() && p.arrival == 0.0; ++k)
    if (beyond[k] >= half)
      p.arrival = end * (static_cast<double>(k) - (beyond[k] - half) / (beyond[k] - beyond[k - 1])) / frames;
  return p;
}

TEST(SleepingWater, lets_a_solitary_wave_pass_as_water_that_is_awake_does) {
  const double x = 6.0, end = 3.2;  // the crest runs from 2 m to 7.9 m: thirteen depths of sleeping water up to x
  const Passage awake = passage(with_solitary_wave(lake(12.0, false)), x, end);
  const Passage sleeping = passage(with_solitary_wave(lake(12.0, true)), x, end);
  const double wave = 4.0 * depth * depth / std::sqrt(3.0) * std::sqrt(0.1);  // its volume, Boussinesq
  EXPECT_NEAR(awake.volume, wave, 0.15 * wave);
  EXPECT_NEAR(sleeping.arrival, awake.arrival, 0.01 * awake.arrival);
  EXPECT_NEAR(sleeping.volume, awake.volume, 0.01 * awake.volume);
  EXPECT_LT(sleeping.awake, 0.75);
}

TEST(SleepingWater, gives_the_same_bytes_with_any_number_of_threads_and_from_a_checkpoint) {
  std::vector<FluidTable> results;
  for (int threads : {1, 3}) {
    exec::set_threads(threads);
    auto simulation = make_simulation(with_solitary_wave(lake(9.0, true)), "cpu");
    simulation->advance_to(0.2);
    std::stringstream state;
    simulation->save(state);
    simulation->advance_to(0.4);
    results.push_back(simulation->fluid());
    auto resumed = make_simulation(with_solitary_wave(lake(9.0, true)), "cpu");
    resumed->load(state);
    resumed->advance_to(0.4);
    results.push_back(resumed->fluid());
    EXPECT_GT(simulation->diagnostics().awake_share, 0.2);
    EXPECT_LT(simulation->diagnostics().awake_share, 0.9);
  }
  for (const FluidTable& result : results)
    for (std::size_t i = 0; i < result.position.size(); ++i) {
      ASSERT_EQ(result.position[i], results[0].position[i]);
      ASSERT_EQ(result.velocity[i], results[0].velocity[i]);
      ASSERT_EQ(result.density[i], results[0].density[i]);
    }
}

}  // namespace
}  // namespace gdesp
