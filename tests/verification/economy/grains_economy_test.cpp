// SPDX-License-Identifier: GPL-3.0-or-later
// Grains fall into a tank and make a wave: how high it stands at the far wall, with the grains' own step or one step for all, and
// with a softer contact.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/tank.hpp"

namespace gdesp {
namespace {

constexpr double dp = 0.02, depth = 0.3, length = 1.2, d = 0.012;

TriangleTable floor_and_ends() {
  TriangleTable walls;
  const auto rectangle = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& e) {
    const auto base = static_cast<std::int32_t>(walls.vertex.size());
    walls.vertex.insert(walls.vertex.end(), {a, b, c, e});
    walls.triangle.push_back({base, base + 1, base + 2});
    walls.triangle.push_back({base, base + 2, base + 3});
    walls.body.insert(walls.body.end(), 2, 0);
  };
  const double y = 0.1, top = 1.0;
  rectangle({0, -y, 0}, {length, -y, 0}, {length, y, 0}, {0, y, 0});
  rectangle({0, -y, 0}, {0, y, 0}, {0, y, top}, {0, -y, top});
  rectangle({length, -y, 0}, {length, -y, top}, {length, y, top}, {length, y, 0});
  return walls;
}

/// In the plane: a block of discs, 10 wide and 8 high, just above the water beside the left wall.
SimulationInput plunge() {
  SimulationInput input = test::tank_input({length, 0.0, 0.8}, depth, dp, 2);
  input.fluid_parameters.h = 1.5 * dp;
  input.fluid_parameters.artificial_viscosity = 0.05;
  input.fluid_parameters.skin = 0.0;
  input.fluid_parameters.level = depth;
  test::fill_block(input.fluid, {0, 0, 0}, {length, 0, depth}, dp, true);
  for (int i = 0; i < 10; ++i)
    for (int k = 0; k < 8; ++k) {
      input.grains.position.push_back({(0.6 + 1.03 * i + 0.02 * (k % 3)) * d, 0.0, depth + 0.005 + (0.55 + 1.03 * k) * d});
      input.grains.diameter.push_back(static_cast<float>(d));
      input.grains.density.push_back(2650.0f);
    }
  input.walls = floor_and_ends();
  input.contact.youngs_modulus = 2.0e6;
  input.contact.friction = 0.4;
  return input;
}

struct Climb { double highest = 0.0, overlap = 0.0; std::int64_t substeps = 0, steps = 0; };

/// m: the highest rise of the mean level over the last 0.15 m before the far wall, until `end`.
Climb climb(const SimulationInput& input, double end) {
  auto simulation = make_simulation(input, "cpu");
  Climb result;
  constexpr double from = length - 0.15;
  constexpr int frames = 75;
  for (int k = 1; k <= frames; ++k) {
    simulation->advance_to(end * k / frames);
    double volume = 0.0;
    const FluidTable water = simulation->fluid();
    for (const Vec3d& r : water.position) volume += std::clamp((r.x - from) / dp + 0.5, 0.0, 1.0) * dp * dp;
    result.highest = std::max(result.highest, volume / (length - from) - depth);
    result.overlap = std::max(result.overlap, static_cast<double>(simulation->diagnostics().largest_overlap));
  }
  result.substeps = simulation->diagnostics().grain_substeps;
  result.steps = simulation->step_count();
  return result;
}

TEST(OwnStepOfGrains, leaves_the_climb_at_the_far_wall_within_a_percent) {
  SimulationInput input = plunge();
  const Climb own = climb(input, 1.2);
  input.time.multirate = false;
  const Climb one = climb(input, 1.2);
  EXPECT_GT(one.highest, 0.02);
  EXPECT_GT(one.steps, 2 * own.steps) << "the grains' step binds";
  EXPECT_NEAR(own.highest, one.highest, 0.01 * one.highest);
}

TEST(SofterContact, leaves_the_climb_at_the_far_wall_within_a_percent) {
  SimulationInput input = plunge();
  const Climb stiff = climb(input, 1.2);
  input.contact.youngs_modulus /= 5.0;
  const Climb soft = climb(input, 1.2);
  EXPECT_GT(stiff.highest, 0.02);
  EXPECT_LT(soft.substeps, 0.55 * static_cast<double>(stiff.substeps)) << "what it saves";
  EXPECT_GT(soft.overlap, 1.5 * stiff.overlap) << "what it costs";
  EXPECT_NEAR(soft.highest, stiff.highest, 0.01 * stiff.highest);
}

}  // namespace
}  // namespace gdesp
