// SPDX-License-Identifier: GPL-3.0-or-later
// V5, V6: fronts of collapsing columns of water against measurements, in the plane, at a small size.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/tank.hpp"

namespace gdesp {
namespace {

constexpr double g = 9.81;

// Leading edge on the floor: the furthest water within 1.5 dp of it.
double front(const FluidTable& water, double dp) {
  double x = 0.0;
  for (const Vec3d& r : water.position)
    if (r.z < 2.0 * dp) x = std::max(x, r.x + 0.5 * dp);
  return x;
}

SimulationInput column(double width, double height, double length, double dp) {
  SimulationInput input = test::tank_input({length, 0.0, 2.0 * height}, height, dp, 2);
  input.fluid_parameters.h = 1.5 * dp;
  test::fill_block(input.fluid, {0, 0, 0}, {width, 0, height}, dp, true);
  return input;
}

TEST(DamBreak, reaches_the_wall_when_the_measured_one_does) {
  // Lobovsky et al. (2014), J. Fluids Struct. 48, 407, doi:10.1016/j.jfluidstructs.2014.03.009: H = 0.3 m, column 0.6 m,
  // wall at 1.61 m, arrival at t* = t sqrt(g/H) = 2.42.
  const double H = 0.3, dp = 0.01;
  auto simulation = make_simulation(column(0.6, H, 1.61, dp), "cpu");
  double t = 0.3;
  for (; t < 0.6; t += 0.002) {
    simulation->advance_to(t);
    if (front(simulation->fluid(), dp) > 1.61 - dp) break;
  }
  EXPECT_NEAR(t * std::sqrt(g / H), 2.42, 0.05 * 2.42);
}

TEST(DamBreak, front_follows_martin_and_moyce) {
  // Martin & Moyce (1952), doi:10.1098/rsta.1952.0007, n^2 = 2, a = 2.25 in: T = n t sqrt(g/a), Z = x/a. Released by
  // melting a diaphragm: one constant shift |dT| <= 0.3 is allowed; then 5 % of Z.
  const double T[] = {1.19, 1.43, 1.63, 1.83, 1.98, 2.2, 2.32, 2.51, 2.65, 2.83, 2.98};
  const double Z[] = {1.44, 1.67, 1.89, 2.11, 2.33, 2.56, 2.78, 3.0, 3.22, 3.44, 3.67};
  const double a = 0.05715, dp = a / 24.0, scale = std::sqrt(2.0) * std::sqrt(g / a);
  auto simulation = make_simulation(column(24 * dp, 48 * dp, 120 * dp, dp), "cpu");
  std::vector<double> at, z;
  for (double t = 0.0; t * scale < 3.4; t += 0.02 / scale) {
    simulation->advance_to(t);
    at.push_back(t * scale);
    z.push_back(front(simulation->fluid(), dp) / a);
  }
  const auto simulated = [&](double when) {
    const auto k = static_cast<std::size_t>(std::lower_bound(at.begin(), at.end(), when) - at.begin());
    return z[std::min(k, z.size() - 1)];
  };
  double best = 1e30, best_shift = 0.0;
  for (double shift = -0.3; shift <= 0.3; shift += 0.02) {
    double worst = 0.0;
    for (std::size_t k = 0; k < std::size(T); ++k)
      worst = std::max(worst, std::abs(simulated(T[k] + shift) / Z[k] - 1.0));
    if (worst < best) {
      best = worst;
      best_shift = shift;
    }
  }
  EXPECT_LT(best, 0.05) << "at a shift of " << best_shift;
}

}  // namespace
}  // namespace gdesp
