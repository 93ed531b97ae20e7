// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/water_sheet.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "exact_fields.hpp"

namespace gdesp::analysis {
namespace {

constexpr double dp = 0.1;

// Still water at z = 1 on a beach z = x/2 - 1 (2 m wide): the shore is at x = 4.
struct Lake {
  Frame frame;
  RunInfo info;
  Lake() {
    frame.fluid.position =
        analysis_test::fill({0, 0, -1}, {6, 2, 1}, dp, 3, [](const Vec3d& p) { return p.z > 0.5 * p.x - 1.0 + 0.05; });
    frame.fluid.velocity.assign(frame.fluid.position.size(), Vec3f{3, 4, 0});
    info.dp = dp;
    info.walls.vertex = {{0, 0, -1}, {6, 0, 2}, {6, 2, 2}, {0, 2, -1}};
    info.walls.triangle = {{0, 1, 2}, {0, 2, 3}};
    info.walls.body = {0, 0};
  }
};

TEST(WaterSheet, LiesAtTheLevelAndReachesTheShore) {
  const Lake lake;
  FrameView view(lake.frame, lake.info);
  const WaterSheet sheet = make_water_sheet(view, 0.5 * dp);
  ASSERT_FALSE(sheet.vertex.empty());
  ASSERT_EQ(sheet.speed.size(), sheet.vertex.size());
  double furthest = 0.0;
  for (std::size_t k = 0; k < sheet.vertex.size(); ++k) {
    EXPECT_NEAR(sheet.vertex[k].z, 1.0, 0.5 * dp);
    EXPECT_NEAR(sheet.speed[k], 5.0, 1e-4);
    furthest = std::max(furthest, sheet.vertex[k].x);
  }
  EXPECT_GT(furthest, 4.0) << "the ground cuts the sheet at the shore";
  EXPECT_LT(furthest, 4.0 + 3.0 * dp);
  for (const auto& t : sheet.triangle) {
    const Vec3d normal = cross(sheet.vertex[t.y] - sheet.vertex[t.x], sheet.vertex[t.z] - sheet.vertex[t.x]);
    EXPECT_GT(normal.z, 0.0);
  }
}

// Where the ground ends under water (an edge that falls off), the sheet ends with the particles.
TEST(WaterSheet, DoesNotHangOverAnEdge) {
  Lake lake;
  std::erase_if(lake.frame.fluid.position, [](const Vec3d& p) { return p.x > 2.0; });
  lake.frame.fluid.velocity.resize(lake.frame.fluid.position.size());
  FrameView view(lake.frame, lake.info);
  double furthest = 0.0;
  for (const Vec3d& p : make_water_sheet(view, 0.5 * dp).vertex) furthest = std::max(furthest, p.x);
  EXPECT_LT(furthest, 2.0 + 2.0 * dp);
}

TEST(WaterSheet, NoWaterNoSheet) {
  const Frame nothing;
  RunInfo info;
  info.dp = dp;
  FrameView view(nothing, info);
  EXPECT_TRUE(make_water_sheet(view, dp).vertex.empty());
}

}  // namespace
}  // namespace gdesp::analysis
