// SPDX-License-Identifier: GPL-3.0-or-later
// Grains fall into a tank and make a wave: how high it stands at the far wall, with the grains' own step or one step for all, and
// with a softer contact.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "support/surfaces.hpp"
#include "support/tank.hpp"

namespace gdesp {
namespace {

constexpr double dp = 0.02, depth = 0.3, length = 1.2, d = 0.012;

TriangleTable floor_and_ends() {
  TriangleTable walls;
  const double y = 0.1, top = 1.0;
  test::add_rectangle(walls, {0, -y, 0}, {length, -y, 0}, {length, y, 0}, {0, y, 0});
  test::add_rectangle(walls, {0, -y, 0}, {0, y, 0}, {0, y, top}, {0, -y, top});
  test::add_rectangle(walls, {length, -y, 0}, {length, -y, top}, {length, y, top}, {length, y, 0});
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
      input.grains.position.push_back(
          {(0.6 + 1.03 * i + 0.02 * (k % 3)) * d, 0.0, depth + 0.005 + (0.55 + 1.03 * k) * d});
      input.grains.diameter.push_back(static_cast<float>(d));
      input.grains.density.push_back(2650.0f);
    }
  input.walls = floor_and_ends();
  input.contact.youngs_modulus = 2.0e6;
  input.contact.friction = 0.4;
  return input;
}

struct Climb {
  double highest = 0.0, overlap = 0.0;
  std::int64_t substeps = 0, steps = 0;
};

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

/// Splashing grains are chaotic: a start moved by a few thousandths of a diameter changes the climb by about 0.7 %. So means over starts
/// are compared, and their standard error is allowed for.
struct Climbs {
  double mean = 0.0, error_squared = 0.0, overlap = 0.0, substeps = 0.0, steps = 0.0;
};

Climbs climbs(const SimulationInput& input, int starts) {
  Climbs sum;
  double squares = 0.0;
  for (int k = 0; k < starts; ++k) {
    SimulationInput moved = input;
    for (Vec3d& r : moved.grains.position) r.x += 0.004 * k * d;
    const Climb one = climb(moved, 1.2);
    sum.mean += one.highest / starts;
    squares += one.highest * one.highest / starts;
    sum.overlap += one.overlap / starts;
    sum.substeps += static_cast<double>(one.substeps) / starts;
    sum.steps += static_cast<double>(one.steps) / starts;
  }
  sum.error_squared = (squares - sum.mean * sum.mean) / (starts - 1);
  return sum;
}

void expect_within_a_percent(const Climbs& economical, const Climbs& full) {
  const double spread = 2.0 * std::sqrt(economical.error_squared + full.error_squared);
  EXPECT_LT(spread, 0.02 * full.mean) << "else nothing is shown";
  EXPECT_NEAR(economical.mean, full.mean, 0.01 * full.mean + spread);
  std::printf("economical: %.5f m, full: %.5f m, twice the standard error %.5f m; overlaps %.3f and %.3f\n",
              economical.mean, full.mean, spread, economical.overlap, full.overlap);
}

TEST(OwnStepOfGrains, leaves_the_climb_at_the_far_wall_within_a_percent) {
  SimulationInput input = plunge();
  const Climbs own = climbs(input, 4);
  input.time.multirate = false;
  const Climbs one = climbs(input, 4);
  EXPECT_GT(one.mean, 0.02);
  EXPECT_GT(one.steps, 2.0 * own.steps) << "the grains' step binds";
  expect_within_a_percent(own, one);
}

TEST(SofterContact, leaves_the_climb_at_the_far_wall_within_a_percent) {
  SimulationInput input = plunge();
  const Climbs stiff = climbs(input, 10);
  input.contact.youngs_modulus /= 2.0;
  const Climbs soft = climbs(input, 10);
  EXPECT_GT(stiff.mean, 0.02);
  EXPECT_LT(soft.substeps, 0.8 * stiff.substeps) << "what it saves";
  EXPECT_GT(soft.overlap, 1.1 * stiff.overlap) << "what it costs";
  expect_within_a_percent(soft, stiff);
}

}  // namespace
}  // namespace gdesp
