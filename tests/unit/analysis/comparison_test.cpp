// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/comparison.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.hpp"

namespace gdesp::analysis {
namespace {

TEST(CompareCurves, ByHand) {
  const Curve ours{{0, 1, 2}, {0, 2, 4}, {}, {}};
  const Curve reference{{0.5, 1.5, 3.0}, {1.0, 2.0, 9.0}, {0.5, 1.5, 8}, {1.5, 2.5, 10}};
  const Comparison c = compare_curves(ours, reference);
  EXPECT_EQ(c.points, 2u) << "x = 3 lies outside";
  EXPECT_NEAR(c.bias, 0.5, 1e-12);
  EXPECT_NEAR(c.rms, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(c.largest, 1.0, 1e-12);
  EXPECT_NEAR(c.largest_at, 1.5, 1e-12);
  EXPECT_NEAR(c.range, 1.0, 1e-12);
  EXPECT_NEAR(c.inside.value(), 0.5, 1e-12);
}

TEST(CompareCurves, AShiftIsFoundAndSaid) {
  Curve ours, reference;
  for (int k = 0; k <= 100; ++k) {
    ours.x.push_back(0.1 * k), ours.y.push_back(0.01 * k * k);
    if (k > 10 && k < 90) reference.x.push_back(0.1 * k + 0.2), reference.y.push_back(0.01 * k * k);
  }
  EXPECT_GT(compare_curves(ours, reference).rms, 0.1);
  const Comparison c = compare_curves(ours, reference, {0.3, -1e300, 1e300});
  EXPECT_NEAR(c.shift, 0.2, 0.003);
  EXPECT_LT(c.rms, 0.02);
}

TEST(CompareCurves, NoOverlapAndDisorderAreErrors) {
  const Curve ours{{0, 1}, {0, 1}, {}, {}};
  EXPECT_THROW(compare_curves(ours, Curve{{5, 6}, {0, 0}, {}, {}}), Error);
  EXPECT_THROW(compare_curves(Curve{{0, 2, 1}, {0, 0, 0}, {}, {}}, ours), Error);
}

// f(h) = 1 + h^2 on a ratio of 2, and with unequal ratios: order 2, value 1.
TEST(Convergence, ExactSecondOrder) {
  for (const std::vector<double>& h : {std::vector<double>{0.4, 0.2, 0.1}, {0.1, 0.15, 0.4}, {0.8, 0.1, 0.2, 0.4}}) {
    std::vector<double> f;
    for (const double s : h) f.push_back(1.0 + s * s);
    const Convergence c = assess_convergence(h, f);
    EXPECT_EQ(c.kind, ConvergenceKind::monotone);
    EXPECT_NEAR(c.order, 2.0, 1e-6);
    EXPECT_NEAR(c.extrapolated, 1.0, 1e-6);
    EXPECT_NEAR(c.error_bar, 1.25 * 0.01, 1e-6);
  }
}

// The worked example of Celik et al. 2008, table 1, first column: r21 = 1.5, r32 = 1.333, phi = 6.063, 5.972, 5.863;
// p = 1.53, extrapolated 6.1685, GCI 2.2 %.
TEST(Convergence, WorkedExampleOfCelik) {
  const Convergence c = assess_convergence({1.0, 1.5, 1.5 * 1.333}, {6.063, 5.972, 5.863});
  EXPECT_NEAR(c.order, 1.53, 0.02);
  EXPECT_NEAR(c.extrapolated, 6.1685, 0.002);
  EXPECT_NEAR(100.0 * c.error_bar / 6.063, 2.2, 0.05);
}

TEST(Convergence, RefusesWhatDoesNotConverge) {
  EXPECT_EQ(assess_convergence({4, 2, 1}, {1.0, 1.2, 1.1}).kind, ConvergenceKind::oscillating);
  EXPECT_EQ(assess_convergence({4, 2, 1}, {1.0, 1.1, 1.3}).kind, ConvergenceKind::diverging);
  EXPECT_EQ(assess_convergence({4, 2, 1}, {1.0, 1.0, 1.0}).kind, ConvergenceKind::too_close);
  EXPECT_TRUE(std::isnan(assess_convergence({4, 2, 1}, {1.0, 1.2, 1.1}).order));
  EXPECT_THROW(assess_convergence({2, 1}, {1.0, 1.1}), Error);
  EXPECT_THROW(assess_convergence({2, 2, 1}, {1.0, 1.1, 1.2}), Error);
}

TEST(ParetoFront, KeepsWhatNoOtherBeats) {
  const std::vector<double> cost{1, 2, 3, 2, 5, NAN}, error{9, 5, 6, 5, 1, 0};
  EXPECT_EQ(pareto_front(cost, error), (std::vector<bool>{true, true, false, false, true, false}));
}

}  // namespace
}  // namespace gdesp::analysis
