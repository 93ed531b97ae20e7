// SPDX-License-Identifier: GPL-3.0-or-later
// A lake of particles with columns behind its wall: at rest, momentum, a wave that goes there and comes back, checkpoints.
#include "lake_with_columns.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "core/error.hpp"
#include "exec/parallel.hpp"

namespace gdesp::test {
namespace {

constexpr double g = 9.81, density = 1000.0;

LakeScene with_columns(double particles, double columns) {
  LakeScene scene;
  scene.particles = particles;
  scene.columns = columns;
  return scene;
}

// For 23 sqrt(H/g): the wall stays where it is to 1 % of the depth, a tenth of a spacing (`verlet`: a fifth, it finds another place to rest),
// and the columns' level to 0.5 %.
TEST(FarLakeBehindParticles, stays_at_rest) {
  for (const TimeScheme scheme : {TimeScheme::split, TimeScheme::verlet}) {
    const LakeScene scene = with_columns(3.0, 6.0);
    SimulationInput input = lake(scene);
    input.time.scheme = scheme;
    const auto run = make_simulation(input, "cpu");
    double farthest = 0.0, highest = 0.0;
    for (double t = 0.1; t < 4.05; t += 0.1) {
      run->advance_to(t);
      farthest = std::max(farthest, std::abs(run->bodies()[0].centre.x));
      highest = std::max(highest, run->diagnostics().far_lake_highest);
    }
    EXPECT_GT(farthest, 0.0);
    EXPECT_LT(farthest, (scheme == TimeScheme::split ? 0.01 : 0.022) * scene.depth);
    EXPECT_LT(highest, 0.005);
    const FarLakeTable surface = run->far_lakes()[0];
    EXPECT_NEAR(surface.level.back(), scene.depth, 0.005 * scene.depth);
  }
}

/// Water around x = 1 m moves at the start (m/s).
void add_push(SimulationInput& input, double speed) {
  for (const Vec3d& r : input.fluid.position)
    input.fluid.velocity.push_back({static_cast<float>(speed * std::exp(-std::pow((r.x - 1.0) / 0.3, 2))), 0.0f, 0.0f});
}

// What the water's force gives, the columns have, but for the constants of the settling and of the far wall: the same mean in two intervals.
TEST(FarLakeBehindParticles, takes_the_momentum_that_the_water_gives) {
  for (const double side : {1.0, -1.0}) {
    const LakeScene scene = with_columns(2.1, 9.0);
    SimulationInput input;
    if (side > 0.0) {
      input = lake(scene);
    } else {
      input = lake(with_columns(2.1, 0.0), true);
      add_far_lake(input, scene, 0.0, -1.0);
    }
    add_push(input, 0.2 * side);
    const auto run = make_simulation(input, "cpu");
    run->advance_to(0.4);
    constexpr double interval = 0.3;
    double rest[2], change[2];
    for (int k = 0; k < 2; ++k) {
      const double before = run->diagnostics().far_lake_momentum, end = run->time() + interval;
      double impulse = 0.0;
      while (run->time() < end) {
        const double now = run->time();
        run->step(end);
        impulse += (run->time() - now) * run->bodies()[0].force.x;
      }
      change[k] = run->diagnostics().far_lake_momentum - before;
      rest[k] = (impulse - change[k]) / interval;
    }
    const double rest_force = 0.5 * density * g * scene.depth * scene.depth;
    EXPECT_GT(std::abs(change[0] - change[1]), 0.1);  // N s: something has happened
    EXPECT_NEAR(rest[0], rest[1], 1e-6 * rest_force);
    EXPECT_NEAR(side * rest[0], rest_force, 0.15 * rest_force);
  }
}

/// Largest flux through x = 4 m to the right and later to the left, over the wave's speed (m), and when half of the wave had passed (s).
struct Passage {
  double height = 0.0, height_back = 0.0, arrival = 0.0, arrival_back = 0.0, energy_rise = 0.0;
};

Passage passage(const LakeScene& scene, const SolitaryWave& wave) {
  constexpr double x = 4.0, interval = 0.04;
  constexpr int frames = 200, half_window = 3;
  SimulationInput input = lake(scene);
  add_solitary_wave(input, wave, 2.0);
  const auto run = make_simulation(input, "cpu");
  std::vector<double> passed, energy;
  for (int k = 0; k <= frames; ++k) {
    run->advance_to(k * interval);
    passed.push_back(volume_beyond(run->fluid(), x, scene.dp));
    const Diagnostics d = run->diagnostics();
    energy.push_back(d.fluid_kinetic + d.fluid_potential + d.fluid_elastic + d.far_lake_kinetic + d.far_lake_potential);
  }
  Passage p;
  const double half = passed.front() + 0.5 * wave.volume();
  for (std::size_t k = half_window; k + half_window < passed.size(); ++k) {
    const double flux =
        (passed[k + half_window] - passed[k - half_window]) / (2 * half_window * interval * wave.speed());
    p.height = std::max(p.height, flux);
    p.height_back = std::max(p.height_back, -flux);
    const auto time = [&] {
      return interval * (static_cast<double>(k) - (passed[k] - half) / (passed[k] - passed[k - 1]));
    };
    if (p.arrival == 0.0 && passed[k] >= half) p.arrival = time();
    if (p.arrival > 0.0 && p.arrival_back == 0.0 && passed[k] < half) p.arrival_back = time();
    p.energy_rise =
        std::max(p.energy_rise,
                 energy[k] - *std::min_element(energy.begin(), energy.begin() + static_cast<std::ptrdiff_t>(k) + 1));
  }
  return p;
}

// A solitary wave of a tenth of the depth runs from 2 m to the wall at 9 m and back to 4 m, once all in particles, once with columns from 6 m
// on. Particles damp it, columns do not: it comes back up to 10 % higher than among particles alone, and never higher than it went; it
// arrives within 2 %. Both bands were set after the first results (+6 %, +1.2 %; with half the spacing +2 %, +1.3 %).
TEST(FarLakeBehindParticles, lets_a_solitary_wave_in_and_out) {
  const SolitaryWave wave{0.3, 0.03, g};
  LakeScene all;
  all.particles = 9.0;
  const Passage particles = passage(all, wave), columns = passage(with_columns(6.0, 3.0), wave);
  EXPECT_NEAR(columns.height, wave.height, 0.05 * wave.height);
  EXPECT_NEAR(columns.height, particles.height, 0.02 * wave.height);
  EXPECT_GT(columns.height_back, particles.height_back * 0.98);
  EXPECT_LT(columns.height_back, particles.height_back * 1.10);
  EXPECT_LT(columns.height_back, columns.height);
  EXPECT_NEAR(columns.arrival, particles.arrival, 0.02);
  EXPECT_NEAR(columns.arrival_back, particles.arrival_back, 0.02 * particles.arrival_back);
  // The wave has about rho g a volume/1.5; the books of particles and columns close to a fifth of that, as the wall's force lacks some
  // percent of what the water's energy loses by its motion (FarLake, settling).
  EXPECT_LT(columns.energy_rise, 0.2 * density * g * wave.height * wave.volume() / 1.5);
}

TEST(FarLakeBehindParticles, gives_the_same_bytes_with_any_number_of_threads_and_from_a_checkpoint) {
  const LakeScene scene = with_columns(2.1, 3.0);
  const auto input = [&] {
    SimulationInput in = lake(scene);
    add_push(in, 0.4);
    return in;
  };
  std::vector<FarLakeTable> results;
  std::vector<double> places;
  for (const int threads : {1, 3}) {
    exec::set_threads(threads);
    const auto run = make_simulation(input(), "cpu");
    run->advance_to(0.1);  // while the wall is still held
    std::stringstream early, late;
    run->save(early);
    run->advance_to(0.6);
    run->save(late);
    run->advance_to(0.8);
    results.push_back(run->far_lakes()[0]);
    places.push_back(run->bodies()[0].centre.x);
    for (std::stringstream* state : {&early, &late}) {
      const auto resumed = make_simulation(input(), "cpu");
      resumed->load(*state);
      resumed->advance_to(0.6);
      resumed->advance_to(0.8);
      results.push_back(resumed->far_lakes()[0]);
      places.push_back(resumed->bodies()[0].centre.x);
    }
  }
  EXPECT_NE(places[0], 0.0);
  for (std::size_t k = 1; k < results.size(); ++k) {
    EXPECT_EQ(places[k], places[0]);
    EXPECT_EQ(results[k].level, results[0].level);
    EXPECT_EQ(results[k].velocity, results[0].velocity);
  }
}

TEST(FarLakeBehindParticles, says_when_the_water_has_another_depth) {
  LakeScene scene = with_columns(1.5, 3.0);
  SimulationInput input = lake(scene);
  input.bodies[0].far_lake.depth = 0.4;
  const auto run = make_simulation(input, "cpu");
  try {
    run->advance_to(1.0);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_NE(std::string(error.what()).find("far_lake.depth"), std::string::npos);
  }
}

// Three dimensions: the same wall, 0.3 m wide, in a slab that repeats along y.
TEST(FarLakeBehindParticles, stays_at_rest_in_space) {
  const double dp = 0.03, depth = 0.3, width = 0.3, length = 0.9, room = 0.45;
  SimulationInput input = tank_input({length, width, 2.0 * depth}, depth, dp, 3);
  input.boundary = {};
  wall_tank(input.boundary, {0, 0, 0}, {length + room, width, 2.0 * depth}, dp, false);
  input.upper.x = length + room + 5 * dp;
  input.fluid_parameters.h = 1.5 * dp;
  input.fluid_parameters.artificial_viscosity = 0.05;
  input.fluid_parameters.skin = 0.0;
  fill_block(input.fluid, {0, 0, 0}, {length, width, depth}, dp, false);
  input.boundary.body.assign(input.boundary.position.size(), 0);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 10; ++j)
      for (int k = 0; k < 20; ++k) {
        input.boundary.position.push_back({length + (i + 0.5) * dp, (j + 0.5) * dp, (k + 0.5) * dp});
        input.boundary.normal.push_back({-1.0f, 0.0f, 0.0f});
        input.boundary.depth.push_back(static_cast<float>((i + 0.5) * dp));
      }
  input.boundary.body.resize(input.boundary.position.size(), 1);
  Body body;
  body.kind = BodyKind::far_lake;
  body.far_lake = {3.0, depth, width, 50, 1.0, length, depth};
  input.bodies = {body};
  const auto run = make_simulation(input, "cpu");
  run->advance_to(1.0);
  EXPECT_LT(std::abs(run->bodies()[0].centre.x), 0.015 * depth);
  EXPECT_NEAR(run->diagnostics().far_lake_mass, density * 3.0 * depth * width, 1e-9);
  // What presses the foot of the wall through the floor's particles under it counts for the floor, about one spacing of the depth: at 8, 10,
  // 15, 20 rows the force is 12.2, 10.2, 6.8, 5.3 % too small. (The bound was 10 % at 10 rows while it was 9.9 %, before decision 0053.)
  const double thrust = 0.5 * density * g * width * depth * depth;
  EXPECT_NEAR(run->bodies()[0].force.x, thrust, 1.2 * dp / depth * thrust);
}

}  // namespace
}  // namespace gdesp::test
