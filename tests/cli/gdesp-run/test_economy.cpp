// SPDX-License-Identifier: GPL-3.0-or-later
// Scene analysis, step costs and targets.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "../../support/surfaces.hpp"
#include "../../support/tank.hpp"
#include "case_to_input.hpp"
#include "core/error.hpp"
#include "scene_economy.hpp"
#include "simulation/simulation.hpp"
#include "target.hpp"

namespace gdesp::tool {
namespace {

/// A channel of water 0 <= x <= 10, 1 m deep, dp 0.1, with grains over its left end.
SimulationInput channel() {
  SimulationInput in;
  in.fluid_parameters.dp = 0.1;
  in.fluid_parameters.h = 0.15;
  in.fluid_parameters.dimensions = 2;
  in.fluid_parameters.sound_speed = 40.0;
  for (int i = 0; i < 100; ++i)
    for (int k = 0; k < 10; ++k) in.fluid.position.push_back({0.1 * i + 0.05, 0.0, 0.1 * k + 0.05});
  for (int i = 0; i < 200; ++i) in.boundary.position.push_back({0.1 * i + 0.05, 0.0, -0.05});
  for (int i = 0; i < 10; ++i) {
    in.grains.position.push_back({0.05 * i, 0.0, 2.0});
    in.grains.diameter.push_back(0.05f);
    in.grains.density.push_back(2650.0f);
  }
  in.lower = {-1, -0.1, -1};
  in.upper = {21, 0.1, 3};
  return in;
}

TEST(WaveReach, grows_with_time_and_is_all_without_a_source) {
  SimulationInput in = channel();
  const double celerity = std::sqrt(9.81 * 1.0);
  const WaveReach some = wave_reach(in, 3.0 / celerity);  // 3 m beyond the grains, whose last is at 0.45 m
  EXPECT_NEAR(some.particles, 0.345, 0.011);
  EXPECT_NEAR(some.steps, (0.45 + 0.5 * 3.0) / 10.0, 0.011);
  EXPECT_NEAR(wave_reach(in, 100.0).particles, 1.0, 1e-12);
  in.grains = {};
  EXPECT_EQ(wave_reach(in, 0.1).particles, 1.0);
}

TEST(WallsBesideWater, counts_those_within_a_support) {
  const std::size_t n = walls_beside_water(channel());
  EXPECT_GE(n, 102u) << "under the water and one support (0.3 m) on";
  EXPECT_LE(n, 107u);
}

TEST(ContactSoftness, is_the_overlap_of_a_collision_and_says_what_keeps_it_small) {
  SimulationInput in = channel();
  in.fluid_parameters.dimensions = 3;
  const double v = 1.0, E = in.contact.youngs_modulus, nu = in.contact.poisson_ratio, R = 0.025;
  // Hertz (1881), two spheres: overlap = (15 m* v^2 / (16 E* sqrt(R*)))^(2/5).
  const double mass = 2650.0 * 4.0 / 3.0 * M_PI * R * R * R;
  const double overlap =
      std::pow(15.0 * 0.5 * mass * v * v / (16.0 * 0.5 * E / (1 - nu * nu) * std::sqrt(0.5 * R)), 0.4);
  const ContactSoftness c = contact_softness(in, 3.0 * v);
  EXPECT_NEAR(c.on_impact, overlap / (2 * R), 1e-3 * c.on_impact);
  in.contact.youngs_modulus = c.stiffness;
  const ContactSoftness kept = contact_softness(in, 3.0 * v);
  EXPECT_NEAR(std::max(kept.at_rest / 0.01, kept.on_impact / 0.05), 1.0, 0.01);
}

Scene tank_scene() {
  Scene s;
  s.dp = 0.1;
  Wall tank;
  tank.tank = Box{{0, 0, 0}, {4, 1, 2}};
  s.walls.push_back(tank);
  FluidFill fill;
  fill.kind = "box";
  fill.box = Box{{0, 0, 0}, {1, 1, 1}};
  s.fluid.fill.push_back(fill);
  return s;
}

TEST(NeedlessWidth, is_found_in_tanks_and_nowhere_else) {
  Scene s = tank_scene();
  EXPECT_EQ(needless_width(s), "dimensions");
  Slide slide;
  slide.shape.box = Box{{2, 0, 0}, {3, 1, 0.5}};
  s.slides.push_back(slide);
  EXPECT_EQ(needless_width(s), "periodic") << "spheres are no discs";
  s.slides[0].shape.box = Box{{2, 0.3, 0}, {3, 0.7, 0.5}};
  EXPECT_EQ(needless_width(s), "half");
  s.slides[0].shape.box = Box{{2, 0.3, 0}, {3, 0.9, 0.5}};
  EXPECT_EQ(needless_width(s), "");
  s = tank_scene();
  s.walls[0].condition = "no-slip";
  EXPECT_EQ(needless_width(s), "") << "the side walls matter";
  s = tank_scene();
  s.terrain.files = {"valley.asc"};
  EXPECT_EQ(needless_width(s), "");
}

/// A column in the middle of a tank, or half of it against a free-slip wall: the same front and the same height there.
TEST(NeedlessWidth, half_the_tank_gives_the_answer_of_the_whole) {
  const auto mean_place = [](bool whole) {
    constexpr double dp = 0.05;
    SimulationInput in;
    in.fluid_parameters.dp = dp;
    in.fluid_parameters.h = 1.5 * dp;
    in.fluid_parameters.sound_speed = 30.0;
    in.fluid_parameters.artificial_viscosity = 0.05;
    const int nx = 24, low = whole ? -12 : 0, ny = 12, nz = 12;
    in.lower = {-0.3, low * dp - 0.3, -0.3};
    in.upper = {nx * dp + 0.3, ny * dp + 0.3, 1.0};
    for (int i = -3; i < nx + 3; ++i)
      for (int j = low - 3; j < ny + 3; ++j)
        for (int k = -3; k < nz; ++k) {
          const Vec3d r{(i + 0.5) * dp, (j + 0.5) * dp, (k + 0.5) * dp};
          const bool inside = i >= 0 && i < nx && j >= low && j < ny && k >= 0;
          if (!inside)
            test::add_tank_wall(in.boundary, r, {0.0, low * dp, 0.0}, {nx * dp, ny * dp, 1.0});
          else if (r.x < 0.4 && r.z < 0.4 && std::abs(r.y) < 0.4)
            in.fluid.position.push_back(r);
        }
    auto simulation = make_simulation(in, "cpu");
    simulation->advance_to(0.3);
    Vec3d sum;
    const auto water = simulation->fluid();
    for (const Vec3d& r : water.position)
      sum += Vec3d{r.x, std::abs(r.y), r.z} * (1.0 / static_cast<double>(water.position.size()));
    return sum;
  };
  const Vec3d whole = mean_place(true), half = mean_place(false);
  EXPECT_GT(whole.x, 0.25) << "it has spread";
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(half[axis], whole[axis], 0.01 * whole[axis]);
}

TEST(ViscosityWithoutEffect, goes_by_its_layer) {
  Scene s = tank_scene();
  s.numerics.viscosity = "morris";
  s.fluid.kinematic_viscosity = 1.0e-6;
  s.time.end = 7.0;
  s.dp = 0.01818;
  EXPECT_TRUE(viscosity_is_without_effect(s));
  s.dp = 0.01;
  EXPECT_FALSE(viscosity_is_without_effect(s)) << "2.6 mm is more than 0.2 dp";
  s.dp = 0.01818;
  s.economy.viscosity = false;
  EXPECT_FALSE(viscosity_is_without_effect(s));
}

TEST(StepCosts, are_measured_and_add_up) {
  const StepCosts c = measure_step_costs(channel(), "cpu");
  EXPECT_GT(c.water, 1e-9);
  EXPECT_LT(c.water, 1e-4);
  EXPECT_GT(c.grain, 1e-10);
  EXPECT_GT(c.coupling, 0.0);
  EXPECT_NEAR(step_seconds(c, {10.0, 0.0, 2.0, 3.0}), 10.0 * c.water + 6.0 * c.grain + 2.0 * c.coupling, 1e-12);
}

TEST(StepCosts, grow_little_with_the_number_of_particles) {
  const double growth = growth_of_cost(channel(), "cpu", 1000.0, 4000.0);
  EXPECT_GT(growth, 0.3);
  EXPECT_LT(growth, 3.0);
}

TEST(DeviceCheck, one_device_agrees_with_itself_and_one_that_does_not_is_refused) {
  EXPECT_EQ(disagreement(channel(), "cpu"), 0.0);
  EXPECT_NO_THROW(refuse_disagreement(1.0e-5, "cuda:0"));
  for (const double apart : {0.01, std::nan("")}) {
    try {
      refuse_disagreement(apart, "cuda:0");
      ADD_FAILURE() << apart;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::resource);
      EXPECT_NE(std::string(error.what()).find("--device cpu"), std::string::npos);
    }
  }
}

TEST(Targets, are_read_with_their_units) {
  EXPECT_DOUBLE_EQ(parse_accuracy("5%"), 0.05);
  EXPECT_DOUBLE_EQ(parse_accuracy("0.02"), 0.02);
  EXPECT_DOUBLE_EQ(parse_duration("10min"), 600.0);
  EXPECT_DOUBLE_EQ(parse_duration("2h"), 7200.0);
  EXPECT_DOUBLE_EQ(parse_duration("90"), 90.0);
  for (const char* text : {"", "x", "-5%", "200%", "5 percent"}) EXPECT_THROW(parse_accuracy(text), Error) << text;
  for (const char* text : {"", "0", "-1h", "3 weeks"}) EXPECT_THROW(parse_duration(text), Error) << text;
}

/// Exact first-order runs: R = 2 - 0.5 dp, cost 1 s at dp 0.4 in three dimensions.
TEST(Targets, choose_the_dp_of_an_exact_first_order_method) {
  std::vector<Pilot> pilots;
  for (double dp : {0.8, 0.6, 0.4}) pilots.push_back({dp, 2.0 - 0.5 * dp, std::pow(0.4 / dp, 4)});
  EXPECT_NEAR(fit_run_up(pilots).limit, 2.0, 1e-12);
  const Choice by_accuracy = choose_dp(pilots, {0.05, 0.0}, 3);
  EXPECT_NEAR(by_accuracy.dp, 0.2, 1e-9) << "0.5 dp is 5 % of 2";
  EXPECT_NEAR(by_accuracy.seconds, 16.0, 1e-6);
  EXPECT_TRUE(by_accuracy.accuracy_met);
  const Choice by_budget = choose_dp(pilots, {0.0, 16.0}, 3);
  EXPECT_NEAR(by_budget.seconds, 16.0 - 1.0 - std::pow(2.0 / 3.0, 4) - 1.0 / 16.0, 1e-6) << "pilots are paid for too";
  const Choice both = choose_dp(pilots, {0.01, 16.0}, 3);
  EXPECT_FALSE(both.accuracy_met);
  EXPECT_NEAR(both.dp, by_budget.dp, 1e-12);
  const Choice coarse = choose_dp(pilots, {0.05, 1000.0}, 3);
  EXPECT_NEAR(coarse.dp, 0.2, 1e-9) << "no finer than needed";
  pilots[1].run_up += 0.3;
  EXPECT_THROW(choose_dp(pilots, {0.01, 0.0}, 3), Error) << "scatter";
}

/// A tank n spacings wide, without a lid, its walls three particles thick: n^3 of water and the layers of five faces, each 0.3 of water.
TEST(Targets, count_walls_with_the_power_of_a_surface) {
  const auto share = [](double n) { return 0.3 * 15.0 * n * n / (n * n * n + 0.3 * 15.0 * n * n); };
  const auto cost = [](double n) { return 1.0e-4 * n * (n * n * n + 0.3 * 15.0 * n * n); };  // steps with 1/dp
  std::vector<Pilot> pilots;
  for (double n : {8.0, 10.0, 14.0}) pilots.push_back({1.0 / n, 1.0 - 1.0 / n, cost(n), 2.0 * cost(n), share(n)});
  EXPECT_NEAR(predicted_seconds(pilots, 1.0 / 40.0, 3), cost(40.0), 1e-9 * cost(40.0));
  EXPECT_NEAR(dp_for_seconds(pilots, cost(40.0), 3), 1.0 / 40.0, 1e-9);
  pilots.back().growth = 0.1;
  EXPECT_NEAR(predicted_seconds(pilots, 1.0 / 28.0, 3), std::pow(8.0, 0.1) * cost(28.0), 1e-9 * cost(28.0))
      << "8 times as many";
  pilots.back().growth = 0.0;
  const Choice choice = choose_dp(pilots, {1.0 / 39.0, 0.0}, 3);
  EXPECT_NEAR(choice.seconds, cost(1.0 / choice.dp), 1e-6 * choice.seconds);
  EXPECT_NEAR(choice.processor_seconds, 2.0 * choice.seconds, 1e-9 * choice.seconds);
}

TEST(Targets, take_spacings_that_fit_the_walls) {
  Scene s = tank_scene();  // 4 m x 1 m, water 1 m deep
  s.walls[0].open = {"top"};
  EXPECT_NEAR(common_length(s), 1.0, 1e-12);
  s.walls[0].tank->upper.y = 0.6;
  EXPECT_NEAR(common_length(s), 0.2, 1e-12);
  s.dimensions = 2;
  EXPECT_NEAR(common_length(s), 1.0, 1e-12) << "no width in the plane";
  s.dp = 0.3;
  EXPECT_EQ(common_length(s), 0.0) << "its own spacing does not fit";
  s.walls.clear();
  EXPECT_EQ(common_length(s), 0.0);
  EXPECT_NEAR(finer_part(0.2, 0.06), 0.05, 1e-12);
  EXPECT_NEAR(coarser_part(0.2, 0.06), 0.2 / 3.0, 1e-12);
  EXPECT_NEAR(finer_part(0.2, 0.05), 0.05, 1e-12);
  EXPECT_EQ(finer_part(0.0, 0.06), 0.06) << "nothing to fit";
  EXPECT_EQ(coarser_part(0.1, 0.06), 0.06) << "its parts are too far apart";
}

TEST(Targets, pilots_leave_six_grains_across_a_period) {
  Scene s = tank_scene();
  s.dp = 0.1;
  s.domain.emplace();
  s.domain->lower = {0.0, 0.0, 0.0};
  s.domain->upper = {4.0, 0.6, 2.0};
  EXPECT_TRUE(std::isinf(coarsest_dp(s)));
  s.slides.emplace_back();
  s.slides[0].diameter = 0.05;
  EXPECT_TRUE(std::isinf(coarsest_dp(s))) << "no period";
  s.periodic = {"y"};
  EXPECT_NEAR(coarsest_dp(s), 0.2, 1e-12) << "grains of 0.1 m";
  s.slides[0].kind = "rigid";
  EXPECT_TRUE(std::isinf(coarsest_dp(s))) << "no grains";
}

TEST(Targets, are_never_coarser_than_the_coarsest_pilot) {
  std::vector<Pilot> pilots;
  for (double dp : {0.8, 0.6, 0.4}) pilots.push_back({dp, 2.0 - 0.5 * dp, std::pow(0.4 / dp, 4)});
  const Choice choice = choose_dp(pilots, {0.0, 1.0e-3}, 3);
  EXPECT_EQ(choice.dp, 0.8);
  EXPECT_NEAR(choice.seconds, std::pow(0.5, 4), 1e-9);
  EXPECT_NE(choice.reason.find("the budget pays for less"), std::string::npos) << choice.reason;
}

TEST(Targets, budget_takes_the_next_coarser_spacing_that_fits_and_accuracy_the_next_finer) {
  std::vector<Pilot> pilots;
  for (double dp : {0.8, 0.6, 0.4}) pilots.push_back({dp, 2.0 - 0.5 * dp, std::pow(0.4 / dp, 4)});
  EXPECT_NEAR(choose_dp(pilots, {0.05, 0.0}, 3, 0.7).dp, 0.175, 1e-9) << "0.2 is asked for";
  const Choice choice = choose_dp(pilots, {0.0, 1.0 + std::pow(2.0 / 3.0, 4) + 1.0 / 16.0 + 16.0}, 3, 0.7);
  EXPECT_NEAR(choice.dp, 0.7 / 3.0, 1e-9) << "0.2 is paid for";
  EXPECT_NEAR(choice.seconds, std::pow(0.4 / choice.dp, 4), 1e-9);
}

/// A column of grains collapses on a rough floor between rough walls: all of it, or half of it against a plane of symmetry. Where its
/// grains are in the mean, over some starts.
Vec3d heap(bool whole, bool smooth) {
  constexpr double d = 0.02, pitch = 1.05 * d;
  Vec3d sum;
  constexpr int starts = 10;
  for (int start = 0; start < starts; ++start) {
    SimulationInput in;
    in.fluid_parameters.dp = 0.02;
    in.lower = {-0.05, whole ? -0.25 : -0.05, -0.05};
    in.upper = {0.75, 0.25, 0.5};
    std::mt19937 random(7u + static_cast<unsigned>(start));
    std::uniform_real_distribution<double> jitter(-0.02 * d, 0.02 * d);
    const auto add = [&](const Vec3d& r) {
      in.grains.position.push_back(r);
      in.grains.diameter.push_back(static_cast<float>(d));
      in.grains.density.push_back(2500.0f);
    };
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 5; ++j)
        for (int k = 0; k < 10; ++k) {
          const Vec3d r{(i + 0.5) * pitch + jitter(random), (j + 0.5) * pitch + jitter(random),
                        (k + 0.5) * pitch + jitter(random)};
          add(r);
          if (whole) add({r.x, -r.y, r.z});
        }
    const double low = whole ? -0.15 : 0.0, high = 0.15, length = 0.7, top = 0.4;
    test::add_rectangle(in.walls, {0, low, 0}, {length, low, 0}, {length, high, 0}, {0, high, 0});
    test::add_rectangle(in.walls, {0, low, 0}, {0, high, 0}, {0, high, top}, {0, low, top});
    test::add_rectangle(in.walls, {0, high, 0}, {length, high, 0}, {length, high, top}, {0, high, top});
    in.walls.smooth.assign(in.walls.triangle.size(), 0);
    test::add_rectangle(in.walls, {0, low, 0}, {0, low, top}, {length, low, top}, {length, low, 0});
    in.walls.smooth.resize(in.walls.triangle.size(), smooth ? 1 : 0);
    in.walls.body.assign(in.walls.triangle.size(), 0);
    in.contact.youngs_modulus = 2.0e6;
    in.contact.friction = 0.5;
    auto simulation = make_simulation(in, "cpu");
    simulation->advance_to(0.4);
    const auto grains = simulation->grains();
    for (const Vec3d& r : grains.position)
      sum += Vec3d{r.x, std::abs(r.y), r.z} * (1.0 / static_cast<double>(starts * grains.position.size()));
  }
  return sum;
}

TEST(NeedlessWidth, half_a_heap_behind_a_plane_of_symmetry_lies_as_the_whole) {
  const Vec3d whole = heap(true, false), half = heap(false, true), held = heap(false, false);
  EXPECT_GT(whole.x, 0.1) << "it has spread";
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(half[axis], whole[axis], 0.01 * whole[axis]);
  EXPECT_LT(held.x, 0.97 * whole.x) << "a plane with friction holds it back";
}

}  // namespace
}  // namespace gdesp::tool
