// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/body_builder.hpp"

#include "support.hpp"

namespace gdesp::geometry {
namespace {

using testing::Folder;
using testing::input_error;

TEST(FreeBody, BoxHasTheTextbookInertia) {
  SolidPart part;
  part.mesh = box_mesh({{1e5, 2, 3}, {1e5 + 1, 4, 6}});  // 1 x 2 x 3 m, far from the origin
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

FluidTable water_block(const Vec3d& low, const Vec3d& high, double dp) {
  FluidTable water;
  for (double x = low.x + 0.5 * dp; x < high.x; x += dp)
    for (double y = low.y + 0.5 * dp; y < high.y; y += dp)
      for (double z = low.z + 0.5 * dp; z < high.z; z += dp) water.position.push_back({x, y, z});
  return water;
}

TEST(FarLake, TakesWidthAndBedFromTheWaterAtThePiston) {
  const double dp = 0.1;
  MovingBody piston;
  piston.name = "far";
  piston.far_lake.length = 20.0;
  piston.far_lake.depth = 1.0;
  const FluidTable water = water_block({0, -1, 2}, {3, 1, 3}, dp);
  const Box right{{3, -2, 0}, {3.5, 2, 5}}, left{{-0.5, -2, 0}, {0, 2, 5}}, apart{{3.3, -2, 0}, {3.8, 2, 5}};
  const FarLakeShape lake = far_lake_behind(piston, right, water, dp, 3);
  EXPECT_EQ(lake.columns, 100);
  EXPECT_EQ(lake.side, 1.0);
  EXPECT_EQ(lake.wall, 3.0);
  EXPECT_NEAR(lake.width, 2.0, 1e-9);
  EXPECT_NEAR(lake.level, 3.0, 1e-9);
  EXPECT_EQ(moving_body(piston, 9.81).kind, BodyKind::far_lake);
  EXPECT_MENTIONS(input_error([&] { far_lake_behind(piston, left, water, dp, 3); }), "no water touches");
  EXPECT_MENTIONS(input_error([&] { far_lake_behind(piston, apart, water, dp, 3); }), "no water touches");
  piston.far_lake.side = "x-";
  piston.far_lake.columns = 7;
  EXPECT_EQ(far_lake_behind(piston, left, water, dp, 3).wall, 0.0);
  EXPECT_EQ(far_lake_behind(piston, left, water, dp, 3).side, -1.0);
  EXPECT_EQ(far_lake_behind(piston, left, water, dp, 3).columns, 7);
  piston.far_lake.depth = 1.2;
  EXPECT_MENTIONS(input_error([&] { far_lake_behind(piston, left, water, dp, 3); }), "is 1.000000 m deep");
  piston.far_lake.depth = 1.0;
  FluidTable valley;
  for (const Vec3d& r : water.position)
    if (r.z - 2.0 > 0.5 * std::abs(r.y)) valley.position.push_back(r);
  EXPECT_MENTIONS(input_error([&] { far_lake_behind(piston, left, valley, dp, 3); }), "no rectangle");
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
  const PrescribedMotion m = read_motion(folder.write("a.csv", "# whose\nt,dx,dy,dz\n0,0,0,0\n0.5,1,0,-1\n"));
  ASSERT_EQ(m.time.size(), 2u);
  EXPECT_EQ(m.displacement[1].z, -1.0);
  EXPECT_MENTIONS(input_error([&] { read_motion(folder.write("b.csv", "0,0,0,0\n1,2\n")); }), "b.csv:2");
  EXPECT_MENTIONS(input_error([&] { read_motion(folder.write("c.csv", "0,0,0,0\n0,1,1,1\n")); }),
                  "times must increase");
  EXPECT_MENTIONS(input_error([&] { read_motion(folder.write("d.csv", "t,dx,dy,dz\n")); }), "holds no line");
  EXPECT_MENTIONS(input_error([&] { read_motion(folder.file("none.csv")); }), "cannot be opened");
}

}  // namespace
}  // namespace gdesp::geometry
