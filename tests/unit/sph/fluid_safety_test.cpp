// SPDX-License-Identifier: GPL-3.0-or-later
// What the guard of a run asks of the water, and of a simulation that it makes more careful.
#include <gtest/gtest.h>

#include <sstream>

#include "support/tank.hpp"

namespace gdesp {
namespace {

SimulationInput small_tank() {
  SimulationInput input = test::tank_input({0.2, 0.0, 0.2}, 0.1, 0.01, 2);
  test::fill_block(input.fluid, {0, 0, 0}, {0.2, 0, 0.1}, 0.01, true);
  return input;
}

std::unique_ptr<Simulation> start(const SimulationInput& input) { return make_simulation(input, "cpu"); }

std::string state_of(Simulation& simulation) {
  std::ostringstream out;
  simulation.save(out);
  return out.str();
}

TEST(FluidSafety, another_sound_speed_leaves_every_pressure_as_it_is) {
  const auto simulation = start(small_tank());
  for (int k = 0; k < 50; ++k) simulation->step(1.0);
  const FluidTable before = simulation->fluid();
  const double c = simulation->sound_speed();
  simulation->set_caution(1.0, 1.5 * c);
  EXPECT_DOUBLE_EQ(simulation->sound_speed(), 1.5 * c);
  simulation->step(1.0);
  const FluidTable after = simulation->fluid();
  float largest = 0.0f;
  for (const float p : before.pressure) largest = std::max(largest, p);
  EXPECT_GT(largest, 500.0f);
  for (std::size_t i = 0; i < before.pressure.size(); ++i)
    EXPECT_NEAR(after.pressure[i], before.pressure[i], 0.02f * largest) << i;  // one step later
  const double half = simulation->last_time_step();
  simulation->set_caution(0.5, simulation->sound_speed());
  simulation->step(1.0);
  EXPECT_NEAR(simulation->last_time_step(), 0.5 * half, 0.01 * half);
}

TEST(FluidSafety, caution_of_one_changes_no_bit) {
  const auto one = start(small_tank()), other = start(small_tank());
  for (int k = 0; k < 40; ++k) {
    one->step(1.0);
    other->set_caution(1.0, other->sound_speed());
    other->step(1.0);
  }
  EXPECT_EQ(state_of(*one), state_of(*other));
}

TEST(FluidSafety, caution_survives_a_checkpoint) {
  const auto one = start(small_tank()), other = start(small_tank());
  for (int k = 0; k < 5; ++k) one->step(1.0);
  one->set_caution(0.25, 2.0 * one->sound_speed());
  for (int k = 0; k < 5; ++k) one->step(1.0);
  std::istringstream in(state_of(*one));
  other->load(in);
  EXPECT_EQ(one->sound_speed(), other->sound_speed());
  for (int k = 0; k < 20; ++k) {
    one->step(1.0);
    other->step(1.0);
  }
  EXPECT_EQ(state_of(*one), state_of(*other));
}

TEST(FluidSafety, who_is_deepest_inside_a_wall) {
  SimulationInput input = small_tank();
  input.fluid.velocity.assign(input.fluid.position.size(), Vec3f{});
  const auto sound = start(input);
  sound->step(1.0);
  EXPECT_EQ(sound->diagnostics().deepest_in_wall, 0.0);
  input.fluid.position[3] = {0.105, 0.0, -0.006};  // below the bottom
  const auto simulation = start(input);
  simulation->step(1e-6);
  const Diagnostics d = simulation->diagnostics();
  EXPECT_EQ(d.deepest_in_wall_id, 3u);
  EXPECT_NEAR(d.deepest_in_wall, 0.6, 0.1);
}

}  // namespace
}  // namespace gdesp
