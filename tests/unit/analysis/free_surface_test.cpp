// SPDX-License-Identifier: GPL-3.0-or-later
// The free surface against shapes whose surface is known.
#include "analysis/free_surface.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "analysis/smoothing.hpp"
#include "core/error.hpp"
#include "exact_fields.hpp"

namespace gdesp::analysis {
namespace {

using analysis_test::fill;
using analysis_test::fill_under;

const auto everywhere = [](const Vec3d&) { return true; };

TEST(Smoothing, WeightIntegratesToOne) {
  for (const int d : {2, 3}) {
    double sum = 0.0;
    const int n = 2000;
    for (int k = 0; k < n; ++k) {
      const double r = 2.0 * (k + 0.5) / n;
      sum += wendland_shape(r * r) * (d == 2 ? 2.0 * std::numbers::pi * r : 4.0 * std::numbers::pi * r * r) * 2.0 / n;
    }
    EXPECT_NEAR(sum * wendland_normalisation(1.0, d), 1.0, 1e-5) << d;
  }
}

TEST(Smoothing, LayerResponseHasItsLimits) {
  const LayerResponse& r = layer_response(3);
  EXPECT_NEAR(r.edge(2.0), 0.5, 1e-12);
  EXPECT_NEAR(r.middle(4.0), 1.0, 1e-12);
  // w(0) = int_0^2 W 2 pi r dr = 21/16 * 2 * int_0^2 (1-r/2)^4 (2r+1) r dr = 0.75 (by hand: the integral is 2/7)
  EXPECT_NEAR(r.edge(0.01) / 0.01, 0.75, 2e-3);
  EXPECT_NEAR(r.thickness_from_ratio(1.2 / r.middle(1.2)), 1.2, 1e-3);
}

// Still water: every place of the lattice against the reading point, deep and near the walls, 2D and 3D.
TEST(FreeSurface, StillWaterWithinATenthOfTheSpacing) {
  const double dp = 0.1;
  for (const int d : {2, 3}) {
    const auto water = fill({0, 0, 0}, {3, 2, 1.5}, dp, d, everywhere);
    const FluidSampler sampler(water, {}, dp, d);
    for (double x = 0.02; x < 3.0; x += 0.0617) {
      const auto level = sampler.surface_level(x, 1.013);
      ASSERT_TRUE(level) << x;
      EXPECT_NEAR(*level, 1.5, 0.1 * dp) << "x " << x << ", dimensions " << d;
    }
  }
}

TEST(FreeSurface, DisorderedStillWaterStaysWithinATenthOnAverage) {
  const double dp = 0.1;
  const auto water = fill({0, 0, 0}, {3, 2, 1.5}, dp, 3, everywhere, 0.15);
  const FluidSampler sampler(water, {}, dp, 3);
  double sum = 0.0, worst = 0.0;
  int count = 0;
  for (double x = 0.2; x < 2.8; x += 0.0917) {
    for (double y = 0.2; y < 1.8; y += 0.0917) {
      const double error = sampler.surface_level(x, y).value() - 1.5;
      sum += error;
      worst = std::max(worst, std::abs(error));
      ++count;
    }
  }
  EXPECT_LT(std::abs(sum / count), 0.1 * dp);
  EXPECT_LT(worst, 0.2 * dp);
}

// Sheets from one particle to many: the level is where the water ends, not where half of the deep water's weight is.
TEST(FreeSurface, ThinSheets) {
  const double dp = 0.1;
  for (int layers = 1; layers <= 6; ++layers) {
    const auto sheet = fill({0, 0, 0}, {2, 2, layers * dp}, dp, 3, everywhere);
    const FluidSampler sampler(sheet, {}, dp, 3);
    EXPECT_NEAR(sampler.surface_level(1.03, 0.97).value(), layers * dp, 0.15 * dp) << layers << " layers";
  }
}

TEST(FreeSurface, InclinedPlane) {
  const double dp = 0.05;
  const auto eta = [](double x, double y) { return 1.0 + 0.2 * x + 0.1 * y; };
  const auto water = fill_under(eta, {0, 0, 0}, {3, 2, 2}, dp, 3);
  const FluidSampler sampler(water, {}, dp, 3);
  for (double x = 0.3; x < 2.7; x += 0.0713) {
    EXPECT_NEAR(sampler.surface_level(x, 1.0).value(), eta(x, 1.0), 0.15 * dp) << x;
  }
}

TEST(FreeSurface, SineWaveAndItsConvergence) {
  const auto eta = [](double x, double) { return 0.5 + 0.05 * std::sin(2.0 * std::numbers::pi * x); };
  double before = 0.0;
  for (const double dp : {0.04, 0.02, 0.01}) {
    const auto water = fill_under(eta, {0, 0, 0}, {2, 0, 1}, dp, 2);
    const FluidSampler sampler(water, {}, dp, 2);
    double sum = 0.0;
    int count = 0;
    for (double x = 0.25; x < 1.75; x += 0.0101, ++count) {
      const double error = sampler.surface_level(x, 0).value() - eta(x, 0);
      EXPECT_LT(std::abs(error), 0.35 * dp) << x;
      sum += error * error;
    }
    const double rms = std::sqrt(sum / count);
    EXPECT_LT(rms, 0.12 * dp);
    if (before > 0.0) { EXPECT_LT(rms, 0.7 * before) << "halving dp must at least nearly halve the error"; }
    before = rms;
  }
}

TEST(FreeSurface, SphereCap) {
  const double dp = 0.02, radius = 0.5;
  const auto drop = fill({-0.6, -0.6, 0}, {0.6, 0.6, 0.6}, dp, 3, [&](const Vec3d& p) { return norm(p) < radius; });
  const FluidSampler sampler(drop, {}, dp, 3);
  for (const double r : {0.0, 0.11, 0.2, 0.31}) {
    double sum = 0.0;
    for (int k = 0; k < 16; ++k) {
      const double a = 2.0 * std::numbers::pi * (k + 0.3) / 16;
      sum += sampler.surface_level(r * std::cos(a), r * std::sin(a)).value() / 16;
    }
    EXPECT_NEAR(sum, std::sqrt(radius * radius - r * r), 0.35 * dp) << r;
  }
}

TEST(FreeSurface, DropsAboveAreNotTheSurface) {
  const double dp = 0.1;
  auto water = fill({0, 0, 0}, {2, 2, 1}, dp, 3, everywhere);
  water.push_back({1.0, 1.0, 1.9});
  water.push_back({1.0, 1.1, 3.0});
  const FluidSampler sampler(water, {}, dp, 3);
  EXPECT_NEAR(sampler.surface_level(1.0, 1.02).value(), 1.0, 0.1 * dp);
}

TEST(FreeSurface, DryGroundIsDry) {
  const auto water = fill({0, 0, 0}, {2, 2, 1}, 0.1, 3, everywhere);
  const FluidSampler sampler(water, {}, 0.1, 3);
  EXPECT_FALSE(sampler.surface_level(2.5, 1.0));
  const FluidSampler nothing({}, {}, 0.1, 3);
  EXPECT_FALSE(nothing.surface_level(0.0, 0.0));
  EXPECT_EQ(nothing.fluid_fraction({0, 0, 0}), 0.0);
}

// In a mixture each fluid particle stands for more space: the level must not sink where grains are.
TEST(FreeSurface, PorosityDoesNotLowerTheLevel) {
  const double dp = 0.1, eps = 0.4;
  const double spread = dp / std::cbrt(eps);
  const auto water = fill({0, 0, 0}, {20 * spread, 20 * spread, 10 * spread}, spread, 3, everywhere);
  const std::vector<float> porosity(water.size(), static_cast<float>(eps));
  const FluidSampler sampler(water, porosity, dp, 3);
  EXPECT_NEAR(sampler.surface_level(10 * spread, 10 * spread).value(), 10 * spread, 0.3 * dp);
}

TEST(FluidSampler, HydrostaticPressureIsReadWithoutBias) {
  const double dp = 0.05, gamma = 9810.0;
  const auto water = fill({0, 0, 0}, {1, 1, 1}, dp, 3, everywhere);
  std::vector<float> pressure;
  for (const Vec3d& p : water) pressure.push_back(static_cast<float>(gamma * (1.0 - p.z)));
  const FluidSampler sampler(water, {}, dp, 3);
  // On the wall x = 0, on the floor and inside.
  for (const Vec3d at : {Vec3d{0, 0.5, 0.3}, Vec3d{0.5, 0.5, 0.0}, Vec3d{0.52, 0.47, 0.81}}) {
    EXPECT_NEAR(sampler.sample(at, pressure, -gamma).value(), gamma * (1.0 - at.z), 0.5) << at.z;
  }
  EXPECT_FALSE(sampler.sample({0.5, 0.5, 1.3}, pressure, -gamma));
}

TEST(FreeSurface, BruteForceAgreesWithTheGrid) {
  const double dp = 0.1, h = smoothing_ratio * dp;
  const auto water = fill({0, 0, 0}, {1, 1, 1}, dp, 3, everywhere, 0.3);
  const FluidSampler sampler(water, {}, dp, 3);
  for (const Vec3d at : {Vec3d{0.5, 0.5, 0.5}, Vec3d{0.0, 0.99, 1.05}, Vec3d{-0.1, 0.3, 0.2}}) {
    double sum = 0.0;
    for (const Vec3d& p : water) sum += dp * dp * dp * wendland_shape(dot(at - p, at - p) / (h * h));
    EXPECT_NEAR(sampler.fluid_fraction(at), sum * wendland_normalisation(h, 3), 1e-12);
  }
}

TEST(ColumnGrid, RefusesAPositionThatIsNotFinite) {
  const std::vector<Vec3d> bad{{0, 0, 0}, {std::nan(""), 0, 0}};
  try {
    const ColumnGrid grid(bad, 1.0, 3);
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::numerical);
    EXPECT_NE(std::string(e.what()).find("particle 1"), std::string::npos) << e.what();
  }
}

TEST(ColumnGrid, AFarAwayParticleCostsNoTable) {
  const std::vector<Vec3d> stray{{0, 0, 0}, {1e7, 1e7, 0}, {0.05, 0, 0}};
  const ColumnGrid grid(stray, 0.1, 3);
  int seen = 0;
  grid.for_each(0, 0, -1, 1, [&](std::size_t, double) { ++seen; });
  EXPECT_EQ(seen, 2);
}

}  // namespace
}  // namespace gdesp::analysis
