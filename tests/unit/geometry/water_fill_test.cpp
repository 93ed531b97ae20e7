// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>

#include "geometry/case_builder.hpp"
#include "particles/surface_rows.hpp"
#include "support.hpp"

namespace gdesp::geometry {
namespace {

using testing::field;
using testing::Folder;
using testing::input_error;

/// Two bowls, 20 m deep, side by side along x: centres (50, 50) and (150, 50), ridge between them at 15 m, rim at 20 m.
double two_bowls(double x, double y) {
  const double u = std::fmod(x, 100.0) - 50.0, v = y - 50.0;
  const double bowl = 20.0 * (u * u + v * v) / 2500.0;
  return std::min(bowl, std::abs(x - 100.0) < 30.0 ? 15.0 : 20.0);
}

Scene bowls(const Folder& folder, double dp) {
  write_esri_ascii(field(0, 0, 1.0, 201, 101, two_bowls), folder.file("bowls.asc"), 6);
  Scene s;
  s.dp = dp;
  s.terrain.files = {folder.file("bowls.asc")};
  FluidFill fill;
  fill.level = 10.0;
  fill.seed = Point2{50.0, 50.0};
  s.fluid.fill = {fill};
  return s;
}

/// Volume of a bowl z = 20 r^2 / 2500 below z = level: pi 2500 level^2 / 40.
double bowl_volume(double level) { return std::acos(-1.0) * 2500.0 * level * level / 40.0; }

/// The lattice point of a particle that stands in a row below the level (m).
Vec3d on_lattice(Vec3d p, double level, double dp) {
  static const std::vector<double> shift = surface_row_shifts(1.5, 3);
  const double row = std::round((level - p.z) / dp - 0.5);
  if (row >= 0.0 && row < static_cast<double>(shift.size())) p.z -= shift[static_cast<std::size_t>(row)] * dp;
  return p;
}

TEST(WaterFill, OnlyTheConnectedBasin) {
  const Folder folder;
  BuildReport report;
  const Case c = build_case(bowls(folder, 2.0), report);
  EXPECT_GT(c.fluid.position.size(), 500u);
  for (const auto& p : c.fluid.position) EXPECT_LT(p.x + c.offset.x, 90.0);
  EXPECT_NEAR(report.fills[0].exact_volume, bowl_volume(10.0), 0.005 * bowl_volume(10.0));
  EXPECT_TRUE(report.notes.warnings.empty());
}

TEST(WaterFill, OverTheRidgeBothBasinsFill) {
  const Folder folder;
  Scene s = bowls(folder, 2.0);
  s.fluid.fill[0].level = 17.0;
  BuildReport report;
  const Case c = build_case(s, report);
  double farthest = 0.0;
  for (const auto& p : c.fluid.position) farthest = std::max(farthest, p.x + c.offset.x);
  EXPECT_GT(farthest, 180.0);
}

TEST(WaterFill, ParticleVolumeErrorFallsWithSpacing) {
  const Folder folder;
  double last = 1.0;
  for (const double dp : {4.0, 2.0, 1.0}) {
    BuildReport report;
    build_case(bowls(folder, dp), report);
    const double error = std::abs(report.fills[0].volume / bowl_volume(10.0) - 1.0);
    EXPECT_LT(error, 0.03 * dp / 2.0);
    EXPECT_LE(error, last + 0.002);
    last = error;
  }
  EXPECT_LT(last, 0.005);
}

TEST(WaterFill, TheWaterSurfaceLiesAtTheLevel) {
  const Folder folder;
  BuildReport report;
  const Case c = build_case(bowls(folder, 2.0), report);
  double top = -1e9;
  for (const auto& p : c.fluid.position) top = std::max(top, p.z + c.offset.z);
  EXPECT_NEAR(top, 10.0 - 1.0 + 2.0 * surface_row_shifts(1.5, 3)[0],
              1e-9);  // centre of the uppermost cell, and where its row rests
  EXPECT_NEAR(c.still_water_level + c.offset.z, 10.0, 1e-9);
}

// Wall particles begin where fluid particles end: every lattice neighbour of a fluid particle below the level is fluid or wall.
TEST(WaterFill, FluidAndWallsCompleteTheLattice) {
  const Folder folder;
  BuildReport report;
  const Case c = build_case(bowls(folder, 2.0), report);
  const auto key = [](const Vec3d& p) {
    return std::array<long, 3>{std::lround(p.x / 1e-3), std::lround(p.y / 1e-3), std::lround(p.z / 1e-3)};
  };
  const auto lattice = [&](const Vec3d& p) { return on_lattice(p, c.still_water_level, 2.0); };
  std::vector<std::array<long, 3>> all;
  for (const auto& p : c.fluid.position) all.push_back(key(lattice(p)));
  for (const auto& p : c.boundary.position) all.push_back(key(lattice(p)));
  std::sort(all.begin(), all.end());
  EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());  // nothing twice
  std::size_t missing = 0;
  for (const auto& p : c.fluid.position) {
    for (int dx = -2; dx <= 2; ++dx) {
      for (int dy = -2; dy <= 2; ++dy) {
        for (int dz = -2; dz <= 0; ++dz) {
          const Vec3d q = lattice(p) + Vec3d{2.0 * dx, 2.0 * dy, 2.0 * dz};
          missing += !std::binary_search(all.begin(), all.end(), key(q));
        }
      }
    }
  }
  EXPECT_EQ(missing, 0u);
}

// A bed that runs exactly through lattice points: each of them is water or wall, not both and not neither.
TEST(WaterFill, BedThroughLatticePoints) {
  const Folder folder;
  write_esri_ascii(
      field(0, 0, 2.0, 21, 21,
            [](double x, double y) { return std::max(std::abs(x - 20), std::abs(y - 20)) > 14 ? 20.0 : 0.0; }),
      folder.file("pan.asc"), 3);
  Scene s;
  s.dp = 2.0;
  s.terrain.files = {folder.file("pan.asc")};
  FluidFill fill;
  fill.level = 5.0;  // cell centres at 4, 2, 0: the bed
  fill.seed = Point2{20, 20};
  s.fluid.fill = {fill};
  BuildReport report;
  const Case c = build_case(s, report);
  std::vector<std::array<long, 3>> all;
  for (const auto* list : {&c.fluid.position, &c.boundary.position}) {
    for (const auto& placed : *list) {
      const Vec3d p = on_lattice(placed, 5.0, s.dp);
      if (std::abs(p.x - 20) < 8 && std::abs(p.y - 20) < 8 && p.z > -5.0)
        all.push_back({std::lround(p.x * 1e3), std::lround(p.y * 1e3), std::lround(p.z * 1e3)});
    }
  }
  std::sort(all.begin(), all.end());
  EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
  // Per column 4, 2, 0 and -2, -4; the third layer of wall, at exactly three spacings, lies on the edge of the band.
  std::vector<std::array<long, 2>> columns;
  for (const auto& p : all) columns.push_back({p[0], p[1]});
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  EXPECT_EQ(all.size(), 5 * columns.size());
  for (const auto& p : all) EXPECT_EQ(p[2] % 2000, 0);
}

TEST(WaterFill, PolygonSeedsAndBounds) {
  const Folder folder;
  Scene s = bowls(folder, 2.0);
  s.fluid.fill[0].seed.reset();
  s.fluid.fill[0].polygon = {{100, -10}, {210, -10}, {210, 110}, {100, 110}};
  BuildReport report;
  const Case c = build_case(s, report);
  for (const auto& p : c.fluid.position) EXPECT_GT(p.x + c.offset.x, 110.0);
  EXPECT_NEAR(report.fills[0].exact_volume, bowl_volume(10.0), 0.01 * bowl_volume(10.0));
}

TEST(WaterFill, PolygonThatCutsTheLakeIsToldAbout) {
  const Folder folder;
  Scene s = bowls(folder, 2.0);
  s.fluid.fill[0].polygon = {{-10, -10}, {50, -10}, {50, 110}, {-10, 110}};  // half the bowl, no wall at x = 50
  s.fluid.fill[0].seed = Point2{45, 50};
  BuildReport report;
  build_case(s, report);
  EXPECT_NEAR(report.fills[0].exact_volume, 0.5 * bowl_volume(10.0), 0.02 * bowl_volume(10.0));
  ASSERT_EQ(report.notes.warnings.size(), 1u);
  EXPECT_MENTIONS(report.notes.warnings[0], "no wall holds the water");
  EXPECT_NEAR(report.fills[0].open_edge, 70.7, 8.0);  // the chord: 2 sqrt(1250) m
}

/// A valley along y, 40 m of it, its floor at z = 0 and x = 50.
Scene valley(const Folder& folder, double dp) {
  write_esri_ascii(field(0, -20, 1.0, 101, 81, [](double x, double) { return 0.02 * (x - 50.0) * (x - 50.0); }),
                   folder.file("valley.asc"), 6);
  Scene s;
  s.dp = dp;
  s.domain = Box{{0.0, 0.0, -10.0}, {100.0, 40.0, 60.0}};
  s.terrain.files = {folder.file("valley.asc")};
  FluidFill fill;
  fill.level = 10.0;
  s.fluid.fill = {fill};
  return s;
}

TEST(WaterFill, WhatRepeatsHoldsItsWater) {
  const Folder folder;
  for (const bool repeats : {false, true}) {
    Scene s = valley(folder, 2.0);
    if (repeats) s.periodic = {"y"};
    BuildReport report;
    build_case(s, report);
    EXPECT_EQ(report.fills[0].open_edge == 0.0, repeats);
    EXPECT_EQ(report.notes.warnings.empty(), repeats);
  }
}

TEST(WaterFill, SlidesStayInsideThePeriod) {
  const Folder folder;
  for (const double width : {40.0, 50.0}) {
    Scene s = valley(folder, 4.0);
    s.periodic = {"y"};
    Slide slide;
    slide.name = "rock";
    slide.kind = "granular";
    slide.shape.box = Box{{5.0, 0.0, 45.0}, {15.0, width, 55.0}};
    slide.diameter = 4.0;
    s.slides = {slide};
    BuildReport report;
    if (width <= 40.0) {
      EXPECT_EQ(build_case(s, report).domain.upper.y - build_case(s, report).domain.lower.y, 40.0);
    } else {
      const std::string text = input_error([&] { build_case(s, report); });
      EXPECT_MENTIONS(text, "slide \"rock\"");
      EXPECT_MENTIONS(text, "out of the period of the domain along y, 0 m to 40 m");
    }
  }
}

TEST(WaterFill, ErrorsNameTheKeyAndTheGround) {
  const Folder folder;
  Scene s = bowls(folder, 2.0);
  s.fluid.fill[0].level = -5.0;
  s.fluid.fill[0].seed.reset();
  BuildReport report;
  std::string text = input_error([&] { build_case(s, report); });
  EXPECT_MENTIONS(text, "fluid.fill.0.level = -5 m is below the bed");
  s.fluid.fill[0].level = 10.0;
  s.fluid.fill[0].seed = Point2{101.0, 51.0};  // on the ridge
  text = input_error([&] { build_case(s, report); });
  EXPECT_MENTIONS(text, "fluid.fill.0.seed");
  EXPECT_MENTIONS(text, "stands on ground at 15 m");
  s.fluid.fill[0].seed = Point2{500.0, 50.0};
  EXPECT_MENTIONS(input_error([&] { build_case(s, report); }), "outside the domain");
}

TEST(WaterFill, TwoLakesWithTwoLevels) {
  const Folder folder;
  Scene s = bowls(folder, 2.0);
  FluidFill second;
  second.level = 5.0;
  second.seed = Point2{150, 50};
  s.fluid.fill.push_back(second);
  BuildReport report;
  const Case c = build_case(s, report);
  EXPECT_NEAR(report.fills[1].exact_volume, bowl_volume(5.0), 0.02 * bowl_volume(5.0));
  EXPECT_EQ(c.fluid.position.size(), report.fills[0].particles + report.fills[1].particles);
}

TEST(WaterFill, ClosedMeshInsideATank) {
  const Folder folder;
  std::ofstream(folder.file("drop.off")) << [] {
    const TriangleMesh m = testing::sphere({0.5, 0.5, 0.5}, 0.3, 24);
    std::string t = "OFF\n" + std::to_string(m.vertex.size()) + " " + std::to_string(m.triangle.size()) + " 0\n";
    for (const auto& v : m.vertex)
      t += std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "\n";
    for (const auto& f : m.triangle)
      t += "3 " + std::to_string(f.x) + " " + std::to_string(f.y) + " " + std::to_string(f.z) + "\n";
    return t;
  }();
  Scene s;
  s.dp = 0.02;
  Wall tank;
  tank.name = "tank";
  tank.tank = Box{{0, 0, 0}, {1, 1, 1}};
  s.walls = {tank};
  FluidFill fill;
  fill.kind = "mesh";
  fill.mesh = folder.file("drop.off");
  s.fluid.fill = {fill};
  BuildReport report;
  build_case(s, report);
  const double exact = 4.0 / 3.0 * std::acos(-1.0) * 0.027;
  EXPECT_NEAR(report.fills[0].volume, exact, 0.015 * exact);
}

}  // namespace
}  // namespace gdesp::geometry
