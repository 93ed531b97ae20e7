// SPDX-License-Identifier: GPL-3.0-or-later
// The loop over grains: lists against brute force, conservation, threads, re-sorting, checkpoints, drag.
#include <gtest/gtest.h>
#include <omp.h>

#include "../../support/state_of.hpp"
#include "core/error.hpp"
#include "dem/grain_motion.hpp"
#include "grain_scene.hpp"

namespace gdesp::dem::test {
namespace {

struct OneThread : ::testing::Test {
  OneThread() { exec::set_threads(1); }
};
using GrainSystemTest = OneThread;

ContactParameters soft(double restitution = 0.5, double friction = 0.5) {
  ContactParameters p;
  p.youngs_modulus = 1.0e6;
  p.restitution = restitution;
  p.friction = friction;
  return p;
}

// Grains of 8 to 24 mm at random places of a box, also across block borders (blocks of 0.32 m).
GrainTable random_grains(int count, const Vec3d& low, const Vec3d& high, std::uint64_t seed, double speed) {
  Random random(seed);
  GrainTable table;
  for (int i = 0; i < count; ++i) {
    const auto in = [&](double a, double b) { return a + (b - a) * random(); };
    const Vec3d p{in(low.x, high.x), in(low.y, high.y), in(low.z, high.z)};
    const Vec3d v{in(-speed, speed), in(-speed, speed), in(-speed, speed)};
    const Vec3d w{in(-10, 10), in(-10, 10), in(-10, 10)};
    add_grain(table, p, 0.008 + 0.016 * random(), 2000.0 + 1000.0 * random(), v, speed > 0.0 ? w : Vec3d{});
  }
  return table;
}

int touching_pairs(const GrainTable& t, const Vec3d& period) {
  int pairs = 0;
  for (std::size_t i = 0; i < t.position.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      Vec3d r = t.position[i] - t.position[j];
      for (int axis = 0; axis < 3; ++axis) {
        if (period[axis] > 0.0) r[axis] -= period[axis] * std::round(r[axis] / period[axis]);
      }
      pairs += norm(r) < 0.5 * (static_cast<double>(t.diameter[i]) + t.diameter[j]) ? 1 : 0;
    }
  }
  return pairs;
}

TEST_F(GrainSystemTest, FindsTheContactsOfBruteForce) {
  const GrainTable table = random_grains(1500, {0.2, 0.2, 0.2}, {0.6, 0.6, 0.6}, 7, 0.0);
  Grains grains({}, space({0, 0, 0}, {1, 1, 1}, 0.005), table, soft(), {}, {});
  const int expected = touching_pairs(table, {});
  EXPECT_GT(expected, 300);
  EXPECT_EQ(grains.sums().contacts, expected);
}

TEST_F(GrainSystemTest, FindsContactsAcrossPeriodsOfOneAndOfTwoBlocks) {
  const bool periodic[3] = {true, true, false};
  for (double spacing : {0.0125, 0.00625}) {
    const Domain domain = make_domain({0, 0, 0}, {0.8, 0.8, 0.8}, spacing, periodic, 3);
    const GrainTable table = random_grains(800, {0, 0, 0.3}, {0.8, 0.8, 0.5}, 11, 0.0);
    Grains grains({}, domain, table, soft(), {}, {});
    EXPECT_EQ(grains.sums().contacts, touching_pairs(table, {0.8, 0.8, 0.0}));
  }
}

// One large grain among small ones has hundreds of neighbours: its rows are many, its contacts exact.
TEST_F(GrainSystemTest, FindsTheManyContactsOfALargeGrain) {
  Random random(4);
  GrainTable table;
  add_grain(table, {0.3, 0.3, 0.3}, 0.04, 2500);
  for (int i = 0; i < 3000; ++i) {
    add_grain(table, {0.26 + 0.08 * random(), 0.26 + 0.08 * random(), 0.26 + 0.08 * random()}, 0.004, 2500);
  }
  Grains grains({}, space({0, 0, 0}, {1, 1, 1}, 0.005), table, soft(), {}, {});
  EXPECT_EQ(grains.sums().contacts, touching_pairs(table, {}));
  Grains same({}, space({0, 0, 0}, {1, 1, 1}, 0.005), table, soft(), {}, {});
  grains.advance(1.0e-5, 3);
  same.advance(1.0e-5, 3);
  EXPECT_TRUE(state_of(grains) == state_of(same));
}

TEST_F(GrainSystemTest, ListsHoldWhileGrainsMove) {
  Grains grains({}, space({0, 0, 0}, {1, 1, 1}, 0.005), random_grains(600, {0.3, 0.3, 0.3}, {0.6, 0.6, 0.6}, 5, 2.0),
                soft(), {}, {});
  int compared = 0;
  for (int k = 0; k < 30; ++k) {
    grains.advance(1.0e-4, 4);
    const GrainTable now = grains.table();
    EXPECT_EQ(grains.sums().contacts, touching_pairs(now, {})) << "after " << k;
    ++compared;
  }
  EXPECT_GT(grains.rebuilds(), 5);
  EXPECT_LT(grains.rebuilds(), 100);
  EXPECT_EQ(compared, 30);
}

TEST_F(GrainSystemTest, NoneOneAndCoincidentGrains) {
  Grains none({}, space({0, 0, 0}, {1, 1, 1}, 0.01), {}, soft(), floor_mesh(0, 1, 0, 1, 0, 0.5), {0, 0, -9.81});
  none.advance(0.01, 3);
  EXPECT_EQ(none.sums().particles, 0);
  GrainTable pair;
  add_grain(pair, {0.5, 0.5, 0.5}, 0.02, 2500);
  add_grain(pair, {0.5, 0.5, 0.5}, 0.02, 2500);
  Grains coincident({}, space({0, 0, 0}, {1, 1, 1}, 0.01), pair, soft(), {}, {});
  coincident.advance(1.0e-4, 1);
  EXPECT_TRUE(std::isfinite(coincident.sums().kinetic_energy));
}

TEST_F(GrainSystemTest, FreeFallIsExact) {
  GrainTable table;
  add_grain(table, {0.5, 0.5, 0.9}, 0.02, 2500, {0.3, 0, 0});
  Grains grains({}, space({0, 0, 0}, {1, 1, 1}, 0.01), table, soft(), {}, {0, 0, -9.81});
  grains.advance(0.2, 100);
  const GrainTable end = grains.table();
  EXPECT_NEAR(end.position[0].z, 0.9 - 0.5 * 9.81 * 0.04, 5e-7);
  EXPECT_NEAR(end.position[0].x, 0.56, 1e-8);
  EXPECT_NEAR(end.velocity[0].z, -9.81 * 0.2, 1e-5);
}

// A velocity far below one unit of position a step must still move the grain.
TEST_F(GrainSystemTest, SlowGrainsAreNotFrozen) {
  GrainTable table;
  add_grain(table, {0.5, 0.5, 0.5}, 0.02, 2500, {1.0e-6, 0, 0});
  Grains grains({}, space({0, 0, 0}, {1, 1, 1}, 0.01), table, soft(), {}, {});
  grains.advance(0.1, 10000);
  EXPECT_NEAR(grains.table().position[0].x - 0.5, 1.0e-7, 2.0e-10);
}

// @eq dem.motion.leapfrog
TEST_F(GrainSystemTest, MomentumIsKeptToRoundOff) {
  const GrainTable start = random_grains(600, {0.3, 0.3, 0.3}, {0.55, 0.55, 0.55}, 3, 1.0);
  ContactParameters p = soft(0.4, 0.5);
  p.rolling_friction = 0.1;
  Grains grains({}, space({0, 0, 0}, {1, 1, 1}, 0.005), start, p, {}, {});
  const auto spin_of = [](const GrainTable& t) {
    Vec3d sum{};
    for (std::size_t i = 0; i < t.position.size(); ++i) {
      const double m = grain_mass_of(t, i), r = 0.5 * t.diameter[i];
      sum += cross(t.position[i] - Vec3d{0.4, 0.4, 0.4}, m * Vec3d(t.velocity[i])) +
             (0.4 * m * r * r) * Vec3d(t.angular_velocity[i]);
    }
    return sum;
  };
  const GrainSums before = grains.sums();
  const Vec3d angular = spin_of(grains.table());
  grains.advance(0.02, 200);
  const GrainSums after = grains.sums();
  double scale = 0.0, angular_scale = 0.0;
  for (std::size_t i = 0; i < start.position.size(); ++i) {
    scale += grain_mass_of(start, i) * norm(Vec3d(start.velocity[i]));
    angular_scale += grain_mass_of(start, i) * 0.1 * norm(Vec3d(start.velocity[i]));
  }
  EXPECT_LT(norm(after.momentum - before.momentum), 1.0e-7 * scale);
  EXPECT_LT(norm(spin_of(grains.table()) - angular), 2.0e-3 * angular_scale);
  EXPECT_LT(after.kinetic_energy + after.elastic_energy, 0.9 * (before.kinetic_energy + before.elastic_energy));
}

TEST_F(GrainSystemTest, EnergyNeverGrows) {
  for (double restitution : {0.05, 0.5, 1.0}) {
    for (double friction : {0.0, 0.5}) {
      Grains grains({}, space({0, 0, 0}, {0.4, 0.4, 0.4}, 0.01),
                    random_grains(150, {0.05, 0.05, 0.05}, {0.35, 0.35, 0.35}, 21, 1.0), soft(restitution, friction),
                    tank({0.03, 0.03, 0.03}, {0.37, 0.37, 0.37}), {});
      grains.advance(0.05, 500);  // lets the random overlaps go
      const GrainSums begin = grains.sums();
      double last = begin.kinetic_energy + begin.elastic_energy;
      const double first = last;
      for (int k = 0; k < 10; ++k) {
        grains.advance(0.02, 400);
        const GrainSums s = grains.sums();
        const double now = s.kinetic_energy + s.elastic_energy;
        // Energy in wall contacts is not counted, so an instant may be low; it may not exceed the first.
        EXPECT_LT(now, first * 1.005) << "restitution " << restitution << " friction " << friction;
        last = now;
      }
      if (restitution == 1.0 && friction == 0.0) {
        EXPECT_GT(last, 0.97 * first);
      } else if (restitution < 1.0) {
        EXPECT_LT(last, 0.8 * first);
      }
      EXPECT_EQ(grains.lost(), 0);
    }
  }
}

// Deep overlaps, strong damping, the default step: the stiffest modes of a bed that turns against itself (dem.damping.limit).
TEST_F(GrainSystemTest, ASoftBedComesToRestAtTheDefaultStep) {
  for (double restitution : {0.2, 0.5}) {
    Random random(3);
    GrainTable table;
    for (int k = 0; k < 24; ++k) {
      for (int cell = 0; cell < 25; ++cell) {
        const auto off = [&] { return 0.0004 * (2.0 * random() - 1.0); };
        add_grain(
            table,
            {0.0058 + 0.0116 * (cell % 5) + off(), 0.0058 + 0.0116 * (cell / 5) + off(), 0.0058 + 0.0116 * k + off()},
            0.01, 2500.0);
      }
    }
    ContactParameters p = soft(restitution, 0.4);
    p.youngs_modulus = 2.0e6;
    Grains grains({}, space({-0.01, -0.01, -0.01}, {0.07, 0.07, 0.4}, 0.01), table, p,
                  tank({0, 0, 0}, {0.058, 0.058, 0.39}), {0, 0, -9.81});
    const double step = grains.stable_time_step(0.2), end = 1.2;
    grains.advance(end, static_cast<int>(std::ceil(end / step)));
    const GrainSums s = grains.sums();
    EXPECT_LT(std::sqrt(2.0 * s.kinetic_energy / s.mass), 0.001) << "restitution " << restitution;  // m/s, spin counted
  }
}

Grains heap(const ContactParameters& p) {
  return Grains({}, space({0, 0, 0}, {0.5, 0.5, 0.5}, 0.01),
                random_grains(300, {0.12, 0.12, 0.02}, {0.3, 0.3, 0.3}, 17, 0.3), p,
                tank({0.1, 0.1, 0.0}, {0.32, 0.32, 0.5}), {0, 0, -9.81});
}

TEST_F(GrainSystemTest, SameBytesWithOneAndTwoThreads) {
  ContactParameters p = soft();
  p.rolling_friction = 0.05;
  std::string bytes[2];
  for (int threads : {1, 2}) {
    exec::set_threads(threads);
    Grains grains = heap(p);
    grains.advance(0.1, 500);
    bytes[threads - 1] = state_of(grains);
  }
  exec::set_threads(1);
  EXPECT_TRUE(bytes[0] == bytes[1]);
  EXPECT_GT(bytes[0].size(), 100000u);
}

TEST_F(GrainSystemTest, HistorySurvivesSorting) {
  ContactParameters p = soft();
  p.rolling_friction = 0.05;
  Grains often = heap(p), seldom = heap(p);
  often.advance(0.15, 900);
  seldom.advance(0.15, 900);
  for (int k = 0; k < 20; ++k) {
    often.sort_grains();
    often.advance(0.001, 6);
    seldom.advance(0.001, 6);
  }
  EXPECT_GT(often.rebuilds(), seldom.rebuilds() + 5);
  const GrainTable a = often.table(), b = seldom.table();
  double largest = 0.0;
  for (std::size_t i = 0; i < a.position.size(); ++i) largest = std::max(largest, norm(a.position[i] - b.position[i]));
  // Lost histories would let grains slip by about mu F/S_t, some 1e-5 m here.
  EXPECT_LT(largest, 2.0e-7);
}

TEST_F(GrainSystemTest, CheckpointGoesOnBitForBit) {
  ContactParameters p = soft();
  p.rolling_friction = 0.05;
  Grains one = heap(p), other = heap(p);
  one.advance(0.1, 517);
  const std::string bytes = state_of(one);
  load_state(other, bytes);
  EXPECT_TRUE(state_of(other) == bytes);
  one.advance(0.05, 300);
  other.advance(0.05, 300);
  EXPECT_TRUE(state_of(one) == state_of(other));
  EXPECT_GT(one.rebuilds(), 10);
}

TEST_F(GrainSystemTest, BrokenCheckpointIsRefused) {
  Grains grains = heap(soft());
  std::string bytes = state_of(grains);
  bytes.resize(bytes.size() / 2);
  EXPECT_THROW(load_state(grains, bytes), Error);
  EXPECT_THROW(load_state(grains, {}), Error);
}

TEST_F(GrainSystemTest, HeldGrainsStayUntilReleased) {
  GrainTable table;
  add_grain(table, {0.2, 0.5, 0.5}, 0.02, 2500);
  add_grain(table, {0.8, 0.5, 0.5}, 0.02, 2500);
  table.group = {0, 1};
  Grains grains({}, space({0, 0, 0}, {1, 1, 1}, 0.01), table, soft(), {}, {0, 0, -9.81});
  grains.set_release_times({0.0, 0.1});
  grains.advance(0.05, 20);
  grains.advance(0.05, 20);
  EXPECT_EQ(grains.table().position[1].z, 0.5);
  EXPECT_NEAR(grains.table().position[0].z, 0.5 - 0.5 * 9.81 * 0.01, 1e-6);
  grains.advance(0.1, 40);
  EXPECT_NEAR(grains.table().position[1].z, 0.5 - 0.5 * 9.81 * 0.01, 1e-6);
}

// Two grains keep one history between them when lists are made; that of a held grain stands still and must not be it.
TEST_F(GrainSystemTest, NewListsKeepTheHistoryAgainstAHeldGrain) {
  for (const double below : {-1.0, 1.0}) {  // the held grain has the lower slot, then the upper one
    GrainTable table;
    add_grain(table, {0.5, 0.5, 0.5}, 0.02, 2500);
    add_grain(table, {0.502, 0.5, 0.5 - below * 0.0197}, 0.02, 2500, {0.05, 0, 0});
    table.group = {0, 1};
    const auto end = [&](int lists) {
      Grains grains({}, space({0, 0, 0}, {1, 1, 1}, 0.01), table, soft(), {}, {0, 0, 9.81 * below});
      grains.set_release_times({1.0e9, 0.0});
      for (int k = 0; k < 8; ++k) {
        if (k < lists) grains.sort_grains();
        grains.advance(1.0e-4, 10);
      }
      EXPECT_EQ(grains.sums().contacts, 1);
      return grains.table().angular_velocity[1];
    };
    const Vec3f once = end(0), often = end(8);
    EXPECT_GT(norm(once), 0.1f);
    EXPECT_NEAR(often.y, once.y, 1.0e-5f * norm(once)) << below;
  }
}

TEST_F(GrainSystemTest, DragGivesWhatTheGrainTakes) {
  GrainTable table;
  add_grain(table, {0.5, 0.5, 0.5}, 0.02, 2500);
  Grains grains({}, space({0, 0, 0}, {1, 1, 1}, 0.01), table, soft(), {}, {});
  const double m = 2500.0 * 4.0 / 3.0 * 3.14159265358979 * 1.0e-6;
  const auto n = static_cast<std::size_t>(grains.slots());
  // Relaxation 1000 times shorter than the sub-step, much water.
  std::vector<float> drag(n, static_cast<float>(m / 1.0e-6)), water(n, static_cast<float>(1.0e6 * m)), added(n, 0.0f);
  std::vector<Vec3f> fluid(n, Vec3f{0.5f, 0, 0}), force(n), acceleration(n);
  grains.set_fluid({drag.data(), water.data(), added.data(), force.data(), acceleration.data(), fluid.data()});
  grains.clear_drag_impulse();
  grains.advance(0.02, 20);
  EXPECT_NEAR(grains.table().velocity[0].x, 0.5f, 1e-4f);
  Vec3d impulse{};
  for (std::size_t s = 0; s < n; ++s) impulse += grains.drag_impulse()[s];
  EXPECT_NEAR(impulse.x / grains.sums().momentum.x, 1.0, 1e-6);
}

TEST_F(GrainSystemTest, AddedMassSlowsAndOtherForcePushes) {
  GrainTable table;
  add_grain(table, {0.5, 0.5, 0.5}, 0.02, 2500);
  Grains grains({}, space({0, 0, 0}, {1, 1, 1}, 0.01), table, soft(), {}, {});
  const auto m = static_cast<float>(2500.0 * 4.0 / 3.0 * 3.14159265358979 * 1.0e-6);
  const auto n = static_cast<std::size_t>(grains.slots());
  std::vector<float> drag(n, 0.0f), water(n, m), added(n, m);
  std::vector<Vec3f> fluid(n), acceleration(n), force(n, Vec3f{0, m * 3.0f, 0});
  grains.set_fluid({drag.data(), water.data(), added.data(), force.data(), acceleration.data(), fluid.data()});
  grains.advance(0.1, 10);
  EXPECT_NEAR(grains.table().velocity[0].y, 0.15f, 1e-5f);
}

// Two grains in much water: one falls at its terminal velocity though drag relaxes a hundred times within a sub-step, one lies on
// a floor at the depth of Hertz, held by its contact: drag must not carry what the floor carries.
TEST_F(GrainSystemTest, StiffDragCarriesTheWeightOfAFallingGrainOnly) {
  GrainTable table;
  add_grain(table, {0.3, 0.5, 0.5}, 0.02, 2500);
  const double m = 2500.0 * 4.0 / 3.0 * 3.14159265358979 * 1.0e-6, rate = 1.0e6;
  const double resting = 0.01 - std::pow(0.75 * m * 9.81 / (1.0e6 / (2.0 * 0.91) * 0.1), 2.0 / 3.0);
  add_grain(table, {0.7, 0.5, resting}, 0.02, 2500);
  Grains grains({}, space({0, 0, 0}, {1, 1, 1}, 0.01), table, soft(), floor_mesh(0, 1, 0, 1, 0, 0.5), {0, 0, -9.81});
  const auto n = static_cast<std::size_t>(grains.slots());
  std::vector<float> drag(n, static_cast<float>(m * rate)), water(n, static_cast<float>(1.0e9 * m)), added(n, 0.0f);
  std::vector<Vec3f> fluid(n), force(n), acceleration(n);
  grains.set_fluid({drag.data(), water.data(), added.data(), force.data(), acceleration.data(), fluid.data()});
  grains.clear_drag_impulse();
  grains.advance(0.1, 1000);
  const GrainTable end = grains.table();
  EXPECT_NEAR(end.velocity[0].z * static_cast<float>(rate), -9.81f, 0.02f);
  EXPECT_LT(std::abs(end.position[1].z - resting), 1e-7);
  for (std::size_t s = 0; s < n; ++s) {
    const double share = grains.drag_impulse()[s].z / (m * 9.81 * 0.1);
    if (grains.ids()[s] == 0) {
      EXPECT_NEAR(share, 1.0, 2e-3);
    } else if (grains.ids()[s] == 1) {
      EXPECT_LT(share, 0.02);
    }
  }
}

TEST_F(GrainSystemTest, LostGrainsAreCounted) {
  GrainTable table;
  add_grain(table, {0.02, 0.5, 0.5}, 0.02, 2500, {-5, 0, 0});
  add_grain(table, {0.5, 0.5, 0.5}, 0.02, 2500);
  Grains grains({}, space({0, 0, 0}, {0.64, 0.64, 0.64}, 0.01), table, soft(), {}, {});
  for (int k = 0; k < 20; ++k) grains.advance(0.005, 10);
  EXPECT_EQ(grains.lost(), 1);
  EXPECT_EQ(grains.table().position.size(), 1u);
}

TEST_F(GrainSystemTest, InputErrorsNameGrainAndValue) {
  GrainTable table;
  add_grain(table, {0.5, 0.5, 0.5}, -0.02, 2500);
  try {
    Grains grains({}, space({0, 0, 0}, {1, 1, 1}, 0.01), table, soft(), {}, {});
    FAIL() << "a negative diameter was taken";
  } catch (const Error& error) { EXPECT_NE(std::string(error.what()).find("diameter of grain 0"), std::string::npos); }
  table.diameter[0] = 0.3f;  // blocks of 0.64 m hold diameters up to 0.145 m
  EXPECT_THROW(Grains({}, space({0, 0, 0}, {1, 1, 1}, 0.01), table, soft(), {}, {}), Error);
  table.diameter[0] = 0.02f;
  const bool periodic[3] = {false, true, false};
  const auto slab = [&](double width) { return make_domain({0, 0, 0}, {1, width, 1}, 0.01, periodic, 3); };
  EXPECT_NO_THROW(Grains({}, slab(0.121), table, soft(), {}, {})) << "six diameters";
  try {
    Grains grains({}, slab(0.119), table, soft(), {}, {});
    FAIL() << "a slab too narrow was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("period of 0.119000 m along y"), std::string::npos) << error.what();
  }
}

TEST_F(GrainSystemTest, RunawayStopsWithAMessage) {
  GrainTable table;
  add_grain(table, {0.5, 0.5, 0.5}, 0.02, 2500, {2.0e6, 0, 0});
  Grains grains({}, space({0, 0, 0}, {1, 1, 1}, 0.01), table, soft(), {}, {});
  try {
    grains.advance(1.0e-9, 1);
    FAIL() << "a speed of 2e6 m/s was taken";
  } catch (const Error& error) { EXPECT_EQ(error.kind(), ErrorKind::numerical); }
}

TEST_F(GrainSystemTest, StableStepIsAShareOfTheRayleighTime) {
  GrainTable table;
  add_grain(table, {0.5, 0.5, 0.5}, 0.00909, 2650);
  ContactParameters p;
  p.youngs_modulus = 2.0e8;
  Grains grains({}, space({0, 0, 0}, {1, 1, 1}, 0.01), table, p, {}, {});
  EXPECT_NEAR(grains.stable_time_step(0.2), 0.2 * 9.054988e-5, 1e-9);
}

// @eq dem.line.normal
TEST_F(GrainSystemTest, DiscsStayInTheirPlane) {
  GrainTable table;
  add_grain(table, {0.3, 0, 0.02}, 0.02, 2000, {1.0, 0, 0});
  const Domain domain = space({0, 0, 0}, {2, 0.64, 1}, 0.01, 2);
  TriangleTable walls;
  add_rectangle(walls, {0, -0.1, 0}, {2, -0.1, 0}, {2, 0.1, 0}, {0, 0.1, 0});
  add_rectangle(walls, {0, -0.004, 0}, {2, -0.004, 0}, {2, -0.004, 1}, {0, -0.004, 1});  // faces y: no wall here
  ContactParameters p = soft(0.3, 0.4);
  p.youngs_modulus = 1.0e7;
  Grains grains({}, domain, table, p, walls, {0, 0, -9.81});
  EXPECT_NEAR(grains.sums().mass, 2000.0 * 3.14159265 * 1.0e-4, 1e-5);
  for (int k = 0; k < 20; ++k) grains.advance(0.05, 500);
  const GrainTable end = grains.table();
  EXPECT_EQ(end.position[0].y, 0.0);
  // Weight over stiffness: 2000 pi 1e-4 9.81 / (pi/4 1e7/(2 0.91)) = 1.428e-6 m.
  EXPECT_NEAR(0.01 - end.position[0].z, 1.428e-6, 2e-8);
  // A sliding disc (I = m r^2/2) ends rolling at 2/3 of its speed.
  EXPECT_NEAR(end.velocity[0].x, 2.0 / 3.0, 0.02);
  EXPECT_NEAR(end.angular_velocity[0].y * 0.01f / end.velocity[0].x, 1.0f, 1e-3f);
}

// A covered hopper full of discs under a heavy one: rounding in the normals of its sides must not push any out of the plane.
// (Without the cover a disc pinched under the heavy one may fly over the rim: a matter of the last digit.)
TEST_F(GrainSystemTest, LoadedDiscsStayInTheirPlane) {
  GrainTable table;
  for (int row = 0; row < 12; ++row)
    for (int k = 0; k <= row; ++k)
      add_grain(table, {0.5 + 0.0101 * (k - 0.5 * row), 0.003, 0.03 + 0.0088 * row}, 0.01, 2500, {0.01, 0.2, 0},
                {3, 1, 2});
  add_grain(table, {0.5, 0, 0.183}, 0.1, 20000);
  TriangleTable walls;
  for (const double side : {-1.0, 1.0}) {
    const Vec3d low{0.5 + side * 0.002, -0.1, 0.0103}, high{0.5 + side * 0.1517, -0.1, 0.2681}, across{0, 0.2, 0};
    if (side < 0)
      add_rectangle(walls, low, low + across, high + across, high);
    else
      add_rectangle(walls, low, high, high + across, low + across);
  }
  add_rectangle(walls, {0.34, 0.1, 0.2681}, {0.66, 0.1, 0.2681}, {0.66, -0.1, 0.2681}, {0.34, -0.1, 0.2681});
  ContactParameters p = soft(0.3, 0.5);
  p.youngs_modulus = 1.0e7;  // softer discs, pressed to two thirds of their size, may slip through the mouth
  Grains grains({}, space({0, -0.004, 0}, {1, 0.004, 1}, 0.008, 2), table, p, walls, {0, 0, -9.81});
  for (int k = 0; k < 20; ++k) grains.advance(0.05, 5 * static_cast<int>(0.01 / grains.stable_time_step(0.2) + 1.0));
  EXPECT_EQ(grains.lost(), 0);
  EXPECT_GT(grains.sums().contacts, 78);
  const GrainTable end = grains.table();
  for (std::size_t i = 0; i < end.position.size(); ++i) {
    EXPECT_EQ(end.position[i].y, 0.0) << i;
    EXPECT_EQ(end.velocity[i].y, 0.0f) << i;
    EXPECT_EQ(end.angular_velocity[i].x, 0.0f) << i;
    EXPECT_EQ(end.angular_velocity[i].z, 0.0f) << i;
  }
  EXPECT_GT(end.position[78].z, 0.1);
}

}  // namespace
}  // namespace gdesp::dem::test
