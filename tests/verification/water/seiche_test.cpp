// SPDX-License-Identifier: GPL-3.0-or-later
// V4: the lowest sway of a shallow tank, and what the stiffness of the particles' lattice does to it (docs/decisions/0032).
// @eq sph.momentum
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sph/wendland_c2.hpp"
#include "support/tank.hpp"

namespace gdesp {
namespace {

constexpr double pi_ = 3.14159265358979323846, g = 9.81;

// s: a cubic lattice under the pressure P, stretched by 1 + e along x and shortened as much along z, has (stress_zz - stress_xx)/(P e) = s
// in the sum of sph.momentum, where water has 0. > 0: stiff, < 0: gives way.
double lattice_stiffness(double h_over_dp, int dimensions, double e = 0.01) {
  const int reach = static_cast<int>(2.2 * h_over_dp) + 1, reach_y = dimensions == 2 ? 0 : reach;
  double xx = 0.0, zz = 0.0;
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach_y; j <= reach_y; ++j)
      for (int k = -reach; k <= reach; ++k) {
        const double x = i * (1.0 + e), y = j, z = k / (1.0 + e);
        const double G =
            sph::wendland_slope_shape(std::max(0.0, 1.0 - std::sqrt(x * x + y * y + z * z) / (2.0 * h_over_dp)));
        xx += G * x * x;
        zz += G * z * z;
      }
  return (zz - xx) / (xx * e);
}

// First quarter period of the lowest sway, 1 m long and 0.2 m deep, 0.01 m high, over that of linear theory (Lamb 1932).
double quarter_period(double h_over_dp) {
  const double length = 1.0, depth = 0.2, dp = 0.02, k = pi_ / length, omega = std::sqrt(g * k * std::tanh(k * depth));
  SimulationInput input = test::tank_input({length, 0.0, 0.4}, depth, dp, 2);
  input.fluid_parameters.h = h_over_dp * dp;
  input.fluid_parameters.sound_speed = 10.0 * std::sqrt(g * depth);
  test::fill_block(input.fluid, {0, 0, 0}, {length, 0, depth}, dp, true);
  const auto mode = [&](const Vec3d& r) {
    return Vec3d{std::cosh(k * r.z) * std::sin(k * r.x), 0.0, -std::sinh(k * r.z) * std::cos(k * r.x)};
  };
  for (const Vec3d& r : input.fluid.position)
    input.fluid.velocity.push_back(static_cast<Vec3f>(mode(r) * (0.01 * omega / std::sinh(k * depth))));
  auto simulation = make_simulation(input, "cpu");
  const double quarter = 0.5 * pi_ / omega, step = 0.02 * quarter;
  double before = 0.0;
  for (int n = 0; n < 75; ++n) {
    double sum = 0.0;
    const FluidTable water = simulation->fluid();
    for (std::size_t i = 0; i < water.position.size(); ++i)
      sum += dot(static_cast<Vec3d>(water.velocity[i]), mode(water.position[i]));
    if (sum < 0.0) return (n - sum / (sum - before)) * step / quarter;
    before = sum;
    simulation->advance_to((n + 1) * step);
  }
  return 0.0;
}

// 1/sqrt(1 + s/2): the stress of the lattice against half the weight of the depth. Stiff at 1.4 and 1.5 dp, hardly at 1.7.
TEST(Seiche, is_as_much_too_fast_as_the_lattice_is_stiff) {
  EXPECT_NEAR(lattice_stiffness(1.4, 2), 0.367, 0.001);
  EXPECT_NEAR(lattice_stiffness(1.5, 2), 0.094, 0.001);
  EXPECT_NEAR(lattice_stiffness(1.5, 3), 0.143, 0.001);
  EXPECT_LT(std::abs(lattice_stiffness(1.7, 2)), 0.01);
  for (const double ratio : {1.4, 1.5, 1.7}) {
    EXPECT_NEAR(quarter_period(ratio), 1.0 / std::sqrt(1.0 + 0.5 * lattice_stiffness(ratio, 2)), 0.015)
        << "h = " << ratio << " dp";
  }
}

}  // namespace
}  // namespace gdesp
