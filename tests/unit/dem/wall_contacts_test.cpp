// SPDX-License-Identifier: GPL-3.0-or-later
// Grains against triangles: one contact per feature, no kicks at seams, no way through, moving bodies.
#include <gtest/gtest.h>
#include <omp.h>

#include "../../support/state_of.hpp"
#include "grain_scene.hpp"

namespace gdesp::dem::test {
namespace {

struct WallTest : ::testing::Test {
  WallTest() { exec::set_threads(1); }
};

ContactParameters hard(double restitution = 1.0, double friction = 0.0) {
  ContactParameters p;
  p.youngs_modulus = 1.0e8;
  p.restitution = restitution;
  p.friction = friction;
  return p;
}

Domain metre() { return space({-0.2, -0.2, -0.2}, {1.2, 1.2, 1.2}, 0.02); }

// A closed box seen from outside.
TriangleTable block(const Vec3d& low, const Vec3d& high, std::int32_t body = 0) {
  TriangleTable table = tank(low, high);
  for (auto& t : table.triangle) std::swap(t.y, t.z);
  table.body.assign(table.triangle.size(), body);
  return table;
}

GrainTable one(const Vec3d& position, const Vec3d& velocity = {}, const Vec3d& spin = {}) {
  GrainTable table;
  add_grain(table, position, 0.02, 2500, velocity, spin);
  return table;
}

TEST_F(WallTest, ReboundFromFaceEdgeAndVertexOfABlock) {
  const TriangleTable box = block({0.4, 0.4, 0.2}, {0.6, 0.6, 0.4});
  struct Shot {
    Vec3d from, velocity, after;
  };
  // Elastic and smooth: v' = v - 2 (v.n) n with n the normal of the feature at the point of contact.
  const double e = 0.011 / std::sqrt(2.0), v = 0.011 / std::sqrt(3.0);
  const Shot shots[] = {
      {{0.45, 0.52, 0.411}, {0.2, 0, -1}, {0.2, 0, 1}},         // face
      {{0.5, 0.5, 0.411}, {0.2, 0, -1}, {0.2, 0, 1}},           // on the diagonal
      {{0.6 + e, 0.513, 0.4 + e}, {-1, 0.3, -1}, {1, 0.3, 1}},  // edge
      {{0.6 + v, 0.6 + v, 0.4 + v}, {-1, -1, -1}, {1, 1, 1}},   // vertex
  };
  for (const Shot& shot : shots) {
    Grains grains({}, metre(), one(shot.from, shot.velocity), hard(), box, {});
    grains.advance(4.0e-3, 8000);
    const Vec3d after(grains.table().velocity[0]);
    EXPECT_LT(norm(after - shot.after), 3.0e-4) << after.x << " " << after.y << " " << after.z;
  }
}

TEST_F(WallTest, OneContactOnFaceSeamFanAndCorner) {
  struct Place {
    Vec3d at;
    int contacts;
  };
  // A floor of 0.1 m squares, each of two triangles: middle of a triangle, on edges, on a vertex of six triangles.
  for (const Place& place : {Place{{0.53, 0.51, 0.0099}, 1}, Place{{0.55, 0.55, 0.0099}, 1},
                             Place{{0.5, 0.53, 0.0099}, 1}, Place{{0.5, 0.5, 0.0099}, 1}}) {
    Grains grains({}, metre(), one(place.at), hard(), floor_mesh(0, 1, 0, 1, 0, 0.1), {});
    grains.advance(1.0e-7, 1);
    EXPECT_EQ(grains.sums().wall_contacts, place.contacts) << place.at.x << " " << place.at.y;
  }
  Grains corner({}, metre(), one({0.0099, 0.0099, 0.0099}), hard(), tank({0, 0, 0}, {1, 1, 1}), {});
  corner.advance(1.0e-7, 1);
  EXPECT_EQ(corner.sums().wall_contacts, 3);
}

// The centre as far from an edge as the radius, to the last bits: whether it touches is a matter of rounding, but there is no root of
// a negative overlap.
TEST_F(WallTest, GrainsThatJustReachAnEdgeFeelNothingOrLittle) {
  const TriangleTable box = block({0.4, 0.0, 0.2}, {0.6, 1.0, 0.4});
  Random random(3);
  for (int trial = 0; trial < 300; ++trial) {
    GrainTable grains;
    for (int k = 0; k < 39; ++k) {
      const double angle = 1.5707 * random(), distance = 0.01 * (1.0 + 4.0e-7 * (random() - 0.5));
      add_grain(grains, {0.6 + distance * std::sin(angle), 0.013 + 0.025 * k, 0.4 + distance * std::cos(angle)}, 0.02,
                2500);
    }
    Grains system({}, metre(), grains, hard(0.5, 0.5), box, {});
    ASSERT_NO_THROW(system.advance(1.0e-6, 1));
    EXPECT_LT(system.largest_speed(), 1.0e-6);
  }
}

TEST_F(WallTest, RollsOverSeamsWithoutAKick) {
  // Fine mesh (half a grain), rolling without slip in an odd direction from the resting height: nothing may change.
  ContactParameters p = hard(0.5, 0.5);
  const Vec3d v{0.31, 0.17, 0};
  Grains grains({}, metre(), one({0.2, 0.3, 0.01}, v, {-v.y / 0.01, v.x / 0.01, 0}), p, floor_mesh(0, 1, 0, 1, 0, 0.01),
                {0, 0, -9.81});
  grains.advance(0.1, 3000);
  const double rest = grains.table().position[0].z;
  const Vec3d rolling(grains.table().velocity[0]);
  double kick = 0.0, sink = 0.0;
  for (int k = 0; k < 400; ++k) {
    grains.advance(0.0025, 75);
    kick = std::max(kick, std::abs(static_cast<double>(grains.table().velocity[0].z)));
    sink = std::max(sink, std::abs(grains.table().position[0].z - rest));
  }
  const double overlap = 0.01 - rest;
  EXPECT_GT(overlap, 1.0e-6);
  EXPECT_LT(sink, 0.02 * overlap);
  EXPECT_LT(kick, 2.0e-6);
  EXPECT_LT(norm(Vec3d(grains.table().velocity[0]) - rolling), 2.0e-5);
  EXPECT_GT(grains.table().position[0].x, 0.5);
}

TEST_F(WallTest, NearlyFlatValleysDoNotStiffen) {
  // A floor with a crease of 2 degrees: rolling across it may not throw the grain up.
  TriangleTable floor;
  const double rise = std::tan(2.0 * 3.14159265 / 180.0) * 0.5;
  add_rectangle(floor, {0, 0, rise}, {0.5, 0, 0}, {0.5, 1, 0}, {0, 1, rise});
  add_rectangle(floor, {0.5, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, 1, 0});
  ContactParameters p = hard(0.5, 0.5);
  Grains grains({}, metre(), one({0.4, 0.5, 0.01 + rise * 0.2}, {0.4, 0, 0}, {0, 40, 0}), p, floor, {0, 0, -9.81});
  double highest = -1.0;
  for (int k = 0; k < 200; ++k) {
    grains.advance(0.0025, 50);
    const Vec3d at = grains.table().position[0];
    if (at.x > 0.52) highest = std::max(highest, at.z);
  }
  EXPECT_GT(highest, 0.0);
  EXPECT_LT(highest,
            0.01 + 1.5e-4);  // turning the velocity by 2 degrees with e = 0.5 lifts (0.4 sin 2 0.5)^2/2g = 2.5e-6
}

TEST_F(WallTest, RestsInACornerAtTheHertzDepth) {
  // Lying in the groove of two planes at 45 degrees: each carries m g / sqrt 2.
  TriangleTable groove;
  add_rectangle(groove, {0, 0, 0.5}, {0.5, 0, 0}, {0.5, 1, 0}, {0, 1, 0.5});
  add_rectangle(groove, {0.5, 0, 0}, {1, 0, 0.5}, {1, 1, 0.5}, {0.5, 1, 0});
  Grains grains({}, metre(), one({0.5, 0.5, 0.01 * std::sqrt(2.0)}), hard(0.2), groove, {0, 0, -9.81});
  for (int k = 0; k < 20; ++k) grains.advance(0.02, 400);
  const double m = 2500.0 * 4.0 / 3.0 * 3.14159265 * 1e-6, e_star = 1.0e8 / (2.0 * 0.91);
  const double force = m * 9.81 / std::sqrt(2.0);
  const double overlap = std::pow(0.75 * force / (e_star * std::sqrt(0.01)), 2.0 / 3.0);
  EXPECT_NEAR((0.01 * std::sqrt(2.0) - grains.table().position[0].z) / (overlap * std::sqrt(2.0)), 1.0, 2e-3);
  EXPECT_EQ(grains.sums().wall_contacts, 2);
}

TEST_F(WallTest, ThinGateStopsGrainsFromBothSides) {
  // A closed plate a tenth of a radius thick; grains come at 1 to 20 m/s from both sides, at face, edge and corner.
  TriangleTable gate = block({0.5, 0.0, 0.0}, {0.501, 1.0, 1.0});
  for (double speed : {1.0, 5.0, 20.0}) {
    for (double side : {-1.0, 1.0}) {
      ContactParameters p = hard(0.9, 0.3);
      p.youngs_modulus = 1.0e9;
      const double x = side < 0 ? 0.5 - 0.02 : 0.501 + 0.02;
      Grains grains({}, metre(), one({x, 0.51, 0.5}, {-side * speed, 0, 0}), p, gate, {});
      const double dt = std::min(grains.stable_time_step(0.2), 1.0e-3 / speed);
      const int steps = static_cast<int>(0.04 / speed / dt) + 200;
      grains.advance(steps * dt, steps);
      const GrainTable end = grains.table();
      EXPECT_GT(side * (end.position[0].x - 0.5005), 0.01) << speed << " " << side;
      EXPECT_GT(side * end.velocity[0].x, 0.7 * speed);
    }
  }
}

TEST_F(WallTest, CentreBehindAFaceIsPushedOut) {
  Grains grains({}, metre(), one({0.52, 0.53, -0.002}), hard(0.5), floor_mesh(0, 1, 0, 1, 0, 0.1), {});
  grains.advance(0.02, 2000);
  EXPECT_GT(grains.table().position[0].z, 0.009);
}

TEST_F(WallTest, PistonHitsElasticallyAndFeelsIt) {
  const TriangleTable piston = block({0.2, 0.3, 0.3}, {0.3, 0.7, 0.7}, 1);
  Grains grains({}, metre(), one({0.3135, 0.5, 0.5}), hard(), piston, {});
  BodyMotionState body;
  body.centre_initial = {0.25, 0.5, 0.5};
  Vec3d impulse{}, turning{};
  for (int k = 0; k < 100; ++k) {
    body.centre_begin = body.centre_initial + Vec3d{1.0e-4 * k, 0, 0};
    body.centre_end = body.centre_initial + Vec3d{1.0e-4 * (k + 1), 0, 0};
    grains.set_bodies({body});
    grains.advance(1.0e-4, 200);
    const std::vector<BodyImpulse> given = grains.take_body_impulses();
    ASSERT_EQ(given.size(), 1u);
    impulse += given[0].linear;
    turning += given[0].angular;
  }
  const double m = grain_mass_of(grains.table(), 0);
  EXPECT_NEAR(grains.table().velocity[0].x, 2.0, 2e-3);
  EXPECT_NEAR(impulse.x, -m * grains.table().velocity[0].x, 1e-6 * m);
  EXPECT_LT(norm(turning), 1e-6 * m);
}

TEST_F(WallTest, TurningPaddleHitsWithTheSpeedOfItsPoint) {
  // A plate that turns about y at 10 rad/s; a grain at arm 0.2 m gets twice the speed of the point, 4 m/s.
  const TriangleTable paddle = block({0.3, 0.3, 0.49}, {0.7, 0.7, 0.5}, 1);
  Grains grains({}, metre(), one({0.7 - 0.05, 0.5, 0.5107}), hard(), paddle, {});
  BodyMotionState body;
  body.centre_initial = body.centre_begin = body.centre_end = {0.45, 0.5, 0.5};
  const double rate = -10.0, dt = 1.0e-4;  // about y: x towards z
  const auto turn = [](double angle, double* r) {
    const double c = std::cos(angle), s = std::sin(angle);
    const double m[9] = {c, 0, s, 0, 1, 0, -s, 0, c};
    std::copy(m, m + 9, r);
  };
  Vec3d linear{}, angular{};
  for (int k = 0; k < 40; ++k) {
    turn(rate * dt * k, body.rotation_begin);
    turn(rate * dt * (k + 1), body.rotation_end);
    grains.set_bodies({body});
    grains.advance(dt, 200);
    linear += grains.take_body_impulses()[0].linear;
    angular += Vec3d{};
  }
  const Vec3d v(grains.table().velocity[0]);
  EXPECT_NEAR(v.z, 4.0, 0.02);
  EXPECT_NEAR(norm(v), 4.0, 0.02);
  EXPECT_NEAR(linear.z / (-grain_mass_of(grains.table(), 0) * v.z), 1.0, 1e-4);
}

TEST_F(WallTest, RemovedBodyLetsGo) {
  const TriangleTable shelf = block({0.2, 0.2, 0.3}, {0.8, 0.8, 0.4}, 1);
  Grains grains({}, metre(), one({0.5, 0.5, 0.41}), hard(0.3), shelf, {0, 0, -9.81});
  BodyMotionState body;
  grains.set_bodies({body});
  for (int k = 0; k < 10; ++k) grains.advance(0.01, 200);
  EXPECT_NEAR(grains.table().position[0].z, 0.41, 1e-4);
  body.present = 0;
  grains.set_bodies({body});
  grains.advance(0.1, 1000);
  EXPECT_NEAR(grains.table().position[0].z, 0.41 - 0.5 * 9.81 * 0.01, 1e-3);
}

// A wall triangle of 1 km must place the grain as exactly as a small one.
TEST_F(WallTest, LargeTrianglesKeepTheirPlace) {
  for (double size : {1.0, 1000.0}) {
    TriangleTable floor;
    add_rectangle(floor, {-size, -size, -0.5 * size}, {size, -size, 0.5 * size}, {size, size, 0.5 * size},
                  {-size, size, -0.5 * size});
    const double slope = std::atan(0.5);
    const Vec3d n{-std::sin(slope), 0, std::cos(slope)};
    const Vec3d start{0.4, 0.35, 0.2};
    Grains grains({}, metre(), one(start + 0.00999 * n), hard(0.5), floor, -9.81 * n);
    for (int k = 0; k < 10; ++k) grains.advance(0.01, 200);
    const double m = 2500.0 * 4.0 / 3.0 * 3.14159265 * 1e-6, e_star = 1.0e8 / (2.0 * 0.91);
    const double overlap = std::pow(0.75 * m * 9.81 / (e_star * std::sqrt(0.01)), 2.0 / 3.0);
    const double height = dot(grains.table().position[0] - start, n);
    EXPECT_NEAR((0.01 - height) / overlap, 1.0, 0.01) << size;
  }
}

// A plane of symmetry stops a grain and does not hold it back; the rough floor beside it does, and makes it roll.
TEST_F(WallTest, SmoothTrianglesHaveNoFriction) {
  TriangleTable floor = floor_mesh(0, 1, 0, 1, 0.1, 0.5);
  floor.smooth.assign(floor.triangle.size(), 0);
  for (std::size_t t = 0; t < floor.triangle.size(); ++t) {
    const auto& c = floor.triangle[t];
    const double x = (floor.vertex[c.x].x + floor.vertex[c.y].x + floor.vertex[c.z].x) / 3.0;
    floor.smooth[t] = x < 0.5 ? 1 : 0;
  }
  ContactParameters contact = hard(0.5, 0.5);
  contact.rolling_friction = 0.1;
  GrainTable table = one({0.2, 0.3, 0.11}, {0.5, 0.2, 0.0});
  add_grain(table, {0.7, 0.3, 0.11}, 0.02, 2500, {0.5, 0.2, 0.0});
  Grains grains({}, metre(), table, contact, floor, {0, 0, -9.81});
  grains.advance(0.1, 10000);
  const GrainTable now = grains.table();
  EXPECT_EQ(now.velocity[0].x, 0.5f);
  EXPECT_EQ(now.velocity[0].y, 0.2f);
  EXPECT_EQ(now.angular_velocity[0].y, 0.0f);
  EXPECT_NEAR(now.position[0].z, 0.11, 1.0e-4);
  EXPECT_LT(now.velocity[1].x, 0.4f);
  EXPECT_GT(now.angular_velocity[1].y, 10.0f);
}

// A skin that grows while grains fall ever faster must not hide the floor from those that were far from it.
TEST_F(WallTest, NoContactIsMissedWhateverTheSkin) {
  const auto fall = [](double skin) {
    GrainTable table;
    Random random(3);
    for (int i = 0; i < 100; ++i) {
      add_grain(table, {0.1 + 0.08 * (i / 10), 0.1 + 0.08 * (i % 10), 0.062 + 0.03 * random()}, 0.02, 2500);
    }
    ContactParameters contact = hard(0.7, 0.3);
    contact.skin = skin;
    Grains grains({}, metre(), table, contact, floor_mesh(0, 1, 0, 1, 0.05, 0.04), {0, 0, -10000.0});
    for (int k = 0; k < 4; ++k) grains.advance(1.0e-3, 50);
    return grains.table();
  };
  const GrainTable any = fall(0.0), wide = fall(0.5);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_LT(norm(any.position[i] - wide.position[i]), 1.0e-6) << i;
    EXPECT_GT(any.position[i].z, 0.05) << i;
  }
}

TEST_F(WallTest, ManyGrainsStayInTheTank) {
  GrainTable table;
  Random random(9);
  for (int i = 0; i < 200; ++i) {
    add_grain(table, {0.1 + 0.2 * random(), 0.1 + 0.2 * random(), 0.1 + 0.2 * random()}, 0.02, 2500,
              {8 * random() - 4, 8 * random() - 4, 8 * random() - 4});
  }
  Grains grains({}, metre(), table, hard(0.7, 0.3), tank({0.05, 0.05, 0.05}, {0.35, 0.35, 0.35}), {0, 0, -9.81});
  const double dt = 2.0e-5;
  for (int k = 0; k < 20; ++k) grains.advance(100 * dt, 100);
  const GrainTable end = grains.table();
  ASSERT_EQ(end.position.size(), 200u);
  for (const Vec3d& p : end.position) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GT(p[axis], 0.05 + 0.005);
      EXPECT_LT(p[axis], 0.35 - 0.005);
    }
  }
}

// A heightfield rougher than a grain: nobody falls through or gets lost, and energy only goes.
TEST_F(WallTest, JaggedGroundHoldsARainOfGrains) {
  Random random(5);
  TriangleTable ground = floor_mesh(0, 0.3, 0, 0.3, 0.1, 0.01);
  for (Vec3d& v : ground.vertex) v.z += 0.02 * random();
  const TriangleTable box = tank({0, 0, -0.1}, {0.3, 0.3, 0.8});
  const auto base = static_cast<std::int32_t>(ground.vertex.size());
  ground.vertex.insert(ground.vertex.end(), box.vertex.begin(), box.vertex.end());
  for (const auto& t : box.triangle) ground.triangle.push_back({t.x + base, t.y + base, t.z + base});
  ground.body.assign(ground.triangle.size(), 0);
  GrainTable table;
  for (int i = 0; i < 150; ++i) {
    add_grain(table, {0.03 + 0.24 * random(), 0.03 + 0.24 * random(), 0.16 + 0.2 * random()}, 0.02, 2500,
              {random(), random(), -8 * random()});
  }
  Grains grains({}, space({-0.1, -0.1, -0.2}, {0.4, 0.4, 1.0}, 0.01), table, hard(0.8, 0.4), ground, {0, 0, -9.81});
  grains.advance(0.004, 200);
  GrainSums last = grains.sums();
  for (int k = 0; k < 6; ++k) {
    grains.advance(0.015, 500);
    const GrainSums s = grains.sums();
    EXPECT_LT(s.kinetic_energy + s.potential_energy + s.elastic_energy,
              1.0005 * (last.kinetic_energy + last.potential_energy + last.elastic_energy));
    last = s;
  }
  EXPECT_EQ(grains.lost(), 0);
  for (const Vec3d& p : grains.table().position) EXPECT_GT(p.z, 0.1);
}

// Everything at once: walls, a moving body, rolling; two threads, a checkpoint in the middle.
TEST_F(WallTest, BodiesGoOnBitForBitFromACheckpoint) {
  ContactParameters p = hard(0.5, 0.4);
  p.youngs_modulus = 1.0e7;
  p.rolling_friction = 0.05;
  TriangleTable walls = tank({0, 0, 0}, {0.3, 0.2, 0.5});
  const TriangleTable gate = block({0.1715, 0.0, 0.0}, {0.1755, 0.2, 0.5}, 1);
  const auto base = static_cast<std::int32_t>(walls.vertex.size());
  walls.vertex.insert(walls.vertex.end(), gate.vertex.begin(), gate.vertex.end());
  for (const auto& t : gate.triangle) walls.triangle.push_back({t.x + base, t.y + base, t.z + base});
  walls.body.insert(walls.body.end(), gate.body.begin(), gate.body.end());
  GrainTable table;
  Random random(8);
  for (int i = 0; i < 6 * 8 * 10; ++i) {
    add_grain(table, {0.015 + 0.021 * (i % 8), 0.015 + 0.021 * (i / 8 % 6), 0.015 + 0.021 * (i / 48)},
              0.018 + 0.002 * random(), 2500);
  }
  const auto lift = [](Grains& grains, double begin, double end) {
    BodyMotionState body;
    body.centre_begin.z = 0.7 * begin;
    body.centre_end.z = 0.7 * end;
    grains.set_bodies({body});
    grains.advance(end - begin, static_cast<int>((end - begin) / 1.0e-4 + 0.5));
  };
  const auto fresh = [&] { return Grains({}, metre(), table, p, walls, {0, 0, -9.81}); };
  Grains whole = fresh(), first = fresh(), second = fresh();
  exec::set_threads(2);
  for (int k = 0; k < 6; ++k) lift(whole, 0.005 * k, 0.005 * (k + 1));
  exec::set_threads(1);
  for (int k = 0; k < 4; ++k) lift(first, 0.005 * k, 0.005 * (k + 1));
  load_state(second, state_of(first));
  for (int k = 4; k < 6; ++k) lift(second, 0.005 * k, 0.005 * (k + 1));
  EXPECT_TRUE(state_of(whole) == state_of(second));
  EXPECT_GT(norm(whole.take_body_impulses()[0].linear), 0.0);
}

TEST(WallMesh, WeldsJoinsAndDropsWhatHasNoArea) {
  TriangleTable table = block({0, 0, 0}, {1, 1, 1});
  table.vertex.push_back({0.5, 0.5, 2});
  const auto lone = static_cast<std::int32_t>(table.vertex.size() - 1);
  table.triangle.push_back({lone, lone, 0});
  table.body.push_back(0);
  const WallMesh mesh = make_wall_mesh(table, 1.0e-6, 3, 1.0);
  EXPECT_EQ(mesh.frame.size(), 12u);
  for (const EdgeSide& side : mesh.edge) EXPECT_EQ(side.open, 0);
  table.triangle.back().x = 99;
  EXPECT_THROW(make_wall_mesh(table, 1.0e-6, 3, 1.0), std::exception);
}

TEST(BodyPath, TurnsEvenlyAndBackIsTheInverse) {
  BodyMotionState state;
  const double quarter[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};  // about z
  std::copy(quarter, quarter + 9, state.rotation_end);
  state.centre_end = {1, 2, 3};
  const BodyMoment middle = body_at(state, 0.5, 2.0);
  EXPECT_NEAR(middle.rotation[0], std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(middle.rotation[3], std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(middle.spin.z, 0.25 * 3.14159265358979, 1e-12);
  EXPECT_NEAR(middle.centre.y, 1.0, 1e-15);
  EXPECT_NEAR(middle.velocity.z, 1.5, 1e-15);
  const double half[9] = {-1, 0, 0, 0, -1, 0, 0, 0, 1};
  std::copy(half, half + 9, state.rotation_end);
  EXPECT_NEAR(std::abs(body_at(state, 0.5, 1.0).rotation[3]), 1.0, 1e-9);
}

}  // namespace
}  // namespace gdesp::dem::test
