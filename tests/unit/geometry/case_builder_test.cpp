// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/case_builder.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "particles/surface_rows.hpp"
#include "support.hpp"

namespace gdesp::geometry {
namespace {

using testing::field;
using testing::Folder;
using testing::input_error;

Scene tank_scene(double dp) {
  Scene s;
  s.dp = dp;
  Wall tank;
  tank.name = "tank";
  tank.tank = Box{{0, 0, 0}, {0.4, 0.2, 0.3}};
  tank.open = {"top"};
  s.walls = {tank};
  FluidFill fill;
  fill.kind = "box";
  fill.box = Box{{0, 0, 0}, {0.4, 0.2, 0.2}};
  s.fluid.fill = {fill};
  return s;
}

TEST(CaseBuilder, TankIsFilledExactlyAndWalledThreeDeep) {
  BuildReport report;
  const Case c = build_case(tank_scene(0.02), report);
  EXPECT_EQ(c.fluid.position.size(), 20u * 10u * 10u);
  EXPECT_EQ(c.boundary.position.size(), 26u * 16u * 18u - 20u * 10u * 15u);  // shell below the rim
  std::set<int> depths;
  for (std::size_t k = 0; k < c.boundary.position.size(); ++k) {
    const Vec3d& p = c.boundary.position[k];
    const Vec3f n = c.boundary.normal[k];
    EXPECT_NEAR(norm(n), 1.0f, 1e-5f);
    // depth along the normal leads to the inner face
    const Vec3d q = p + static_cast<Vec3d>(n) * static_cast<double>(c.boundary.depth[k]);
    EXPECT_GE(q.x, -1e-6);
    EXPECT_LE(q.x, 0.4 + 1e-6);
    EXPECT_GE(q.z, -1e-6);
    if (p.x > 0 && p.x < 0.4 && p.y > 0 && p.y < 0.2)
      depths.insert(static_cast<int>(std::lround(c.boundary.depth[k] / 0.02 * 2)));
  }
  EXPECT_EQ(depths, (std::set<int>{1, 3, 5}));  // dp/2, 3dp/2, 5dp/2 under the floor
  EXPECT_TRUE(report.notes.warnings.empty());
  EXPECT_EQ(c.walls.triangle.size(), 10u);
}

TEST(CaseBuilder, PlanesOfSymmetryAreSmoothAndNoOtherFace) {
  Scene s = tank_scene(0.02);
  s.walls[0].symmetry = {"y+"};
  BuildReport report;
  const Case c = build_case(s, report);
  ASSERT_EQ(c.walls.smooth.size(), c.walls.triangle.size());
  int smooth = 0;
  for (std::size_t t = 0; t < c.walls.triangle.size(); ++t) {
    double least = 1.0;
    for (int k = 0; k < 3; ++k)
      least = std::min(least, c.walls.vertex[static_cast<std::size_t>(c.walls.triangle[t][k])].y);
    EXPECT_EQ(c.walls.smooth[t], least > 0.2 - 1e-9 ? 1 : 0) << t;
    smooth += c.walls.smooth[t];
  }
  EXPECT_EQ(smooth, 2);
  s.walls[0].condition = "no-slip";
  BuildReport rough;
  const BoundaryTable layers = build_case(s, rough).boundary;
  for (std::size_t k = 0; k < layers.position.size(); ++k) {
    const Vec3d& p = layers.position[k];
    const bool behind_others = p.x < 0.0 || p.x > 0.4 || p.y < 0.0 || p.z < 0.0;
    EXPECT_EQ(layers.friction[k], behind_others ? 1.0f : 0.0f) << p.x << " " << p.y << " " << p.z;
  }
  BuildReport other;
  EXPECT_TRUE(build_case(tank_scene(0.02), other).walls.smooth.empty());
}

TEST(CaseBuilder, EverythingLiesInTheDomain) {
  BuildReport report;
  const Case c = build_case(tank_scene(0.02), report);
  for (const auto* list : {&c.fluid.position, &c.boundary.position}) {
    for (const auto& p : *list) {
      for (int a = 0; a < 3; ++a) {
        ASSERT_GT(p[a], c.domain.lower[a]);
        ASSERT_LT(p[a], c.domain.upper[a]);
      }
    }
  }
}

TEST(CaseBuilder, TwoDimensionsAreOneLayer) {
  Scene s = tank_scene(0.02);
  s.dimensions = 2;
  BuildReport report;
  const Case c = build_case(s, report);
  EXPECT_EQ(c.fluid.position.size(), 20u * 10u);
  EXPECT_EQ(c.boundary.position.size(), 26u * 18u - 20u * 15u);
  for (const auto& p : c.boundary.position) EXPECT_EQ(p.y, 0.0);
  EXPECT_NEAR(report.fills[0].volume, 0.08, 1e-12);
}

TEST(CaseBuilder, UnevenTankIsToldAbout) {
  BuildReport report;
  build_case(tank_scene(0.03), report);
  ASSERT_FALSE(report.notes.warnings.empty());
  EXPECT_MENTIONS(report.notes.warnings[0], "particle spacings");
}

TEST(CaseBuilder, GateIsABodyThatKeepsTheWaterOut) {
  Scene s = tank_scene(0.02);
  MovingBody gate;
  gate.name = "gate";
  gate.shape.box = Box{{0.2, 0, 0}, {0.26, 0.2, 0.3}};
  gate.velocity = {0, 0, 0.5};
  gate.start = 0.1;
  gate.remove_at = 0.4;
  s.moving = {gate};
  BuildReport report;
  const Case c = build_case(s, report);
  ASSERT_EQ(c.bodies.size(), 1u);
  EXPECT_EQ(c.bodies[0].motion.remove_at, 0.4);
  EXPECT_EQ(c.fluid.position.size(), 17u * 10u * 10u);
  EXPECT_EQ(std::count(c.boundary.body.begin(), c.boundary.body.end(), 1), 3 * 10 * 15);
  EXPECT_EQ(std::count(c.walls.body.begin(), c.walls.body.end(), 1), 12);
  EXPECT_GT(c.domain.upper.z, 0.3 + 0.4);  // where it is lifted to within time.end = 1 s
}

// The same scene at UTM-like coordinates gives the same particles, to a millionth of dp.
TEST(CaseBuilder, LargeCoordinatesChangeNothing) {
  const Folder folder;
  const auto hill = [](double x, double y) { return 0.01 * x + 3.0 * std::sin(0.05 * x) * std::cos(0.04 * y); };
  Scene near, far;
  for (auto* s : {&near, &far}) {
    const double x0 = s == &near ? 0.0 : 1904800.0, y0 = s == &near ? 0.0 : 5794800.0;
    const std::string name = folder.file(s == &near ? "near.asc" : "far.asc");
    write_esri_ascii(field(x0, y0, 10.0, 31, 21, [&](double x, double y) { return hill(x - x0, y - y0); }), name, 6);
    s->dp = 2.0;
    s->terrain.files = {name};
    FluidFill fill;
    fill.level = 0.5;
    s->fluid.fill = {fill};
  }
  BuildReport report;
  const Case a = build_case(near, report), b = build_case(far, report);
  EXPECT_GT(norm(b.offset), 1e6);
  EXPECT_EQ(norm(a.offset), 0.0);
  ASSERT_EQ(a.fluid.position.size(), b.fluid.position.size());
  ASSERT_EQ(a.boundary.position.size(), b.boundary.position.size());
  const Vec3d shift = Vec3d{1904800.0, 5794800.0, 0.0} - b.offset;
  for (std::size_t k = 0; k < a.boundary.position.size(); ++k) {
    ASSERT_NEAR(norm(a.boundary.position[k] + shift - b.boundary.position[k]), 0.0, 2e-6);
    ASSERT_NEAR(a.boundary.depth[k], b.boundary.depth[k], 2e-4);
  }
  for (const auto& v : b.walls.vertex) EXPECT_LT(std::abs(v.x), 1000.0);
}

// Water and walls in rows whose shifts are those of sph.surface-rows, with the pressure of the level.
TEST(CaseBuilder, RowsOfALakeStandWhereTheyRest) {
  const Folder folder;
  const std::string name = folder.file("hill.asc");
  write_esri_ascii(
      field(0.0, 0.0, 10.0, 31, 21, [](double x, double y) { return 3.0 * std::sin(0.05 * x) * std::cos(0.04 * y); }),
      name, 6);
  Scene s;
  s.dp = 0.5;
  s.terrain.files = {name};
  FluidFill fill;
  fill.level = 0.5;
  s.fluid.fill = {fill};
  const std::vector<double> shift = surface_row_shifts(s.numerics.smoothing_ratio, 3);
  BuildReport report;
  const Case rests = build_case(s, report);
  ASSERT_EQ(rests.fluid.pressure.size(), rests.fluid.position.size());
  std::set<double> rows;
  for (std::size_t i = 0; i < rests.fluid.position.size(); ++i) {
    const double z = rests.fluid.position[i].z;
    rows.insert(std::round(1e9 * z) / 1e9);
    ASSERT_NEAR(rests.fluid.pressure[i], 9810.0 * (fill.level - z), 0.02);
  }
  ASSERT_GT(rows.size(), 3u);
  std::size_t k = 0;
  for (auto row = rows.rbegin(); k < 3; ++row, ++k)
    EXPECT_NEAR(*row, fill.level + (shift[k] - static_cast<double>(k) - 0.5) * s.dp, 1e-8);
  const double second = fill.level + (shift[1] - 1.5) * s.dp;
  EXPECT_TRUE(std::any_of(rests.boundary.position.begin(), rests.boundary.position.end(), [&](const Vec3d& p) {
    return std::abs(p.z - second) < 1e-8;
  })) << "the walls beside them too";
  s.numerics.walls = "dynamic";
  const Case lattice = build_case(s, report);
  EXPECT_TRUE(lattice.fluid.pressure.empty());
  for (const Vec3d& p : lattice.fluid.position)
    ASSERT_NEAR(std::remainder((fill.level - p.z) / s.dp - 0.5, 1.0), 0.0, 1e-9);
}

/// Heights of the particles, from the top down.
std::vector<double> rows_of(const std::vector<Vec3d>& particles) {
  std::set<double, std::greater<>> rows;
  for (const Vec3d& p : particles) rows.insert(std::round(1e9 * p.z) / 1e9);
  return {rows.begin(), rows.end()};
}

// A tank and a box of water in it: rows and pressures as those of a lake, the walls of the tank too, and as many particles.
TEST(CaseBuilder, RowsOfATankStandWhereTheyRest) {
  const Scene s = tank_scene(0.02);
  BuildReport report;
  const Case c = build_case(s, report);
  const std::vector<double> shift = surface_row_shifts(s.numerics.smoothing_ratio, 3), rows = rows_of(c.fluid.position);
  ASSERT_EQ(rows.size(), 10u);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(rows[k], 0.2 + (shift[k] - static_cast<double>(k) - 0.5) * s.dp, 1e-8);
  const std::vector<double> walls = rows_of(c.boundary.position);
  for (const double z : rows) EXPECT_TRUE(std::count(walls.begin(), walls.end(), z)) << z;
  ASSERT_EQ(c.fluid.pressure.size(), c.fluid.position.size());
  for (std::size_t i = 0; i < c.fluid.pressure.size(); ++i)
    ASSERT_NEAR(c.fluid.pressure[i], 9810.0 * (0.2 - c.fluid.position[i].z), 0.01);
}

// On the lattice stays what has no surface in common, one between the rows, or none that is free.
TEST(CaseBuilder, RowsStayOnTheLatticeWithoutAFreeSurface) {
  const auto highest = [](const Scene& s) {
    BuildReport report;
    return rows_of(build_case(s, report).fluid.position).front();
  };
  Scene steps = tank_scene(0.02);
  steps.fluid.fill[0].box = Box{{0, 0, 0}, {0.2, 0.2, 0.2}};
  steps.fluid.fill.push_back(steps.fluid.fill[0]);
  steps.fluid.fill[1].box = Box{{0.2, 0, 0}, {0.4, 0.2, 0.1}};
  EXPECT_NEAR(highest(steps), 0.19, 1e-9);
  Scene between = tank_scene(0.02);
  between.fluid.fill[0].box->upper.z = 0.195;  // ten rows in it
  EXPECT_NEAR(highest(between), 0.195 * 0.95, 1e-9);
  Scene closed = tank_scene(0.02);
  closed.walls[0].open.clear();
  closed.walls[0].tank->upper.z = 0.2;
  EXPECT_NEAR(highest(closed), 0.19, 1e-9);
}

// Depth and normal of terrain walls against the plane they come from.
TEST(CaseBuilder, SlopeHasItsTrueDepthAndNormal) {
  const Folder folder;
  write_esri_ascii(field(0, 0, 5.0, 21, 11, [](double x, double) { return 0.5 * x; }), folder.file("slope.asc"), 6);
  Scene s;
  s.dp = 1.0;
  s.terrain.files = {folder.file("slope.asc")};
  BuildReport report;
  const Case c = build_case(s, report);
  ASSERT_GT(c.boundary.position.size(), 1000u);
  const Vec3d n{-0.5 / std::sqrt(1.25), 0, 1.0 / std::sqrt(1.25)};
  double worst = 0.0;
  for (std::size_t k = 0; k < c.boundary.position.size(); ++k) {
    const Vec3d& p = c.boundary.position[k];
    if (p.x < 5 || p.x > 90 || p.y < 4 || p.y > 46) continue;  // edges of the sheet have other nearest points
    const double depth = -dot(p, n);
    worst = std::max(worst, std::abs(std::max(depth, 0.05) - c.boundary.depth[k]));
    EXPECT_LE(depth, 3.0 + 1e-6);
    EXPECT_GE(depth, -1e-6);
    if (depth > 0.01) { EXPECT_GT(dot(static_cast<Vec3d>(c.boundary.normal[k]), n), 0.999); }
  }
  EXPECT_LT(worst, 0.1);  // of a voxel
}

TEST(CaseBuilder, BandMemoryGrowsWithAreaNotVolume) {
  const Folder folder;
  write_esri_ascii(
      field(0, 0, 10.0, 21, 21, [](double x, double y) { return 30.0 * std::sin(0.03 * x) * std::cos(0.02 * y); }),
      folder.file("t.asc"), 4);
  Scene s;
  s.terrain.files = {folder.file("t.asc")};
  std::size_t voxels[2];
  for (int k = 0; k < 2; ++k) {
    s.dp = k ? 2.0 : 4.0;
    BuildReport report;
    build_case(s, report);
    voxels[k] = report.band_voxels;
  }
  EXPECT_NEAR(static_cast<double>(voxels[1]) / static_cast<double>(voxels[0]), 4.0, 0.5);
}

TEST(CaseBuilder, PorousBedHoldsItsShareOfTheWater) {
  Scene s = tank_scene(0.01);
  Slide bed;
  bed.shape.box = Box{{0, 0, 0}, {0.4, 0.2, 0.1}};
  bed.diameter = 0.02;
  bed.porosity = 0.5;
  s.slides = {bed};
  BuildReport report;
  const Case c = build_case(s, report, {.scope = BuildScope::counts_only});
  std::size_t in_bed = 0;
  for (const auto& p : c.fluid.position) in_bed += p.z < 0.1;
  EXPECT_NEAR(static_cast<double>(in_bed), 0.5 * 8000, 0.05 * 8000);
  EXPECT_EQ(c.fluid.position.size() - in_bed, 8000u);
}

// Six spacings wide: rounded along each axis for itself, the numbers would be up to 23 % off.
TEST(CaseBuilder, NarrowPorousBedHoldsItsShareToo) {
  Scene s = tank_scene(0.01);
  s.walls[0].tank = Box{{0, 0, 0}, {0.06, 0.06, 0.3}};
  s.fluid.fill[0].box = Box{{0, 0, 0}, {0.06, 0.06, 0.2}};
  Slide bed;
  bed.shape.box = Box{{0, 0, 0}, {0.06, 0.06, 0.1}};
  bed.diameter = 0.002;
  for (const double porosity : {0.4, 0.45, 0.5, 0.6, 0.7, 0.75, 0.8, 0.9}) {
    bed.porosity = porosity;
    s.slides = {bed};
    BuildReport report;
    const Case c = build_case(s, report, {.scope = BuildScope::counts_only});
    std::size_t in_bed = 0;
    for (const auto& p : c.fluid.position) in_bed += p.z < 0.1;
    EXPECT_NEAR(static_cast<double>(in_bed) / (porosity * 360.0), 1.0, 0.05) << porosity;
  }
}

/// Ground at 20 m with a bowl down to 10 m, at coordinates as large as UTM's.
Scene bowl_far_out(const Folder& folder) {
  write_esri_ascii(field(571000, 5126000, 10.0, 21, 21,
                         [](double x, double y) {
                           return 20.0 -
                                  10.0 * std::exp(-(std::pow(x - 571100, 2) + std::pow(y - 5126100, 2)) / 2500.0);
                         }),
                   folder.file("t.asc"), 4);
  Scene s;
  s.dp = 4.0;
  s.terrain.files = {folder.file("t.asc")};
  FluidFill fill;
  fill.kind = "level";
  fill.level = 18.0;
  fill.seed = Point2{571100, 5126100};
  s.fluid.fill = {fill};
  return s;
}

std::string warnings_of(const Scene& s) {
  BuildReport report;
  build_case(s, report, {.scope = BuildScope::counts_only});
  std::string all;
  for (const auto& w : report.notes.warnings) all += w + "\n";
  return all;
}

TEST(CaseBuilder, GaugesOnDryGroundAreNamed) {
  const Folder folder;
  Scene s = bowl_far_out(folder);
  s.gauges = {{"shore", {571005, 5126005, 0}, false}, {"lake", {571100, 5126100, 0}, false}};
  BuildReport report;
  const Case made = build_case(s, report, {.scope = BuildScope::counts_only});
  std::string all;
  for (const auto& note : report.notes.done) all += note + "\n";
  EXPECT_MENTIONS(all, "gauge \"shore\" (x 571005 m, y 5126005 m) stands on dry ground");
  EXPECT_EQ(all.find("\"lake\""), std::string::npos);
  EXPECT_GT(made.fluid.position.size(), 0u);
}

TEST(CaseBuilder, WhatLiesElsewhereIsNamedWithItsPlace) {
  const Folder folder;
  Scene s = bowl_far_out(folder);
  EXPECT_EQ(warnings_of(s), "");
  s.gauges = {{"lost", {0, 0, 0}, false}, {"good", {571100, 5126100, 0}, false}};
  const std::string text = warnings_of(s);
  EXPECT_MENTIONS(text, "gauge \"lost\" (x 0 m, y 0 m) lies outside the domain (x 570");
  EXPECT_EQ(text.find("good"), std::string::npos);
  s.fluid.fill[0].level = 60.0;  // feet for metres
  EXPECT_MENTIONS(warnings_of(s), "stands above 100 % of the ground, whose highest point is at 19.99");
  s = bowl_far_out(folder);
  Slide slide;
  slide.name = "north";
  slide.diameter = 5.0;
  slide.shape.box = Box{{601000, 5126100, 20}, {601050, 5126150, 50}};
  s.slides = {slide};
  EXPECT_MENTIONS(input_error([&] { warnings_of(s); }), "slide \"north\" (x 601000 m to 601050 m");
  s.slides[0].shape.box = Box{{571020, 5126020, 0}, {571060, 5126060, 10}};
  EXPECT_MENTIONS(input_error([&] { warnings_of(s); }), "has no room");
  s.slides[0].kind = "rigid";
  EXPECT_MENTIONS(input_error([&] { warnings_of(s); }), "has no room");
  s.slides[0].shape.box = Box{{571020, 5126020, 10}, {571060, 5126060, 30}};
  EXPECT_MENTIONS(warnings_of(s), "% of its volume lies inside the terrain");
}

TEST(CaseBuilder, SlideThatSettlesIsGivenToTheSolverAndNotWithoutOne) {
  Scene s = tank_scene(0.01);
  Slide bed;
  bed.shape.box = Box{{0, 0, 0}, {0.4, 0.2, 0.1}};
  bed.diameter = 0.02;
  bed.porosity = 0.5;
  bed.velocity = {1, 0, 0};
  bed.relaxation = "gravity";
  s.slides = {bed};
  BuildReport report;
  EXPECT_THROW(build_case(s, report), Error);
  EXPECT_NO_THROW(build_case(s, report, {.scope = BuildScope::counts_only}));
  report = {};
  const Case c = build_case(s, report, {.settler = [](GrainTable& grains, const TriangleTable&) {
                              for (Vec3d& p : grains.position) p.z -= 0.001;
                              return Settlement{.time = 2.0};
                            }});
  ASSERT_TRUE(report.slides.at(0).settled.has_value());
  EXPECT_NEAR(report.slides[0].settled->fall, 0.001, 1e-12);
  EXPECT_EQ(c.grains.velocity.at(0).x, 1.0f);
  ASSERT_FALSE(report.notes.warnings.empty());
  EXPECT_NE(report.notes.warnings.back().find("not at rest after 2"), std::string::npos);
}

TEST(CaseBuilder, RigidSlideAndFloatingBox) {
  Scene s = tank_scene(0.02);
  Slide block;
  block.name = "block";
  block.kind = "rigid";
  block.shape.box = Box{{0.3, 0.05, 0.22}, {0.38, 0.15, 0.3}};
  block.density = 2000;
  s.slides = {block};
  FloatingBody raft;
  raft.name = "raft";
  raft.shape.box = Box{{0.04, 0.04, 0.16}, {0.16, 0.16, 0.24}};
  raft.density = 500;
  s.floating = {raft};
  BuildReport report;
  const Case c = build_case(s, report);
  ASSERT_EQ(c.bodies.size(), 2u);
  EXPECT_EQ(c.bodies[0].kind, BodyKind::free);
  EXPECT_NEAR(c.bodies[0].mass, 2000 * 0.08 * 0.1 * 0.08, 1e-9);
  EXPECT_NEAR(c.bodies[1].mass, 500 * 0.12 * 0.12 * 0.08, 1e-9);
  EXPECT_EQ(c.fluid.position.size(), 2000u - 6u * 6u * 2u);  // the raft's submerged half
}

TEST(CaseBuilder, MeshBodyThinnerThanDpIsRefused) {
  const Folder folder;
  std::ofstream(folder.file("plate.off")) << "OFF\n8 6 0\n0.1 0.05 0.101\n0.2 0.05 0.101\n0.1 0.15 0.101\n0.2 0.15 "
                                             "0.101\n0.1 0.05 0.103\n0.2 0.05 0.103\n0.1 0.15 0.103\n0.2 0.15 0.103\n"
                                             "4 0 4 6 2\n4 1 3 7 5\n4 0 1 5 4\n4 2 6 7 3\n4 0 2 3 1\n4 4 5 7 6\n";
  Scene s = tank_scene(0.02);
  MovingBody plate;
  plate.name = "plate";
  plate.kind = "body";
  plate.shape.mesh = folder.file("plate.off");
  s.moving = {plate};
  BuildReport report;
  EXPECT_MENTIONS(input_error([&] { build_case(s, report); }), "thinner than resolution.dp");
}

TEST(CaseBuilder, EmptySceneIsAnError) {
  Scene s;
  s.dp = 0.1;
  BuildReport report;
  EXPECT_MENTIONS(input_error([&] { build_case(s, report); }), "empty");
}

TEST(CaseBuilder, OffsetOnlyWhereItIsNeeded) {
  EXPECT_EQ(norm(choose_offset({{0, 0, 0}, {1, 1, 1}}, 3)), 0.0);
  EXPECT_EQ(norm(choose_offset({{-500, 0, 1500}, {900, 1000, 2300}}, 3)), 0.0);
  const Vec3d o = choose_offset({{1904800, 5773200, 62}, {1919200, 5794800, 921}}, 3);
  EXPECT_EQ(o.x, 1900000.0);
  EXPECT_EQ(o.y, 5770000.0);
  EXPECT_EQ(o.z, 0.0);
}

}  // namespace
}  // namespace gdesp::geometry
