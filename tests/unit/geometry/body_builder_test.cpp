// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/body_builder.hpp"

#include "support.hpp"

namespace gdesp::geometry {
namespace {

using testing::Folder;
using testing::input_error;

TEST(FreeBody, BoxHasTheTextbookInertia) {
  SolidPart part;
  part.mesh = box_mesh({{1e5, 2, 3}, {1e5 + 1, 4, 6}});   // 1 x 2 x 3 m, far from the origin
  const Body b = free_body("box", part, 700.0, {}, 3);
  const double mass = 700.0 * 6.0;
  EXPECT_NEAR(b.mass, mass, 1e-9 * mass);
  EXPECT_NEAR(b.centre.x, 1e5 + 0.5, 1e-9);
  EXPECT_NEAR(b.inertia[0], mass * (4 + 9) / 12.0, 1e-9 * mass);
  EXPECT_NEAR(b.inertia[4], mass * (1 + 9) / 12.0, 1e-9 * mass);
  EXPECT_NEAR(b.inertia[8], mass * (1 + 4) / 12.0, 1e-9 * mass);
  EXPECT_NEAR(b.inertia[1], 0.0, 1e-9 * mass);
}

TEST(FreeBody, SphereApproachesTwoFifthsOfMassRadiusSquared) {
  SolidPart part;
  part.mesh = testing::sphere({4, 5, 6}, 2.0, 80);
  const Body b = free_body("ball", part, 1.0, {}, 3);
  EXPECT_NEAR(b.inertia[4] / (0.4 * b.mass * 4.0), 1.0, 2e-3);
  EXPECT_NEAR(b.inertia[2], 0.0, 1e-9);
}

TEST(FreeBody, TwoDimensionsArePerMetreOfWidth) {
  SolidPart part;
  part.mesh = box_mesh({{0, -7, 0}, {1, 7, 2}});
  const Body b = free_body("disc", part, 500.0, {}, 2);
  EXPECT_NEAR(b.mass, 1000.0, 1e-9);
  EXPECT_EQ(b.centre.y, 0.0);
  EXPECT_NEAR(b.inertia[4], 1000.0 * (1 + 4) / 12.0, 1e-9);
}

TEST(Motion, ConstantVelocityBetweenStartAndStop) {
  const PrescribedMotion m = constant_motion({0, 0, 0.68}, 0.1, 0.6);
  ASSERT_EQ(m.time.size(), 2u);
  EXPECT_EQ(m.time[0], 0.1);
  EXPECT_NEAR(m.displacement[1].z, 0.34, 1e-15);
  const PrescribedMotion open_end = constant_motion({1, 0, 0}, 0.0, 1e30);
  EXPECT_NEAR(open_end.displacement[1].x / open_end.time[1], 1.0, 1e-15);
  EXPECT_EQ(constant_motion({}, 0, 1).time.size(), 1u);
}

TEST(Motion, CsvIsReadAndItsMistakesAreNamed) {
  const Folder folder;
  const PrescribedMotion m = read_motion(folder.write("a.csv", "t,dx,dy,dz\n0,0,0,0\n0.5,1,0,-1\n"));
  ASSERT_EQ(m.time.size(), 2u);
  EXPECT_EQ(m.displacement[1].z, -1.0);
  EXPECT_MENTIONS(input_error([&] { read_motion(folder.write("b.csv", "0,0,0,0\n1,2\n")); }), "b.csv:2");
  EXPECT_MENTIONS(input_error([&] { read_motion(folder.write("c.csv", "0,0,0,0\n0,1,1,1\n")); }), "times must increase");
  EXPECT_MENTIONS(input_error([&] { read_motion(folder.write("d.csv", "t,dx,dy,dz\n")); }), "holds no line");
  EXPECT_MENTIONS(input_error([&] { read_motion(folder.file("none.csv")); }), "cannot be opened");
}

}  // namespace
}  // namespace gdesp::geometry
