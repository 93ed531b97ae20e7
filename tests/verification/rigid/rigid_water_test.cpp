// SPDX-License-Identifier: GPL-3.0-or-later
// Free bodies in water: momentum of the pair, draught, light bodies, threads, checkpoints, bodies among grains.
#include <gtest/gtest.h>

#include <sstream>

#include "../../support/tank.hpp"
#include "exec/parallel.hpp"
#include "rigid_scene.hpp"

namespace gdesp::test {
namespace {

constexpr double dp = 0.01;

/// Adds a free box [lo, hi] (two dimensions), with its wall particles on the lattice of the water.
void add_floating(SimulationInput& input, const Vec3d& lo, const Vec3d& hi, double density) {
  const auto number = static_cast<std::int32_t>(input.bodies.size() + 1);
  input.boundary.body.resize(input.boundary.position.size(), 0);
  const int nx = static_cast<int>(std::lround((hi.x - lo.x) / dp)),
            nz = static_cast<int>(std::lround((hi.z - lo.z) / dp));
  for (int i = 0; i < nx; ++i) {
    for (int k = 0; k < nz; ++k) {
      if (std::min({i, k, nx - 1 - i, nz - 1 - k}) >= 3) continue;
      input.boundary.position.push_back({lo.x + (i + 0.5) * dp, 0.0, lo.z + (k + 0.5) * dp});
      input.boundary.body.push_back(number);
      const int left = i, right = nx - 1 - i, below = k, above = nz - 1 - k,
                least = std::min({left, right, below, above});
      const Vec3f normal = least == below   ? Vec3f{0, 0, -1}
                           : least == above ? Vec3f{0, 0, 1}
                                            : Vec3f{least == left ? -1.0f : 1.0f, 0, 0};
      input.boundary.normal.push_back(normal);
      input.boundary.depth.push_back(static_cast<float>((least + 0.5) * dp));
    }
  }
  add_box(input.walls, number, {lo.x, -0.5, lo.z}, {hi.x, 0.5, hi.z});
  input.bodies.push_back(box_body({lo.x, -0.5, lo.z}, {hi.x, 0.5, hi.z}, density));
}

/// A lattice of water in [lo, hi] without what the box takes.
void fill_around(FluidTable& fluid, const Vec3d& lo, const Vec3d& hi, const Vec3d& box_lo, const Vec3d& box_hi) {
  FluidTable all;
  fill_block(all, lo, hi, dp, true);
  for (const Vec3d& r : all.position) {
    if (r.x > box_lo.x && r.x < box_hi.x && r.z > box_lo.z && r.z < box_hi.z) continue;
    fluid.position.push_back(r);
  }
}

/// A box of 0.2 m x 0.1 m that sinks to `draught` in a tank of 0.6 m x 0.3 m.
SimulationInput floating_box(double density, double draught) {
  SimulationInput input = tank_input({0.6, 0, 0.4}, 0.3, dp, 2);
  input.fluid_parameters.h = 1.5 * dp;
  input.fluid_parameters.artificial_viscosity = 0.1;
  const Vec3d lo{0.2, 0, 0.3 - draught}, hi{0.4, 0, 0.4 - draught};
  add_floating(input, lo, hi, density);
  fill_around(input.fluid, {}, {0.6, 0, 0.3}, lo, hi);
  return input;
}

/// Water in space without weight, met by a box.
SimulationInput free_jet() {
  SimulationInput input = tank_input({1.0, 0, 1.0}, 0.3, dp, 2);
  input.boundary = {};
  input.fluid_parameters.gravity = {};
  input.fluid_parameters.h = 1.5 * dp;
  add_floating(input, {0.2, 0, 0.4}, {0.3, 0, 0.5}, 600.0);
  input.bodies[0].velocity = {1.5, 0, 0.2};
  fill_block(input.fluid, {0.32, 0, 0.38}, {0.56, 0, 0.62}, dp, true);
  input.fluid.density.assign(input.fluid.position.size(), 1000.0f);
  return input;
}

// Momentum of body and water together, nothing else there. @eq sph.body-load
TEST(RigidWater, MomentumOfBodyAndWaterIsClosed) {
  for (const TimeScheme scheme : {TimeScheme::split, TimeScheme::verlet}) {
    SimulationInput input = free_jet();
    input.time.scheme = scheme;
    const auto run = make_simulation(input, "cpu");
    const Diagnostics start = run->diagnostics();
    run->advance_to(0.08);
    const Diagnostics end = run->diagnostics();
    const Vec3d before = start.body_momentum + start.fluid_momentum, after = end.body_momentum + end.fluid_momentum;
    EXPECT_LT(end.body_momentum.x, 0.9 * start.body_momentum.x);  // they have met
    EXPECT_LT(norm(after - before), 1e-5 * norm(before));
    const double energy = end.body_kinetic + end.fluid_kinetic + end.fluid_elastic;
    EXPECT_LT(energy, start.body_kinetic * 1.001);
  }
}

// Draught over height is the density ratio (Archimedes); a box wider than sqrt(6 s (1 - s)) times its height is upright.
TEST(RigidWater, BoxFloatsAtItsDraught) {
  struct Row {
    double ratio, start;
  };
  for (const Row& row : {Row{0.3, 0.05}, Row{0.6, 0.05}}) {
    SimulationInput input = floating_box(1000.0 * row.ratio, row.start);
    const auto run = make_simulation(input, "cpu");
    run->advance_to(2.0);
    double level = 0.0, draught = 0.0;
    int samples = 0;
    for (int k = 1; k <= 20; ++k, ++samples) {
      run->advance_to(2.0 + 0.05 * k);
      // Volume is conserved: with the box at draught d the level is (water + 0.2 d)/0.6.
      const double bottom = run->bodies()[0].centre.z - 0.05;
      const double water = static_cast<double>(input.fluid.position.size()) * dp * dp;
      level = (water - 0.2 * bottom) / 0.4;
      draught += level - bottom;
    }
    EXPECT_NEAR(draught / samples / 0.1, row.ratio, 0.02) << row.ratio;
    EXPECT_LT(std::abs(run->bodies()[0].angular_velocity.y), 0.2);
  }
}

// A tenth of the water's density, let go at the bottom: it comes up, and does not blow up.
TEST(RigidWater, LightBodyIsStable) {
  const auto run = make_simulation(floating_box(100.0, 0.2), "cpu");
  double fastest = 0.0;
  for (int k = 1; k <= 30; ++k) {
    run->advance_to(0.02 * k);
    fastest = std::max(fastest, run->diagnostics().largest_body_speed);
  }
  EXPECT_GT(run->bodies()[0].centre.z, 0.25);
  EXPECT_LT(fastest, 2.5);
  EXPECT_EQ(run->diagnostics().lost_fluid, 0);
}

std::string state_of(Simulation& run) {
  std::ostringstream out;
  run.save(out);
  return out.str();
}

TEST(RigidWater, SameResultForAnyNumberOfThreads) {
  FluidTable fluid[2];
  BodyPose body[2];
  for (const int threads : {1, 2}) {
    exec::set_threads(threads);
    const auto run = make_simulation(floating_box(400.0, 0.05), "cpu");
    run->advance_to(0.05);
    fluid[threads - 1] = run->fluid();
    body[threads - 1] = run->bodies()[0];
  }
  exec::set_threads(1);
  EXPECT_TRUE(body[0].centre == body[1].centre);
  EXPECT_TRUE(body[0].velocity == body[1].velocity);
  EXPECT_TRUE(body[0].angular_velocity == body[1].angular_velocity);
  EXPECT_TRUE(body[0].force == body[1].force);
  EXPECT_TRUE(fluid[0].position == fluid[1].position);
  EXPECT_TRUE(fluid[0].velocity == fluid[1].velocity);
  EXPECT_TRUE(fluid[0].density == fluid[1].density);
}

/// A block on the floor of a tank, with a slanted nose (1 : 2), pushed at 1 m/s through 0.1 m of water.
SimulationInput sliding_wedge() {
  SimulationInput input = tank_input({1.0, 0, 0.3}, 0.1, dp, 2);
  input.fluid_parameters.h = 1.5 * dp;
  input.fluid_parameters.artificial_viscosity = 0.05;
  const double nose = 0.35, height = 0.05;
  const Vec3d slant{1.0 / std::sqrt(5.0), 0.0, 2.0 / std::sqrt(5.0)};
  FluidTable all;
  fill_block(all, {}, {1.0, 0, 0.1}, dp, true);
  input.boundary.body.resize(input.boundary.position.size(), 0);
  for (const Vec3d& r : all.position) {
    const double to_slant = -dot(r - Vec3d{nose, 0, 0}, slant), to_top = height - r.z;
    const double depth = std::min({to_slant, to_top, r.z});
    if (depth <= 0.0) {
      input.fluid.position.push_back(r);
    } else if (depth < 3.0 * dp) {
      input.boundary.position.push_back(r);
      input.boundary.normal.push_back(depth == to_slant ? static_cast<Vec3f>(slant)
                                                        : Vec3f{0, 0, depth == to_top ? 1.0f : -1.0f});
      input.boundary.depth.push_back(static_cast<float>(depth));
      input.boundary.body.push_back(1);
    }
  }
  Body body;
  body.motion = {{0.0, 0.3}, {{}, {0.3, 0, 0}}, -1.0};
  input.bodies = {body};
  return input;
}

// Water under the nose is pushed away or under the block, but never through the floor (it went, where normals of both walls cancelled).
TEST(RigidWater, a_sliding_block_pushes_no_water_through_the_floor) {
  const auto run = make_simulation(sliding_wedge(), "cpu");
  run->advance_to(0.3);
  double lowest = 1.0;
  for (const Vec3d& r : run->fluid().position) lowest = std::min(lowest, r.z);
  EXPECT_GT(lowest, -0.2 * dp);
  EXPECT_EQ(run->diagnostics().lost_fluid, 0);
}

/// A box that falls on a layer of grains.
SimulationInput box_on_grains() {
  SimulationInput input = floating_box(800.0, 0.05);
  input.boundary = {};
  input.fluid = {};
  input.bodies.clear();
  input.walls = {};
  add_floor(input.walls, -1.0, 2.0, 0.0);
  add_box(input.walls, 1, {0.2, -0.5, 0.03}, {0.4, 0.5, 0.13});
  input.bodies.push_back(box_body({0.2, -0.5, 0.03}, {0.4, 0.5, 0.13}, 800.0));
  for (int i = 0; i < 10; ++i) {
    input.grains.position.push_back({0.21 + 0.02 * i, 0.0, 0.01});
    input.grains.diameter.push_back(0.0195f);
    input.grains.density.push_back(2500.0f);
  }
  return input;
}

TEST(RigidWater, GoesOnBitForBitFromACheckpoint) {
  for (const bool dry : {false, true}) {
    const SimulationInput input = dry ? box_on_grains() : floating_box(400.0, 0.05);
    const auto whole = make_simulation(input, "cpu");
    whole->advance_to(0.1);
    const std::string half = state_of(*whole);
    whole->advance_to(0.2);
    const auto resumed = make_simulation(input, "cpu");
    std::istringstream in(half);
    resumed->load(in);
    resumed->advance_to(0.2);
    EXPECT_TRUE(state_of(*whole) == state_of(*resumed)) << dry;
  }
}

// The weight of the box goes through the grains to the floor.
TEST(RigidGrains, ABoxComesToRestOnGrains) {
  SimulationInput input = box_on_grains();
  input.contact.restitution = 0.3;
  const auto run = make_simulation(input, "cpu");
  run->advance_to(1.0);
  const BodyPose box = run->bodies()[0];
  EXPECT_LT(norm(box.velocity), 5e-3);
  EXPECT_NEAR(box.centre.z, 0.05 + 0.0195, 4e-4);
  EXPECT_NEAR(box.force.z / (800.0 * 0.02 * 9.81), 1.0, 0.02);
  EXPECT_LT(run->diagnostics().largest_overlap, 0.02f);
}

}  // namespace
}  // namespace gdesp::test
