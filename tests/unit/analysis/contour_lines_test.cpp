// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <numbers>

#include "analysis/map_measurement.hpp"

namespace gdesp::analysis {
namespace {

double length_of(const std::vector<Point2>& line) {
  double sum = 0.0;
  for (std::size_t k = 1; k < line.size(); ++k) sum += std::hypot(line[k].x - line[k - 1].x, line[k].y - line[k - 1].y);
  return sum;
}

TEST(ContourLines, ACircleIsOneClosedLine) {
  Raster r = make_raster({-2, -2, 0}, {2, 2, 0}, 0.1, 3);
  for (int iy = 0; iy < r.ny; ++iy) {
    for (int ix = 0; ix < r.nx; ++ix) r.at(ix, iy) = static_cast<float>(std::hypot(r.x(ix), r.y(iy)));
  }
  const auto lines = contour_lines(r, 1.0);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NEAR(lines[0].front().x, lines[0].back().x, 1e-9);
  EXPECT_NEAR(lines[0].front().y, lines[0].back().y, 1e-9);
  EXPECT_NEAR(length_of(lines[0]), 2.0 * std::numbers::pi, 0.02);
  for (const Point2& p : lines[0]) EXPECT_NEAR(std::hypot(p.x, p.y), 1.0, 0.01);
}

TEST(ContourLines, AnOpenLineCrossesTheRaster) {
  Raster r = make_raster({0, 0, 0}, {4, 2, 0}, 0.5, 3);
  for (int iy = 0; iy < r.ny; ++iy) {
    for (int ix = 0; ix < r.nx; ++ix) r.at(ix, iy) = static_cast<float>(r.x(ix) - 1.3);
  }
  const auto lines = contour_lines(r, 0.0);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NEAR(length_of(lines[0]), 2.0, 1e-6);
  for (const Point2& p : lines[0]) EXPECT_NEAR(p.x, 1.3, 1e-6);
}

TEST(ContourLines, ASaddleMakesTwoLines) {
  Raster r = make_raster({0, 0, 0}, {1, 1, 0}, 1.0, 3);
  r.value = {1, 0, 0, 1};
  EXPECT_EQ(contour_lines(r, 0.4).size(), 2u);
  EXPECT_EQ(contour_lines(r, 0.6).size(), 2u);
  EXPECT_TRUE(contour_lines(r, 2.0).empty());
}

}  // namespace
}  // namespace gdesp::analysis
