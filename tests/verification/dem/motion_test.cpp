// SPDX-License-Identifier: GPL-3.0-or-later
// Sliding and rolling on a plane, against the answers of rigid-body mechanics (README.md).
#include <gtest/gtest.h>

#include <cmath>

#include "../../unit/dem/grain_scene.hpp"
#include "exec/parallel.hpp"

namespace gdesp::dem::test {
namespace {

constexpr double gravity = 9.81, radius = 0.01;

ContactParameters contact(double friction, double rolling = 0.0) {
  ContactParameters p;
  p.youngs_modulus = 1.0e8;
  p.restitution = 0.3;
  p.friction = friction;
  p.rolling_friction = rolling;
  return p;
}

double resting_overlap() {
  const double m = 2500.0 * 4.0 / 3.0 * 3.14159265 * radius * radius * radius;
  return std::pow(0.75 * m * gravity / (1.0e8 / (2.0 * 0.91) * std::sqrt(radius)), 2.0 / 3.0);
}

// A sphere at rest height on a floor in the plane z = 0; gravity is inclined instead of the floor.
Grains on_floor(const ContactParameters& p, double slope_degrees, const Vec3d& velocity, const Vec3d& spin) {
  exec::set_threads(1);
  const double slope = slope_degrees * 3.14159265358979324 / 180.0;
  GrainTable table;
  add_grain(table, {0.1, 0.5, radius - resting_overlap() * std::pow(std::cos(slope), 2.0 / 3.0)}, 2 * radius, 2500,
            velocity, spin);
  return Grains({}, space({-1, -1, -1}, {4, 2, 1}, 0.02), table, p, floor_mesh(-1, 4, 0, 1, 0, 0.1),
                {gravity * std::sin(slope), 0, -gravity * std::cos(slope)});
}

void run(Grains& grains, double time) {
  const int steps = static_cast<int>(std::ceil(time / grains.stable_time_step(0.3)));
  grains.advance(time, steps);
}

// A block slides with a = g (sin - mu cos); a sphere with little friction does too, spinning up all the way.
TEST(Incline, SlidesWithTheAccelerationOfABlock) {
  struct Row {
    double degrees, friction, acceleration;
  };
  for (const Row& row : {Row{20, 0.0, 3.35522}, Row{30, 0.0, 4.905}, Row{45, 0.2, 5.54937}, Row{35, 0.15, 4.421365}}) {
    Grains grains = on_floor(contact(row.friction), row.degrees, {}, {});
    run(grains, 0.5);
    EXPECT_NEAR(grains.table().velocity[0].x / (0.5 * row.acceleration), 1.0, 2e-3) << row.degrees;
    EXPECT_NEAR((grains.table().position[0].x - 0.1) / (0.125 * row.acceleration), 1.0, 2e-3) << row.degrees;
  }
}

// mu > 2/7 tan(slope): rolls without slip, a = 5/7 g sin(slope).
TEST(Incline, RollsWithoutSlip) {
  struct Row {
    double degrees, acceleration;
  };
  for (const Row& row : {Row{20, 2.39658}, Row{30, 3.50357}, Row{45, 4.95480}}) {
    Grains grains = on_floor(contact(0.5), row.degrees, {}, {});
    run(grains, 0.5);
    const GrainTable end = grains.table();
    EXPECT_NEAR(end.velocity[0].x / (0.5 * row.acceleration), 1.0, 2e-3) << row.degrees;
    EXPECT_NEAR(end.angular_velocity[0].y * radius / end.velocity[0].x, 1.0, 1e-3);
  }
}

// Rolling resistance: v = 5/7 g (sin - mu_r cos) t; below tan(slope) = mu_r it stays. @eq dem.rolling.elastic_plastic
TEST(Incline, RollingResistanceSlowsOrHolds) {
  Grains rolls = on_floor(contact(0.6, 0.1), 20.0, {}, {});
  run(rolls, 0.5);
  EXPECT_NEAR(rolls.table().velocity[0].x / (0.5 * 5.0 / 7.0 * gravity * (0.342020 - 0.1 * 0.939693)), 1.0, 5e-3);
  Grains stays = on_floor(contact(0.6, 0.1), 5.0, {}, {});
  run(stays, 0.5);
  EXPECT_LT(std::abs(stays.table().velocity[0].x), 1e-4);
  const double first = stays.table().position[0].x;
  run(stays, 0.5);
  EXPECT_LT(std::abs(stays.table().position[0].x - first), 1e-6);
}

// Thresholds within 2 %: rolling starts at tan(slope) = mu_r, sliding of a sphere that cannot roll at tan(slope) = mu. A
// model with mu_r on the radius of the pair R*/2, or with mu on the force with damping, would miss both by more.
TEST(Incline, ThresholdsOfRollingAndSliding) {
  const auto speed_after = [](double friction, double rolling, double tangent) {
    Grains grains = on_floor(contact(friction, rolling), std::atan(tangent) * 180.0 / 3.14159265358979324, {}, {});
    run(grains, 1.0);
    return std::abs(static_cast<double>(grains.table().velocity[0].x));
  };
  EXPECT_LT(speed_after(0.6, 0.1, 0.098), 1e-4);
  EXPECT_NEAR(speed_after(0.6, 0.1, 0.102), 5.0 / 7.0 * gravity * 0.002 * std::cos(std::atan(0.102)), 2e-3);
  EXPECT_LT(speed_after(0.3, 2.0, 0.294), 1e-4);
  EXPECT_NEAR(speed_after(0.3, 2.0, 0.306), gravity * 0.006 * std::cos(std::atan(0.306)), 6e-3);
}

// A sphere hangs below a plane as long as its weight is less than the pull-off force 2 pi w R. @eq dem.cohesion.dmt
TEST(Cohesion, HoldsAHangingSphereUpToItsPullOffForce) {
  exec::set_threads(1);
  const double weight = 2500.0 * 4.0 / 3.0 * 3.14159265358979324 * radius * radius * radius * gravity;
  const auto height_after = [&](double share) {
    ContactParameters p = contact(0.0);
    p.cohesion = share * weight / (2.0 * 3.14159265358979324 * radius);
    GrainTable table;
    add_grain(table, {0.5, 0.5, radius - 1e-6}, 2 * radius, 2500);
    Grains grains({}, space({-1, -1, -1}, {2, 2, 2}, 0.02), table, p, floor_mesh(0, 1, 0, 1, 0, 0.25), {0, 0, gravity});
    run(grains, 0.2);
    return grains.table().position[0].z;
  };
  EXPECT_LT(height_after(1.05), radius);
  EXPECT_GT(height_after(0.95), 2.0 * radius);
}

// A sliding sphere ends rolling at 5/7 of its speed, at t = 2 u0/(7 mu g).
TEST(Plane, SlidingTurnsToRollingAtFiveSevenths) {
  Grains grains = on_floor(contact(0.3), 0.0, {1.0, 0, 0}, {});
  const double end = 2.0 / (7.0 * 0.3 * gravity);
  run(grains, 0.5 * end);
  EXPECT_NEAR(grains.table().velocity[0].x, 1.0 - 0.5 * 2.0 / 7.0, 2e-3);
  run(grains, 1.5 * end);
  EXPECT_NEAR(grains.table().velocity[0].x, 5.0 / 7.0, 1e-3);
  EXPECT_NEAR(grains.table().angular_velocity[0].y * radius, 5.0 / 7.0, 1e-3);
}

// A spinning sphere on a smooth floor is braked by rolling resistance alone: omega0 - 5 mu_r g t/(2 r).
TEST(Plane, SpinDecaysByRollingResistance) {
  Grains grains = on_floor(contact(0.0, 0.05), 0.0, {}, {0, 100.0, 0});
  run(grains, 0.3);
  EXPECT_NEAR(grains.table().angular_velocity[0].y, 100.0 - 2.5 * 0.05 * gravity * 0.3 / radius, 0.3);
  run(grains, 1.0);
  EXPECT_NEAR(grains.table().angular_velocity[0].y, 0.0, 0.05);
}

// A grain at rest stays at rest: no creep, no jitter.
TEST(Plane, RestsWithoutCreep) {
  Grains grains = on_floor(contact(0.5), 0.0, {}, {});
  run(grains, 0.5);
  const Vec3d first = grains.table().position[0];
  run(grains, 1.0);
  EXPECT_LT(norm(grains.table().position[0] - first), 1e-9);
  EXPECT_LT(grains.sums().kinetic_energy, 1e-16);
}

// Friction holds a pressed row: three spheres in line under gravity along x, held by the floor's friction.
TEST(Incline, FrictionHoldsARowBelowItsAngle) {
  exec::set_threads(1);
  ContactParameters p = contact(0.5, 0.5);
  const double slope = 20.0 * 3.14159265358979324 / 180.0;
  GrainTable table;
  for (int k = 0; k < 3; ++k) add_grain(table, {0.1 + 0.02 * k, 0.5, radius - resting_overlap()}, 0.02, 2500);
  Grains grains({}, space({-1, -1, -1}, {2, 2, 1}, 0.02), table, p, floor_mesh(-1, 2, 0, 1, 0, 0.1),
                {gravity * std::sin(slope), 0, -gravity * std::cos(slope)});
  run(grains, 0.3);
  const Vec3d first = grains.table().position[2];
  run(grains, 1.0);
  EXPECT_LT(norm(grains.table().position[2] - first), 2e-7);
}

}  // namespace
}  // namespace gdesp::dem::test
