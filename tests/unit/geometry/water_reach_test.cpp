// SPDX-License-Identifier: GPL-3.0-or-later
// Wall particles only where water can come to, and everywhere there.
#include "geometry/water_reach.hpp"

#include <map>

#include "geometry/case_builder.hpp"
#include "support.hpp"

namespace gdesp::geometry {
namespace {

using testing::field;
using testing::Folder;

/// A valley along x that falls eastward, 40 m high flanks; a dry valley beyond a ridge of 30 m at y = 200.
double valley(double x, double y) {
  return 10.0 - 0.05 * x + 30.0 * std::abs(std::sin(std::acos(-1.0) * (y - 100.0) / 200.0));
}

Scene lake(const Folder& folder, double run_up) {
  write_esri_ascii(field(0, 0, 2.0, 101, 201, valley), folder.file("valley.asc"), 6);
  Scene s;
  s.dp = 4.0;
  s.terrain.files = {folder.file("valley.asc")};
  s.run_up = run_up;
  s.numerics.wall_layers = "lattice";  // so that columns can be counted
  FluidFill fill;
  fill.level = 12.0;
  fill.polygon = {{20, 60}, {60, 60}, {60, 140}, {20, 140}};
  s.fluid.fill = {fill};
  return s;
}

using Columns = std::map<std::pair<long, long>, int>;

/// Wall particles per lattice column.
Columns columns_of(const Case& c, double dp) {
  Columns out;
  for (const auto& p : c.boundary.position)
    ++out[{std::lround((p.x + c.offset.x) / dp * 2), std::lround((p.y + c.offset.y) / dp * 2)}];
  return out;
}

TEST(WaterReach, EveryColumnBelowTheHeadHasAllItsWallParticles) {
  const Folder folder;
  Scene s = lake(folder, 8.0);
  BuildReport report, whole_report;
  const Case near = build_case(s, report);
  s.wall_particles = "all";
  const Case whole = build_case(s, whole_report);
  EXPECT_LT(near.boundary.position.size(), 0.8 * static_cast<double>(whole.boundary.position.size()));
  EXPECT_EQ(near.walls.triangle.size(), whole.walls.triangle.size()) << "grains meet all of the terrain";
  const Columns kept = columns_of(near, s.dp), all = columns_of(whole, s.dp);
  int below = 0, beyond = 0;
  for (const auto& [at, count] : all) {
    const double x = 0.5 * s.dp * static_cast<double>(at.first), y = 0.5 * s.dp * static_cast<double>(at.second);
    if (x < 0.0 || x > 200.0 || y < 0.0 || y > 190.0) continue;
    const auto found = kept.find(at);
    if (valley(x, y) < 12.0 + 8.0 - 1.0) {  // also down the valley, below the lake, to the domain's edge
      ++below;
      EXPECT_EQ(found == kept.end() ? 0 : found->second, count) << x << " " << y;
    } else if (valley(x, y) > 12.0 + 8.0 + 12.0) {
      beyond += found == kept.end();
    }
  }
  EXPECT_GT(below, 500);
  EXPECT_GT(beyond, 50);
  for (const auto& [at, count] : kept)
    EXPECT_LT(0.5 * s.dp * static_cast<double>(at.second), 230.0) << "nothing in the valley beyond the ridge";
}

TEST(WaterReach, ALowerRidgeLetsTheNextValleyIn) {
  const Folder folder;
  BuildReport report;
  const Case c = build_case(lake(folder, 30.0), report);
  double farthest = 0.0;
  for (const auto& p : c.boundary.position) farthest = std::max(farthest, p.y + c.offset.y);
  EXPECT_GT(farthest, 390.0);
}

TEST(WaterReach, RunUpFollowsTheExpectedSpeed) {
  Scene s;
  s.dp = 1.0;
  const std::vector<Vec3d> water = {{0, 0, 0.5}, {0, 0, 9.5}};
  EXPECT_NEAR(default_run_up(s, {}, water), 10.0, 1e-12);  // sqrt(2 g depth): the head is the depth
  s.numerics.expected_speed = 40.0;
  EXPECT_NEAR(default_run_up(s, {}, water), 1600.0 / (2.0 * 9.81), 1e-9);
  EXPECT_EQ(default_run_up(s, {}, {}), 0.0);
}

}  // namespace
}  // namespace gdesp::geometry
