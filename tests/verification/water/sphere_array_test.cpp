// SPDX-License-Identifier: GPL-3.0-or-later
// V3: drag of a fixed sphere in a cubic array at small Reynolds number, Hasimoto (1959), J. Fluid Mech. 5, 317-328,
// doi:10.1017/S0022112059000222: no-slip walls of a body that is resolved, curved and small.
// @eq sph.wall.no-slip
// @eq sph.viscosity.morris
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "support/tank.hpp"

namespace gdesp {
namespace {

constexpr double pi = 3.14159265358979323846;

// Force over Stokes' 6 pi mu a U, U being the mean velocity over the whole cell, for the share c of the cell that spheres take;
// Hasimoto's series with the terms of Sangani and Acrivos (1982), Int. J. Multiphase Flow 8, 343, doi:10.1016/0301-9322(82)90047-7.
double hasimoto(double c) {
  return 1.0 / (1.0 - 1.7601 * std::cbrt(c) + c - 1.5593 * c * c + 3.9799 * std::pow(c, 8.0 / 3.0) -
                3.0734 * std::pow(c, 10.0 / 3.0));
}

// Radius of the sphere, over the true one, that by the law lets a force on the water drive the mean speed that it does; a = radius_in_dp dp in a cell
// of 4a. Re = 0.5 and sound at 60 U: pressures of mu U/a compress the water by 0.1 % (at Re = 0.1 and 20 U by 5 %, and the radius is 0.06 smaller).
double effective_radius(int radius_in_dp, double offset) {
  const double a = 0.01, L = 4.0 * a, dp = a / radius_in_dp, nu = 1e-3;
  const double Re = 0.5, U = Re * nu / (2.0 * a),
               force = 6.0 * pi * nu * a * U * hasimoto(4.0 / 3.0 * pi / 64.0) / (L * L * L);
  SimulationInput input;
  for (bool& axis : input.periodic) axis = true;
  input.lower = {0.0, 0.0, 0.0};
  input.upper = {L, L, L};
  auto& p = input.fluid_parameters;
  p.dp = dp;
  p.h = 1.5 * dp;
  p.dimensions = 3;
  p.sound_speed = 60.0 * U;
  p.kinematic_viscosity = nu;
  p.viscosity = sph::Viscosity::morris;
  p.gravity = {force, 0.0, 0.0};
  p.density_diffusion = 0.1;
  p.cavitates = false;
  const Vec3d centre{0.5 * L + offset * dp, 0.5 * L + offset * dp, 0.5 * L + offset * dp};
  FluidTable all;
  test::fill_block(all, {0, 0, 0}, {L, L, L}, dp, false);
  for (const Vec3d& r : all.position) {
    const Vec3d from = r - centre;
    const double distance = norm(from);
    if (distance >= a) {
      input.fluid.position.push_back(r);
      input.fluid.density.push_back(1000.0f);
      input.fluid.velocity.push_back({static_cast<float>(U), 0.0f, 0.0f});
    } else {
      input.boundary.position.push_back(r);
      input.boundary.normal.push_back(distance > 0.0 ? static_cast<Vec3f>(from * (1.0 / distance)) : Vec3f{});
      input.boundary.depth.push_back(static_cast<float>(a - distance));
      input.boundary.friction.push_back(1.0f);
    }
  }
  auto simulation = make_simulation(input, "cpu");
  const auto mean_speed = [&] {
    double sum = 0.0;
    for (const Vec3f& v : simulation->fluid().velocity) sum += static_cast<double>(v.x);
    return sum * dp * dp * dp / (L * L * L);
  };
  simulation->advance_to(16.0 * L * L / (4.0 * pi * pi * nu));
  const double speed = mean_speed();
  double low = 0.5 * a, high = 1.5 * a;
  for (int k = 0; k < 60; ++k) {
    const double r = 0.5 * (low + high);
    const bool too_large =
        6.0 * pi * nu * r * speed * hasimoto(4.0 / 3.0 * pi * std::pow(r / L, 3)) > force * L * L * L;
    (too_large ? high : low) = r;
  }
  return 0.5 * (low + high) / a;
}

// The radius that the water feels is smaller than the sphere's by about a tenth of a spacing, wherever the sphere lies on the lattice.
TEST(SphereArray, drag_is_that_of_a_sphere_of_nearly_its_size) {
  for (const int radius : {3, 4}) {
    const double at_corners = effective_radius(radius, 0.0), at_centres = effective_radius(radius, 0.5);
    std::printf("a = %d dp: felt as %.4f and %.4f a\n", radius, at_corners, at_centres);
    EXPECT_NEAR(at_corners, 1.0 - 0.1 / radius, 0.02);
    EXPECT_NEAR(at_centres, at_corners, 0.015) << "mirrored velocities: 0.03 and more";
  }
}

}  // namespace
}  // namespace gdesp
