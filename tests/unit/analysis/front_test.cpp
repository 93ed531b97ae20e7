// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/front.hpp"

#include <gtest/gtest.h>

#include "exact_fields.hpp"

namespace gdesp::analysis {
namespace {

using analysis_test::fill_under;

TEST(LeadingEdge, ABlockEndsWhereItEnds) {
  const auto block = analysis_test::fill({0, 0, 0}, {2, 1, 1}, 0.1, 3, [](const Vec3d&) { return true; });
  EXPECT_NEAR(*leading_edge(block, {1, 0, 0}, 0.0, 0.1), 2.0, 1e-9);
  EXPECT_NEAR(*leading_edge(block, {1, 0, 0}, 0.25, 0.1), 1.5, 1e-6);
  EXPECT_NEAR(*leading_edge(block, {-1, 0, 0}, 0.05, 0.1), -0.1, 1e-6);
}

// Ritter's profile h = (2 c - x/t)^2 / (9 g) between -c t and 2 c t; the volume beyond x is t (2c - x/t)^3 / (27 g).
TEST(LeadingEdge, RitterDamBreak) {
  const double g = 9.81, h0 = 0.3, t = 0.4, c = std::sqrt(g * h0), reservoir = 2.0;
  const auto depth = [&](double x, double) {
    if (x <= -c * t) return h0;
    return x >= 2 * c * t ? 0.0 : (2 * c - x / t) * (2 * c - x / t) / (9 * g);
  };
  const double volume = reservoir * h0;
  double last = 1e9;
  for (const double dp : {0.01, 0.005, 0.0025}) {
    const auto water = fill_under(depth, {-reservoir, 0, 0}, {2.0, 0, 1}, dp, 2);
    double worst = 0.0;
    for (const double phi : {0.002, 0.005, 0.02}) {
      const double exact = t * (2 * c - std::cbrt(27 * g * phi * volume / t));
      worst = std::max(worst, std::abs(*leading_edge(water, {1, 0, 0}, phi, dp) - exact));
    }
    EXPECT_LT(worst, 3.0 * dp) << dp;
    EXPECT_LT(worst, last);
    last = worst;
  }
}

TEST(LeadingEdge, RunawaysDoNotMoveTheFront) {
  auto block = analysis_test::fill({0, 0, 0}, {2, 1, 1}, 0.1, 3, [](const Vec3d&) { return true; });
  const double before = *leading_edge(block, {1, 0, 0}, 0.005, 0.1);
  block.push_back({5, 0.5, 0.5});
  EXPECT_NEAR(*leading_edge(block, {1, 0, 0}, 0.005, 0.1), before, 0.02);
  EXPECT_NEAR(*leading_edge(block, {1, 0, 0}, 0.0, 0.1), 5.05, 1e-9);
}

TEST(LeadingEdge, GrainsCountByTheirVolume) {
  const std::vector<Vec3d> grains{{0, 0, 0}, {1, 0, 0}};
  const std::vector<double> volume{8.0, 1.0};
  const std::vector<float> size{0.2f, 0.1f};
  EXPECT_NEAR(*leading_edge(grains, {1, 0, 0}, 0.0, 0, volume, size), 1.05, 1e-6);
  EXPECT_NEAR(*leading_edge(grains, {1, 0, 0}, 0.5 / 9.0, 0, volume, size), 1.0, 1e-6);
  EXPECT_NEAR(*leading_edge(grains, {1, 0, 0}, 5.0 / 9.0, 0, volume, size), 0.0, 1e-6);
  EXPECT_FALSE(leading_edge({}, {1, 0, 0}, 0.0, 0.1));
}

TEST(FirstDeparture, IsInterpolated) {
  const std::vector<double> t{0, 1, 2, 3}, y{1.0, 1.0, 1.4, 0.0};
  EXPECT_NEAR(*first_departure(t, y, 0.1), 1.25, 1e-12);
  EXPECT_NEAR(*first_departure(t, std::vector<double>{1.0, 1.0, 0.6, 0.0}, 0.1), 1.25, 1e-12);
  EXPECT_FALSE(first_departure(t, y, 2.0));
}

TEST(FirstDeparture, SkipsWhatWasNotMeasured) {
  const double none = std::nan("");
  const std::vector<double> t{0, 1, 2, 3};
  EXPECT_NEAR(*first_departure(t, std::vector<double>{none, 1.0, none, 2.0}, 0.5), 2.0, 1e-12);
  EXPECT_FALSE(first_departure(t, std::vector<double>(4, none), 0.5));
}

}  // namespace
}  // namespace gdesp::analysis
