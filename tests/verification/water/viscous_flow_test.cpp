// SPDX-License-Identifier: GPL-3.0-or-later
// V3: viscosity and no-slip walls in plane Poiseuille flow; shifting and tensile control in Taylor-Green vortices.
// @eq sph.wall.no-slip
// @eq sph.viscosity.morris
#include <gtest/gtest.h>

#include <cmath>

#include "support/tank.hpp"

namespace gdesp {
namespace {

constexpr double pi_ = 3.14159265358979323846;

// A band of water, `width` high, that repeats along x.
SimulationInput periodic_band(double length, double width, double dp, double fastest, double viscosity) {
  SimulationInput input;
  input.periodic[0] = true;
  input.lower = {0.0, -dp, -5 * dp};
  input.upper = {length, dp, width + 5 * dp};
  auto& p = input.fluid_parameters;
  p.dp = dp;
  p.h = 1.5 * dp;
  p.dimensions = 2;
  p.sound_speed = 10.0 * fastest;
  p.kinematic_viscosity = viscosity;
  p.viscosity = sph::Viscosity::morris;
  p.gravity = {};
  p.density_diffusion = 0.1;
  test::fill_block(input.fluid, {0, 0, 0}, {length, 0, width}, dp, true);
  return input;
}

// Steady flow between plates at rest, set-up of Morris, Fox and Zhu (1997): RMS error over the highest speed.
double poiseuille_error(int across) {
  const double L = 1e-3, nu = 1e-6, force = 1e-4, dp = L / across, fastest = force * L * L / (8.0 * nu);
  SimulationInput input = periodic_band(L, L, dp, fastest, nu);
  input.fluid_parameters.gravity = {force, 0.0, 0.0};
  for (int layer = 0; layer < 3; ++layer)
    for (int i = 0; i < across; ++i)
      for (const double z : {-(layer + 0.5) * dp, L + (layer + 0.5) * dp}) {
        input.boundary.position.push_back({(i + 0.5) * dp, 0.0, z});
        input.boundary.friction.push_back(1.0f);
        input.boundary.normal.push_back({0.0f, 0.0f, z < 0.0 ? 1.0f : -1.0f});
        input.boundary.depth.push_back(static_cast<float>((layer + 0.5) * dp));
      }
  auto simulation = make_simulation(input, "cpu");
  simulation->advance_to(1.2);
  const FluidTable water = simulation->fluid();
  double sum = 0.0;
  for (std::size_t i = 0; i < water.position.size(); ++i) {
    const double z = water.position[i].z, exact = force / (2.0 * nu) * z * (L - z);
    sum += std::pow(static_cast<double>(water.velocity[i].x) - exact, 2);
  }
  return std::sqrt(sum / static_cast<double>(water.position.size())) / fastest;
}

TEST(ViscousFlow, poiseuille_profile_between_no_slip_walls) {
  EXPECT_LT(poiseuille_error(10), 0.017);  // 0.0181 with mirrored velocities
}

// Share of the kinetic energy left at t of vortices in a doubly periodic square; exact: exp(-16 pi^2 nu t).
double energy_left(double t, double shifting) {
  const double dp = 0.02, nu = 0.01;
  SimulationInput input = periodic_band(1.0, 1.0, dp, 1.0, nu);
  input.periodic[2] = true;
  input.lower.z = 0.0;
  input.upper.z = 1.0;
  input.fluid_parameters.cavitates = false;
  input.fluid_parameters.tensile_control = shifting > 0.0;
  input.fluid_parameters.shifting = shifting;
  double start = 0.0, end = 0.0;
  for (const Vec3d& r : input.fluid.position) {
    const Vec3d v{std::sin(2 * pi_ * r.x) * std::cos(2 * pi_ * r.z), 0.0,
                  -std::cos(2 * pi_ * r.x) * std::sin(2 * pi_ * r.z)};
    input.fluid.velocity.push_back(static_cast<Vec3f>(v));
    start += dot(v, v);
  }
  auto simulation = make_simulation(input, "cpu");
  simulation->advance_to(t);
  for (const Vec3f& v : simulation->fluid().velocity) end += static_cast<double>(dot(v, v));
  return end / start;
}

TEST(ViscousFlow, taylor_green_vortices_decay_as_they_should) {
  const double t = 0.5, exact = std::exp(-16.0 * pi_ * pi_ * 0.01 * t);
  EXPECT_NEAR(energy_left(t, 20.0), exact, 0.05 * exact);
  EXPECT_LT(energy_left(t, 0.0), 0.9 * exact) << "without shifting and tensile control water clumps and tears";
}

}  // namespace
}  // namespace gdesp
