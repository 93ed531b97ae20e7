// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/slide_state.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace gdesp::analysis {
namespace {

TEST(CapShare, ByHand) {
  EXPECT_NEAR(cap_share(0.0, 2.0, 0.0, 3), 0.5, 1e-12);
  EXPECT_NEAR(cap_share(0.0, 2.0, -1.0, 3), 0.0, 1e-12);
  EXPECT_NEAR(cap_share(0.0, 2.0, 5.0, 3), 1.0, 1e-12);
  EXPECT_NEAR(cap_share(0.0, 2.0, -0.5, 3), 5.0 / 32.0, 1e-12);  // h = R/2: pi h^2 (3R - h)/3 = 5 pi/24 of 4 pi/3
  EXPECT_NEAR(cap_share(0.0, 2.0, 0.0, 2), 0.5, 1e-12);
  // Segment of height R/2: R^2 (pi/3 - sqrt(3)/4) of pi R^2.
  EXPECT_NEAR(cap_share(0.0, 2.0, -0.5, 2), 1.0 / 3.0 - std::sqrt(3.0) / (4.0 * std::numbers::pi), 1e-12);
}

TEST(MeasureGrains, SumsByMass) {
  GrainTable g;
  g.position = {{0, 0, 1}, {3, 0, -1}};
  g.diameter = {1.0f, 1.0f};
  g.density = {1000.0f, 2000.0f};
  g.velocity = {{3, 0, 0}, {0, 0, 3}};
  const SlideState s = measure_grains(g, 3, [](double, double) { return std::optional<double>(0.0); });
  EXPECT_NEAR(s.mass, 3000.0 * std::numbers::pi / 6.0, 1e-6);
  EXPECT_NEAR(s.centre.x, 2.0, 1e-12);
  EXPECT_NEAR(s.centre.z, -1.0 / 3.0, 1e-12);
  EXPECT_NEAR(s.velocity.x, 1.0, 1e-12);
  EXPECT_NEAR(s.velocity.z, 2.0, 1e-12);
  EXPECT_NEAR(s.submerged, 0.5, 1e-12);
  EXPECT_NEAR(s.fastest, 3.0, 1e-12);
}

TEST(MeasureGrains, DryGroundSubmergesNothing) {
  GrainTable g;
  g.position = {{0, 0, -5}};
  g.diameter = {1.0f};
  EXPECT_EQ(measure_grains(g, 3, [](double, double) { return std::optional<double>(); }).submerged, 0.0);
}

TEST(MeasureBody, ABoxHalfInWater) {
  TriangleTable box;
  for (int k = 0; k < 8; ++k) box.vertex.push_back({k & 1 ? 2.0 : 0.0, k & 2 ? 1.0 : 0.0, k & 4 ? 4.0 : 0.0});
  box.triangle = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                  {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const SlideState s = measure_body(box, 0.25, [](double, double) { return std::optional<double>(1.0); });
  EXPECT_NEAR(s.volume, 8.0, 1e-9);
  EXPECT_NEAR(s.centre.x, 1.0, 1e-6);
  EXPECT_NEAR(s.centre.z, 2.0, 1e-6);
  EXPECT_NEAR(s.submerged, 0.25, 1e-9);
}

}  // namespace
}  // namespace gdesp::analysis
