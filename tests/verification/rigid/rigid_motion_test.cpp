// SPDX-License-Identifier: GPL-3.0-or-later
// Free bodies without water, against the answers of rigid-body mechanics.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "rigid_scene.hpp"

namespace gdesp::test {
namespace {

constexpr double gravity = 9.81, degree = 3.14159265358979324 / 180.0;

dem::ContactParameters contact(double friction, double restitution = 0.3) {
  dem::ContactParameters p;
  p.youngs_modulus = 4.0e6;
  p.restitution = restitution;
  p.friction = friction;
  return p;
}

// @eq rigid.motion
TEST(RigidMotion, FallsOnAParabola) {
  TriangleTable walls;
  add_box(walls, 1, {0, 0, 10}, {1, 1, 11});
  Body body = box_body({0, 0, 10}, {1, 1, 11}, 500);
  body.velocity = {1.0, 2.0, 3.0};
  dem::RigidBodies bodies({body}, walls, contact(0.5), {0, 0, -gravity}, 0.25, 3);
  bodies.release(0.0);
  run_dry(bodies, 1.0, 0.013);
  EXPECT_NEAR(bodies.state(0).centre.z, 10.5 + 3.0 - 0.5 * gravity, 1e-12);
  EXPECT_NEAR(bodies.state(0).centre.y, 2.5, 1e-12);
  EXPECT_NEAR(bodies.state(0).velocity.z, 3.0 - gravity, 1e-12);
}

// Rotation about the middle axis tumbles over; nothing acts. @eq rigid.rotation
TEST(RigidMotion, TumblesWithItsEnergyAndAngularMomentum) {
  TriangleTable walls;
  add_box(walls, 1, {-1, -0.5, -0.2}, {1, 0.5, 0.2});
  Body body = box_body({-1, -0.5, -0.2}, {1, 0.5, 0.2}, 500);
  body.angular_velocity = {0.01, 5.0, 0.01};
  dem::RigidBodies bodies({body}, walls, contact(0.5), {}, 0.25, 3);
  bodies.release(0.0);
  const dem::RigidSums start = bodies.sums();
  double turned = 1.0, drift = 0.0;
  for (int k = 0; k < 40; ++k) {
    run_dry(bodies, 0.5, 0.002);
    const dem::BodyMoment now = bodies.moment(0);
    const double* r = now.rotation;
    turned = std::min(turned, r[4]);  // the middle axis against where it was
    drift = std::max(drift, std::abs(bodies.sums().kinetic_energy / start.kinetic_energy - 1.0));
  }
  EXPECT_LT(turned, -0.9);
  EXPECT_LT(drift, 1e-5);
  EXPECT_NEAR(norm(bodies.sums().angular_momentum - start.angular_momentum) / norm(start.angular_momentum), 0.0, 1e-12);
}

// A symmetric top without torque: its axis circles around L with the rate |L|/I_1. @eq rigid.rotation
TEST(RigidMotion, TopPrecessesAtTheExactRate) {
  TriangleTable walls;
  add_box(walls, 1, {-0.5, -0.5, -0.1}, {0.5, 0.5, 0.1});
  Body body = box_body({-0.5, -0.5, -0.1}, {0.5, 0.5, 0.1}, 1000);
  const Vec3d spin{3.0, 0.0, 10.0};
  body.angular_velocity = spin;
  const Vec3d L{body.inertia[0] * spin.x, 0.0, body.inertia[8] * spin.z};
  const double period = 2.0 * 3.14159265358979324 * body.inertia[0] / norm(L);
  double error[2];
  for (int fine = 0; fine < 2; ++fine) {
    dem::RigidBodies bodies({body}, walls, contact(0.5), {}, 0.25, 3);
    bodies.release(0.0);
    run_dry(bodies, 5.0 * period, period / (fine ? 400.0 : 200.0));
    const dem::BodyMoment now = bodies.moment(0);
    const double* r = now.rotation;
    error[fine] = norm(Vec3d{r[2], r[5], r[8] - 1.0});  // the axis is back after whole periods
  }
  EXPECT_LT(error[1], 2e-3);
  EXPECT_NEAR(error[0] / error[1], 4.0, 0.4);  // second order
}

// A block on a slope (gravity is inclined): rests below tan(slope) = mu, slides at g (sin - mu cos) beyond.
// @eq rigid.contact.friction
TEST(RigidIncline, BlockRestsOrSlides) {
  struct Row {
    double degrees, friction, acceleration;
  };
  for (int dimensions : {2, 3}) {
    for (const Row& row : {Row{20, 0.0, 3.35522}, Row{25, 0.4, 0.589533}, Row{30, 0.2, 3.20586}, Row{30, 0.6, 0.0},
                           Row{20, 0.37, 0.0}}) {
      TriangleTable walls;
      add_floor(walls, -2.0, 6.0, 0.0);
      const Vec3d lo{0, -0.5, 0}, hi{0.4, 0.5, 0.2};
      add_box(walls, 1, lo, hi);
      const Vec3d g{gravity * std::sin(row.degrees * degree), 0, -gravity * std::cos(row.degrees * degree)};
      dem::RigidBodies bodies({box_body(lo, hi, 2000)}, walls, contact(row.friction), g, dimensions == 2 ? 0.05 : 0.2,
                              dimensions);
      bodies.release(0.0);
      run_dry(bodies, 0.2, 0.001);  // it settles: contacts carry nothing at the start
      const double settled = bodies.state(0).velocity.x;
      run_dry(bodies, 0.3, 0.001);
      const double x = bodies.state(0).centre.x - 0.2;
      if (row.acceleration > 0.0) {
        EXPECT_NEAR((bodies.state(0).velocity.x - settled) / (0.3 * row.acceleration), 1.0, 2e-3)
            << row.degrees << " " << dimensions;
      } else {
        EXPECT_LT(std::abs(x), 3e-3) << row.degrees;
        const double before = bodies.state(0).centre.x;
        run_dry(bodies, 0.5, 0.001);
        EXPECT_LT(std::abs(bodies.state(0).centre.x - before), 1e-7) << "creeps at " << row.degrees;
      }
    }
  }
}

// Below still water friction feels the effective stress: mu (N - u A). @eq rigid.contact.friction
TEST(RigidIncline, WaterBelowABlockCarriesItsShare) {
  TriangleTable walls;
  add_floor(walls, -2.0, 6.0, 0.0);
  const Vec3d lo{0, -0.5, 0}, hi{0.4, 0.5, 0.2};
  add_box(walls, 1, lo, hi);
  const Vec3d g{2.0, 0, -gravity};
  dem::RigidBodies bodies({box_body(lo, hi, 2000)}, walls, contact(0.3), g, 0.05, 2);
  bodies.set_still_water(1000.0,
                         0.3);  // u A = 1000 g 0.3 x 0.4 of a weight of 2000 g 0.2 x 0.4, and the side's half points
  bodies.release(0.0);
  run_dry(bodies, 0.5, 0.001);
  const double share = 0.3 * (0.4 + 0.05) / 0.16;
  EXPECT_NEAR(bodies.state(0).velocity.x, 0.5 * (2.0 - 0.3 * gravity * (1.0 - share)), 0.01);
}

// Rolling without slip: a = 2/3 g sin(slope) of a cylinder, 5/7 g sin(slope) of a sphere; their surfaces are polygons.
TEST(RigidIncline, CylinderAndSphereRoll) {
  const double slope = 20.0 * degree;
  const Vec3d g{gravity * std::sin(slope), 0, -gravity * std::cos(slope)};
  dem::ContactParameters soft = contact(0.5, 0.9);
  soft.youngs_modulus = 1.0e6;
  for (const bool sphere : {false, true}) {
    TriangleTable walls;
    add_floor(walls, -2.0, 4.0, 0.0);
    const Body body = sphere ? add_sphere(walls, 1, 0.1, 0.1, 60, 2000) : add_cylinder(walls, 1, 0.1, 0.1, 720, 2000);
    dem::RigidBodies bodies({body}, walls, soft, g, 0.02, sphere ? 3 : 2);
    bodies.release(0.0);
    run_dry(bodies, 0.3, 0.0005);
    const double expected = 0.3 * (sphere ? 5.0 / 7.0 : 2.0 / 3.0) * g.x;
    EXPECT_NEAR(bodies.state(0).velocity.x / expected, 1.0, 0.02);
    EXPECT_NEAR(bodies.moment(0).spin.y * 0.1 / bodies.state(0).velocity.x, 1.0, 0.02);
  }
}

// @eq rigid.contact.normal
TEST(RigidContact, ReboundsWithItsRestitution) {
  for (const double e : {0.3, 0.7, 1.0}) {
    TriangleTable walls;
    add_floor(walls, -2.0, 2.0, 0.0);
    const Vec3d lo{-0.2, -0.2, 0.1}, hi{0.2, 0.2, 0.3};
    add_box(walls, 1, lo, hi);
    Body body = box_body(lo, hi, 2000);
    body.velocity = {0, 0, -1.0};
    dem::RigidBodies bodies({body}, walls, contact(0.0, e), {}, 0.05, 3);
    bodies.release(0.0);
    run_dry(bodies, 0.2, 0.0002);
    EXPECT_NEAR(bodies.state(0).velocity.z, e, 0.05 * e);  // steps of a sixtieth of a period
    EXPECT_GT(bodies.state(0).centre.z, 0.12);
  }
}

// Two free boxes meet corner to face: momentum, linear and angular, stays. @eq rigid.contact.normal
TEST(RigidContact, TwoBodiesKeepTheirMomentum) {
  TriangleTable walls;
  add_box(walls, 1, {-0.5, -0.2, -0.2}, {-0.1, 0.2, 0.2});
  add_box(walls, 2, {0.1, -0.05, 0.0}, {0.5, 0.35, 0.4});
  Body one = box_body({-0.5, -0.2, -0.2}, {-0.1, 0.2, 0.2}, 2000),
       two = box_body({0.1, -0.05, 0.0}, {0.5, 0.35, 0.4}, 1000);
  one.velocity = {2.0, 0.1, 0.0};
  two.velocity = {-1.0, 0.0, 0.1};
  two.angular_velocity = {0.0, 0.0, 0.5};
  dem::RigidBodies bodies({one, two}, walls, contact(0.5, 1.0), {}, 0.05, 3);
  bodies.release(0.0);
  const dem::RigidSums start = bodies.sums();
  run_dry(bodies, 0.3, 0.0005);
  const dem::RigidSums end = bodies.sums();
  EXPECT_LT(bodies.state(0).velocity.x, 1.5);  // they have met
  EXPECT_LT(norm(end.momentum - start.momentum), 1e-10 * norm(start.momentum));
  EXPECT_LT(norm(end.angular_momentum - start.angular_momentum), 1e-10 * norm(start.angular_momentum));
  EXPECT_LT(end.kinetic_energy, start.kinetic_energy * (1.0 + 1e-4));
}

TEST(RigidBodiesStart, HeldFixedAndCheckedAtTheStart) {
  TriangleTable walls;
  add_floor(walls, -2.0, 2.0, 0.0);
  add_box(walls, 1, {0, 0, 1}, {0.4, 0.4, 1.4});
  Body body = box_body({0, 0, 1}, {0.4, 0.4, 1.4}, 2000);
  body.release_at = 0.5;
  body.velocity = {1, 0, 0};
  body.fixed[0] = body.fixed[3] = true;
  dem::RigidBodies bodies({body}, walls, contact(0.5), {0, 0, -gravity}, 0.05, 3);
  run_dry(bodies, 0.5, 0.01);
  EXPECT_EQ(bodies.state(0).centre.z, 1.2);
  bodies.release(0.5);
  EXPECT_TRUE(bodies.state(0).free);
  run_dry(bodies, 0.2, 0.01);
  EXPECT_EQ(bodies.state(0).centre.x, 0.2);
  EXPECT_NEAR(bodies.state(0).centre.z, 1.2 - 0.5 * gravity * 0.04, 1e-9);
  EXPECT_THROW(bodies.check({-1, -1, 1.1}, {1, 1, 2}, 0.7), Error);
  body.mass = 0.0;
  EXPECT_THROW(dem::RigidBodies({body}, walls, contact(0.5), {}, 0.05, 3), Error);
}

// A body that starts half inside a floor is not thrown out; it rests where it is.
TEST(RigidContact, ABodyThatStartsInsideTheGroundStays) {
  TriangleTable walls;
  add_floor(walls, -2.0, 2.0, 0.03);
  add_box(walls, 1, {0, 0, 0}, {0.4, 0.4, 0.4});
  dem::RigidBodies bodies({box_body({0, 0, 0}, {0.4, 0.4, 0.4}, 2000)}, walls, contact(0.5), {0, 0, -gravity}, 0.05, 3);
  bodies.release(0.0);
  run_dry(bodies, 0.5, 0.001);
  EXPECT_NEAR(bodies.state(0).centre.z, 0.2, 2e-3);
  EXPECT_LT(norm(bodies.state(0).velocity), 1e-3);
}

}  // namespace
}  // namespace gdesp::test
