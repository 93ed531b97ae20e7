// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of gdesp-run that can be looked at alone.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "../../support/temp_folder.hpp"
#include "case_to_input.hpp"
#include "checkpoint_files.hpp"
#include "core/error.hpp"
#include "frame_output.hpp"
#include "guard.hpp"
#include "moving_surfaces.hpp"
#include "output_times.hpp"
#include "run_files.hpp"
#include "scene_economy.hpp"
#include "scene_summary.hpp"

namespace gdesp::tool {
namespace {

Case lake_with_slide() {
  Case c;
  c.scene.dp = 1.0;
  c.scene.numerics.smoothing_ratio = 1.4;
  c.domain = {{0, 0, 0}, {100, 10, 100}};
  c.still_water_level = 20.0;
  for (int k = 0; k < 20; ++k) c.fluid.position.push_back({50.0, 5.0, k + 0.5});
  c.boundary.position = {{50, 5, -0.5}, {50, 5, -1.5}};
  Slide slide;
  slide.release_at = 0.5;
  slide.real_diameter = 0.1;
  c.scene.slides.push_back(slide);
  c.grains.position = {{10, 5, 60}, {10, 5, 80}};
  c.grains.diameter = {1.0f, 1.0f};
  c.grains.density = {2650.0f, 2650.0f};
  return c;
}

TEST(OutputTimes, whole_intervals_and_the_end) {
  const OutputTimes times{0.1, 0.35};
  EXPECT_DOUBLE_EQ(times.next(0.0), 0.1);
  EXPECT_DOUBLE_EQ(times.next(times.next(times.next(0.0))), 0.3);
  EXPECT_EQ(times.next(0.3), 0.35);
  EXPECT_EQ(times.next(0.1 + 0.2), 0.35) << "0.30000000000000004 is 0.3";
  EXPECT_EQ((OutputTimes{0.1, 0.3}.next(0.2)), 0.3) << "no sliver before the end";
}

TEST(CaseToInput, expected_speed_is_the_largest_of_water_and_slide) {
  Case c = lake_with_slide();
  const double slide = 0.7 * std::sqrt(2 * 9.81 * 50.0), water = std::sqrt(2 * 9.81 * 20.0);
  EXPECT_NEAR(expected_speed(c).speed, slide, 1e-9);
  EXPECT_EQ(expected_speed(c).source, "fall of the slide");
  c.grains = {};
  EXPECT_NEAR(expected_speed(c).speed, water, 1e-9);
  c.fluid.velocity.assign(20, Vec3f{0, 0, -40.0f});
  EXPECT_NEAR(expected_speed(c).speed, 40.0, 1e-6);
  c.scene.numerics.expected_speed = 3.0;
  EXPECT_EQ(expected_speed(c).speed, 3.0);
}

TEST(CaseToInput, no_slide_is_expected_faster_than_any_seen) {
  Case c = lake_with_slide();
  for (Vec3d& r : c.grains.position) r.z += 5000.0;
  EXPECT_NEAR(expected_speed(c).speed, 70.0, 1e-9);
}

TEST(CaseToInput, pistons_count_and_gates_do_not) {
  Case c = lake_with_slide();
  c.grains = {};
  Body body;
  body.name = "plate";
  body.motion.time = {0.0, 1.0, 1.5};
  body.motion.displacement = {{0, 0, 0}, {0, 0, 10}, {0, 0, 40}};
  c.bodies.push_back(body);
  EXPECT_NEAR(expected_speed(c).speed, 60.0, 1e-9);
  MovingBody gate;
  gate.name = "plate";
  c.scene.moving.push_back(gate);
  EXPECT_LT(expected_speed(c).speed, 20.0);
}

TEST(CaseToInput, a_stiffness_that_is_left_open_keeps_overlaps_small) {
  Case c = lake_with_slide();
  EXPECT_EQ(c.scene.contact.youngs_modulus, 0.0) << "by default";
  const double speed = expected_speed(c).speed;
  SimulationInput in = case_to_input(c);
  const ContactSoftness chosen = contact_softness(in, speed);
  EXPECT_NEAR(std::max(chosen.at_rest / 0.01, chosen.on_impact / 0.05), 1.0, 1e-6);
  EXPECT_NEAR(chosen.stiffness, in.contact.youngs_modulus, 1e-6 * chosen.stiffness);
  c = lake_with_slide();
  c.scene.contact.youngs_modulus = 3.0e6;
  EXPECT_EQ(case_to_input(c).contact.youngs_modulus, 3.0e6) << "as asked";
  c = lake_with_slide();
  c.grains = {};
  EXPECT_EQ(case_to_input(c).contact.youngs_modulus, 1.0e7) << "bodies alone";
}

TEST(CaseToInput, every_parameter_arrives) {
  Case c = lake_with_slide();
  c.scene.gravity = {0, 0, -5};
  c.scene.periodic = {"y"};
  c.scene.numerics.preset = "paper";
  c.scene.numerics.time_scheme = "verlet";
  c.scene.numerics.walls = "dynamic";
  c.scene.numerics.viscosity = "morris";
  c.scene.economy.viscosity = false;
  c.scene.numerics.sound_speed = 123.0;
  c.scene.numerics.cfl = 0.3;
  c.scene.numerics.time_step = 0.01;
  c.scene.numerics.multirate = false;
  c.scene.contact.law = "linear";
  c.scene.contact.friction = 0.37;
  c.scene.coupling.drag = "ergun-wen-yu";
  c.scene.coupling.added_mass = 0.25;
  const SimulationInput in = case_to_input(c);
  EXPECT_DOUBLE_EQ(in.fluid_parameters.h, 1.4);
  EXPECT_EQ(in.fluid_parameters.sound_speed, 123.0);
  EXPECT_EQ(in.fluid_parameters.gravity.z, -5.0);
  EXPECT_EQ(in.fluid_parameters.viscosity, sph::Viscosity::morris);
  EXPECT_TRUE(in.fluid_parameters.paper_form);
  EXPECT_FALSE(in.fluid_parameters.extrapolated_walls);
  EXPECT_EQ(in.fluid_parameters.level, 20.0);
  EXPECT_EQ(in.time.scheme, TimeScheme::verlet);
  EXPECT_EQ(in.time.cfl, 0.3);
  EXPECT_EQ(in.time.fixed_step, 0.01);
  EXPECT_FALSE(in.time.multirate);
  EXPECT_EQ(in.contact.law, dem::ContactLawKind::linear);
  EXPECT_EQ(in.contact.friction, 0.37);
  EXPECT_EQ(in.coupling.drag, coupling::Drag::ergun_wen_yu);
  EXPECT_EQ(in.coupling.added_mass, 0.25);
  EXPECT_EQ(in.coupling.real_diameter, std::vector<double>{0.1});
  EXPECT_EQ(in.release_time, std::vector<double>{0.5});
  EXPECT_TRUE(in.periodic[1]);
  EXPECT_EQ(in.fluid.position.size(), 20u);
}

TEST(CaseToInput, domain_holds_the_walls_but_keeps_the_period) {
  Case c = lake_with_slide();
  c.scene.periodic = {"y"};
  c.boundary.position.push_back({50, -3, 5});
  const SimulationInput in = case_to_input(c);
  EXPECT_DOUBLE_EQ(in.lower.z, -2.5);
  EXPECT_EQ(in.upper.z, 100.0);
  EXPECT_EQ(in.lower.y, 0.0);
  EXPECT_EQ(in.upper.y, 10.0);
}

TEST(SceneSummary, says_what_is_on_and_why_not) {
  Case c = lake_with_slide();
  const ExpectedSpeed expected = expected_speed(c);
  SimulationInput in = case_to_input(c);
  SceneSummary s = summarize(c.scene, in, expected, "cpu", 2);
  EXPECT_EQ(s.moving_particles, 22u);
  EXPECT_EQ(s.json["models"]["coupling"]["on"], true);
  EXPECT_NEAR(s.time_step, 0.5 * 1.4 / (11.0 * expected.speed), 1e-3 * s.time_step);
  in.coupling.enabled = false;
  s = summarize(c.scene, in, expected, "cpu", 2);
  EXPECT_EQ(s.json["models"]["coupling"]["on"], false);
  EXPECT_EQ(s.json["models"]["coupling"]["what"], "coupling.enabled = false");
}

TEST(SceneSummary, too_little_memory_names_the_dp_that_fits) {
  SceneSummary s;
  Scene scene;
  scene.dp = 1.0;
  const auto refused = [&](const std::string& device, double free) {
    s.memory = 8.0 * free;
    try {
      check_memory(s, scene, device, free);
    } catch (const Error& problem) {
      EXPECT_EQ(problem.kind(), ErrorKind::resource);
      return std::string(problem.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(refused("cpu", available_memory("cpu")).find("resolution.dp = 2.0"), std::string::npos);
  EXPECT_EQ(
      refused("cuda:0", 78.0 * 1073741824.0),
      "the case needs about 624 GiB of memory, cuda:0 has 78 GiB free; resolution.dp = 2.04 m would fit (now 1 m)");
  s.memory = 1e9;
  EXPECT_NO_THROW(check_memory(s, scene, "cuda:0", 1.1e9));
}

TEST(MovingSurfaces, prescribed_bodies_by_displacement_removed_ones_not_at_all) {
  TriangleTable walls;
  walls.vertex = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}, {6, 5, 5}, {5, 6, 5}};
  walls.triangle = {{0, 1, 2}, {3, 4, 5}};
  walls.body = {0, 1};
  Body gate;
  gate.motion.time = {0.0, 2.0};
  gate.motion.displacement = {{0, 0, 0}, {0, 0, 4}};
  gate.motion.remove_at = 1.5;
  const TriangleTable moved = moving_surfaces(walls, {gate}, {BodyPose{}}, 1.0);
  ASSERT_EQ(moved.triangle.size(), 1u);
  ASSERT_EQ(moved.vertex.size(), 3u);
  EXPECT_EQ(moved.vertex[0], (Vec3d{5, 5, 7}));
  EXPECT_TRUE(moving_surfaces(walls, {gate}, {BodyPose{}}, 1.5).triangle.empty());
}

TEST(MovingSurfaces, free_bodies_turn_about_their_centre) {
  TriangleTable walls;
  walls.vertex = {{2, 0, 0}, {1, 1, 0}, {1, 0, 1}};
  walls.triangle = {{0, 1, 2}};
  walls.body = {1};
  Body block;
  block.kind = BodyKind::free;
  block.centre = {1, 0, 0};
  BodyPose pose;
  pose.centre = {10, 0, 0};
  const double quarter_about_z[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  std::copy(std::begin(quarter_about_z), std::end(quarter_about_z), std::begin(pose.rotation));
  const TriangleTable moved = moving_surfaces(walls, {block}, {pose}, 0.0);
  EXPECT_EQ(moved.vertex[0], (Vec3d{10, 1, 0}));
  const auto states = body_states({block}, {pose}, 0.0);
  EXPECT_EQ(states[0].centre, (Vec3d{10, 0, 0}));
  EXPECT_NEAR(states[0].orientation[0], std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(states[0].orientation[3], std::sqrt(0.5), 1e-15);
}

TEST(MovingSurfaces, quaternion_gives_the_rotation_back) {
  Body block;
  block.kind = BodyKind::free;
  for (int k = 0; k < 12; ++k) {
    const double a = 3.14159 * (k % 4 == 3 ? 1.0 : 0.3 * k), s = std::sin(0.5 * a), w = std::cos(0.5 * a);
    Vec3d n{1.0 * (k % 3), 1.0 * (k % 2), 0.5 + k};
    n *= s / norm(n);
    BodyPose pose;
    const double r[9] = {
        1 - 2 * (n.y * n.y + n.z * n.z), 2 * (n.x * n.y - w * n.z),       2 * (n.x * n.z + w * n.y),
        2 * (n.x * n.y + w * n.z),       1 - 2 * (n.x * n.x + n.z * n.z), 2 * (n.y * n.z - w * n.x),
        2 * (n.x * n.z - w * n.y),       2 * (n.y * n.z + w * n.x),       1 - 2 * (n.x * n.x + n.y * n.y)};
    std::copy(std::begin(r), std::end(r), std::begin(pose.rotation));
    const BodyState state = body_states({block}, {pose}, 0.0)[0];
    const double* q = state.orientation;
    const double same = w * q[0] + n.x * q[1] + n.y * q[2] + n.z * q[3];
    EXPECT_NEAR(std::abs(same), 1.0, 1e-12) << k;
  }
}

TEST(FrameOutput, frames_arrive_in_order_and_trouble_comes_back) {
  const test::TempFolder folder;
  std::vector<std::int64_t> seen;
  const auto frame = [](int k) {
    Frame f;
    f.time = k;
    f.step = k;
    f.fluid.position = {{0, 0, 0}};
    return f;
  };
  {
    FrameOutput output(FrameWriter(folder / "a.run", {}, 1.0, false, false),
                       [&](const FramePaths& p) { seen.push_back(p.step); });
    for (int k = 0; k < 5; ++k) output.push(frame(k));
    output.drain();
    EXPECT_EQ(seen, (std::vector<std::int64_t>{0, 1, 2, 3, 4}));
    std::filesystem::remove_all(folder / "a.run");
    output.push(frame(5));
    EXPECT_THROW(output.drain(), Error);
    EXPECT_THROW(output.push(frame(6)), Error);
    EXPECT_THROW(output.check(), Error);
  }
  EXPECT_EQ(seen.size(), 5u);
}

TEST(DiagnosticsLog, goes_on_after_the_step_given_and_drops_torn_lines) {
  const test::TempFolder folder;
  Diagnostics d;
  {
    DiagnosticsLog log(folder.path(), -1);
    for (d.step = 0; d.step <= 30; d.step += 10) log.add(d);
    log.add(d = Diagnostics{});  // an earlier step once more
  }
  std::ofstream(folder / "log.ndjson", std::ios::app) << "{\"t\":0.1,\"st";
  {
    DiagnosticsLog log(folder.path(), 20);
    d.step = 25;
    log.add(d);
  }
  const std::string text = test::text_of_file(folder / "log.ndjson");
  std::vector<int> steps;
  for (std::size_t at = text.find("\"step\":"); at != std::string::npos; at = text.find("\"step\":", at + 1))
    steps.push_back(std::atoi(text.c_str() + at + 7));
  EXPECT_EQ(steps, (std::vector<int>{0, 10, 20, 25}));
  EXPECT_EQ(text.back(), '\n');
}

TEST(Checksum, any_flipped_bit_and_any_exchange_shows) {
  std::string bytes(1000, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 37 % 251);
  const auto sum = [](const std::string& text) {
    Checksum c;
    c.add(text.data(), text.size());
    return c.value();
  };
  const std::uint64_t sound = sum(bytes);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string flipped = bytes;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    ASSERT_NE(sum(flipped), sound) << bit;
  }
  EXPECT_NE(sum(bytes.substr(8, 8) + bytes.substr(0, 8) + bytes.substr(16)), sound);
  EXPECT_NE(sum(bytes.substr(0, 992)), sound);
}

TEST(Guard, warns_once_and_knows_trouble) {
  Guard guard;
  std::vector<std::string> said;
  const auto warn = [&](const std::string& text) { said.push_back(text); };
  Diagnostics d;
  d.step = 7;
  d.fluid_particles = 1;
  EXPECT_FALSE(guard.look(d, warn));
  EXPECT_TRUE(said.empty());
  d.mach = 0.3;
  d.lost_grains = 2;
  EXPECT_FALSE(guard.look(d, warn));
  EXPECT_FALSE(guard.look(d, warn));
  ASSERT_EQ(said.size(), 2u);
  EXPECT_NE(said[0].find("step 7"), std::string::npos);
  const auto cause = [&](double Diagnostics::*member, double value) {
    Diagnostics bad = d;
    bad.*member = value;
    const std::optional<Trouble> trouble = guard.look(bad, warn);
    EXPECT_TRUE(trouble) << value;
    return trouble ? trouble->cause : Trouble::Cause::all_lost;
  };
  EXPECT_EQ(cause(&Diagnostics::mach, 1.5), Trouble::Cause::mach);
  EXPECT_EQ(cause(&Diagnostics::mach, std::nan("")), Trouble::Cause::mach);
  EXPECT_EQ(cause(&Diagnostics::largest_density_error, 0.6), Trouble::Cause::density);
  EXPECT_EQ(cause(&Diagnostics::largest_overlap, 0.4), Trouble::Cause::overlap);
  EXPECT_EQ(cause(&Diagnostics::deepest_in_wall, 3.0), Trouble::Cause::in_wall);
  d.fluid_particles = 0;
  EXPECT_EQ(guard.look(d, warn)->cause, Trouble::Cause::all_lost);
}

TEST(Guard, energy_may_change_its_kind_but_not_come_from_nowhere) {
  GuardSetup setup;
  setup.watches_energy = true;
  setup.spacing_energy = 0.1;
  Guard guard(setup);
  const auto warn = [](const std::string&) {};
  Diagnostics d;
  d.fluid_particles = 100;
  d.fluid_mass = 10.0;
  const auto look = [&](double potential, double kinetic) {
    d.fluid_potential = potential;
    d.fluid_kinetic = kinetic;
    d.step += 100;
    return guard.look(d, warn);
  };
  EXPECT_FALSE(look(-500.0, 0.0)) << "energies of position may have either sign";
  EXPECT_FALSE(look(-560.0, 55.0)) << "it falls";
  EXPECT_FALSE(look(-530.0, 20.0)) << "it climbs again";
  EXPECT_FALSE(look(-520.0, 60.0)) << "once may be a rebound";
  const auto trouble = look(-520.0, 60.0);
  ASSERT_TRUE(trouble) << "45 J of 61 J that there were to spend";
  EXPECT_EQ(trouble->cause, Trouble::Cause::energy);
  d.lost_fluid = 1;
  EXPECT_FALSE(look(-520.0, 40.0)) << "what has left takes its own along: reckoned anew";
}

}  // namespace
}  // namespace gdesp::tool
