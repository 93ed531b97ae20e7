// SPDX-License-Identifier: GPL-3.0-or-later
// A wall too thin for the particles is named; one that is thick enough, or has water behind it, is not.
#include "geometry/case_builder.hpp"
#include "support.hpp"

namespace gdesp::geometry {
namespace {

using testing::Folder;

constexpr double dp = 0.02;

std::string obj(const TriangleMesh& m) {
  std::string text;
  for (const auto& v : m.vertex)
    text += "v " + std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "\n";
  for (const auto& t : m.triangle)
    text += "f " + std::to_string(t.x + 1) + " " + std::to_string(t.y + 1) + " " + std::to_string(t.z + 1) + "\n";
  return text;
}

/// A tank 1 m long, water 0.3 m deep left of a wall whose right face is at x = 0.59 m, turned about the vertical.
Scene dam(const Folder& folder, double thickness, double turn = 0.0) {
  TriangleMesh wall = box_mesh({{0.59 - thickness, -1, -0.1}, {0.59, 2, 0.4}});
  for (auto& v : wall.vertex) {
    const double x = v.x - 0.5, y = v.y - 0.2;
    v.x = 0.5 + std::cos(turn) * x - std::sin(turn) * y;
    v.y = 0.2 + std::sin(turn) * x + std::cos(turn) * y;
  }
  Scene s;
  s.dp = dp;
  Wall tank, mesh;
  tank.name = "tank";
  tank.tank = Box{{0, 0, 0}, {1, 0.4, 0.5}};
  tank.open = {"top"};
  mesh.name = "dam";
  mesh.mesh = folder.write("dam.obj", obj(wall));
  s.walls = {tank, mesh};
  FluidFill fill;
  fill.kind = "box";
  fill.box = Box{{0, 0, 0}, {0.3, 0.4, 0.3}};
  s.fluid.fill = {fill};
  return s;
}

std::string warning_of(const Scene& s) {
  BuildReport report;
  build_case(s, report, {.scope = BuildScope::counts_only});
  for (const auto& w : report.notes.warnings) {
    if (w.find("thick") != std::string::npos) return w;
  }
  return "";
}

Scene filled_to_the_wall(Scene s, double x) {
  s.fluid.fill[0].box->upper.x = x;
  return s;
}

TEST(ThinWalls, NamedWithPlaceAndTheSpacingThatHolds) {
  const Folder folder;
  const std::string w = warning_of(filled_to_the_wall(dam(folder, 0.03), 0.56));
  EXPECT_NE(w.find("only 0.03 m thick"), std::string::npos) << w;
  EXPECT_NE(w.find("x = 0.55 m"), std::string::npos) << w;
  EXPECT_NE(w.find("resolution.dp = 0.015 m"), std::string::npos) << w;
}

TEST(ThinWalls, ThickOnesPass) {
  const Folder folder;
  EXPECT_EQ(warning_of(filled_to_the_wall(dam(folder, 0.05), 0.54)), "");
  EXPECT_EQ(warning_of(dam(folder, 0.03)), "") << "no water touches it";
}

TEST(ThinWalls, WaterBehindAWallIsNoOpenSpace) {
  const Folder folder;
  Scene s = filled_to_the_wall(dam(folder, 0.03), 0.56);
  FluidFill behind = s.fluid.fill[0];
  behind.box = Box{{0.59, 0, 0}, {1, 0.4, 0.3}};
  s.fluid.fill.push_back(behind);
  EXPECT_EQ(warning_of(s), "");
}

/// At 30 degrees a wall is longer along the axes than across; what counts is across.
TEST(ThinWalls, AslantWallsAreMeasuredAcross) {
  const Folder folder;
  Scene s = dam(folder, 0.03, 0.5235987755982988);
  s.fluid.fill[0] = {};
  s.fluid.fill[0].level = 0.3;
  s.fluid.fill[0].seed = Point2{0.1, 0.2};
  const std::string w = warning_of(s);
  ASSERT_NE(w.find("m thick"), std::string::npos) << w;
  EXPECT_NEAR(std::stod(w.substr(w.find("only ") + 5)), 0.03, 0.25 * dp) << w;
  Scene thick = dam(folder, 0.055, 0.5235987755982988);
  thick.fluid = s.fluid;
  EXPECT_EQ(warning_of(thick), "");
}

}  // namespace
}  // namespace gdesp::geometry
