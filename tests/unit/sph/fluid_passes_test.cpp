// SPDX-License-Identifier: GPL-3.0-or-later
// The passes of a FluidSystem against sums over all pairs in double precision, and what they must conserve.
#include <gtest/gtest.h>

#include <random>

#include "sph/fluid_system.hpp"
#include "sph/wendland_c2.hpp"
#include "support/tank.hpp"

namespace gdesp::sph {
namespace {

using exec::OpenMP;

SimulationInput jittered_drop(unsigned seed, bool walls) {
  const double dp = 0.02;
  SimulationInput input = test::tank_input({0.3, 0.3, 0.3}, 0.3, dp, 3);
  if (!walls) input.boundary = {};
  input.fluid_parameters.cavitates = false;
  test::fill_block(input.fluid, {0.04, 0.0, 0.0}, {0.24, 0.2, 0.2}, dp, false);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (auto& r : input.fluid.position) {
    r += Vec3d{0.2 * dp * u(random), 0.2 * dp * u(random), 0.2 * dp * u(random)};
    input.fluid.velocity.push_back(
        {static_cast<float>(u(random)), static_cast<float>(u(random)), static_cast<float>(u(random))});
    input.fluid.density.push_back(static_cast<float>(1000.0 + 5.0 * u(random)));
  }
  return input;
}

FluidSystem<OpenMP> system_of(const SimulationInput& input) {
  const bool closed[3] = {false, false, false};
  const Domain domain = make_domain(input.lower, input.upper, input.fluid_parameters.dp, closed, 3);
  return FluidSystem<OpenMP>({}, domain, input.fluid_parameters, input.fluid, input.boundary);
}

struct Reference {
  Vec3d acceleration;
  double dD;
};

// `accurate` with artificial viscosity and diffusion, fluid pairs only.
Reference brute_force(const SimulationInput& input, std::size_t i) {
  const FluidParameters& p = input.fluid_parameters;
  const double alpha = wendland_normalisation(p.h, 3), c2 = p.sound_speed * p.sound_speed;
  const double moment = lattice_gradient_moment(p.h / p.dp, 3);
  const auto D = [&](std::size_t k) { return static_cast<double>(input.fluid.density[k]) / 1000.0 - 1.0; };
  const auto A = [&](std::size_t k) { return (std::pow(1.0 + D(k), 7.0) - 1.0) / 7.0; };
  Reference out{{}, 0.0};
  for (std::size_t j = 0; j < input.fluid.position.size(); ++j) {
    const Vec3d r = input.fluid.position[i] - input.fluid.position[j];
    const Vec3d v = static_cast<Vec3d>(input.fluid.velocity[i]) - static_cast<Vec3d>(input.fluid.velocity[j]);
    const double distance = norm(r);
    if (distance >= 2.0 * p.h || i == j) continue;
    const double G = 5.0 * alpha / (p.h * p.h) * std::pow(1.0 - distance / (2.0 * p.h), 3.0) / moment;
    const double V = std::pow(p.dp, 3) / (1.0 + D(j));
    const double Pi = -p.artificial_viscosity * p.h * p.sound_speed * std::min(0.0, dot(v, r)) /
                      (distance * distance + 0.01 * p.h * p.h);
    out.acceleration += r * (V * G * (c2 * (A(i) + A(j)) + Pi) / (1.0 + D(i)));
    const double jump = A(j) - A(i), unbalanced = jump + dot(p.gravity, r) / c2;
    const double exchanged =
        jump * unbalanced > 0.0 ? std::copysign(std::min(std::abs(jump), std::abs(unbalanced)), jump) : 0.0;
    out.dD += -(1.0 + D(i)) * V * G * dot(v, r) + 2.0 * p.density_diffusion * p.h * p.sound_speed * V * G * exchanged;
  }
  return out;
}

TEST(FluidPasses, agree_with_sums_over_all_pairs) {
  const SimulationInput input = jittered_drop(7, false);
  auto fluid = system_of(input);
  fluid.combined_pass();
  const auto rates = test::rates_by_id(fluid);
  double scale = 0.0, scale_dD = 0.0;
  for (const auto& r : rates) {
    scale = std::max(scale, norm(r.acceleration));
    scale_dD = std::max(scale_dD, std::abs(r.dD));
  }
  for (std::size_t i = 0; i < rates.size(); i += 7) {
    const Reference expected = brute_force(input, i);
    EXPECT_LT(norm(rates[i].acceleration - expected.acceleration), 3e-6 * scale);
    EXPECT_NEAR(rates[i].dD, expected.dD, 3e-6 * scale_dD);
  }
}

TEST(FluidPasses, light_passes_give_the_same_as_the_combined_one) {
  auto fluid = system_of(jittered_drop(9, true));
  fluid.extrapolate_walls();
  fluid.combined_pass();
  const auto both = test::rates_by_id(fluid);
  fluid.momentum_pass();
  fluid.continuity_pass();
  const auto light = test::rates_by_id(fluid);
  for (std::size_t i = 0; i < both.size(); ++i) {
    EXPECT_LE(norm(both[i].acceleration - light[i].acceleration), 1e-5 * (1.0 + norm(both[i].acceleration)));
    EXPECT_NEAR(both[i].dD, light[i].dD, 1e-5 * (1.0 + std::abs(both[i].dD)));
  }
}

TEST(FluidPasses, conserve_linear_momentum) {
  const SimulationInput input = jittered_drop(21, false);
  auto fluid = system_of(input);
  fluid.momentum_pass();
  Vec3d sum;
  double total = 0.0;
  for (const auto& r : test::rates_by_id(fluid)) {
    sum += r.acceleration;
    total += norm(r.acceleration);
  }
  EXPECT_LT(norm(sum), 1e-6 * total);
}

/// Water in a corner of a tank, under pressure everywhere, without weight, viscosity and diffusion.
SimulationInput pressed_corner(unsigned seed) {
  SimulationInput input = jittered_drop(seed, true);
  input.fluid_parameters.gravity = {};
  input.fluid_parameters.viscosity = Viscosity::none;
  input.fluid_parameters.density_diffusion = 0.0;
  for (std::size_t i = 0; i < input.fluid.position.size(); ++i) {
    input.fluid.position[i] -= Vec3d{0.04, 0.0, 0.0};
    input.fluid.density[i] = static_cast<float>(1010.0 + 40.0 * input.fluid.position[i].z);
  }
  return input;
}

/// W: what pressure gives to the motion of the water, and what its compression takes up.
struct Powers {
  double given = 0.0, stored = 0.0;
};

Powers powers(const SimulationInput& input) {
  auto fluid = system_of(input);
  fluid.extrapolate_walls();
  fluid.combined_pass();
  const auto rates = test::rates_by_id(fluid);
  const double c2 = input.fluid_parameters.sound_speed * input.fluid_parameters.sound_speed;
  Powers sum;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const double share = static_cast<double>(input.fluid.density[i]) / 1000.0, A = (std::pow(share, 7.0) - 1.0) / 7.0;
    sum.given += dot(rates[i].acceleration, static_cast<Vec3d>(input.fluid.velocity[i]));
    sum.stored += c2 * A / (share * share) * rates[i].dD;
  }
  return sum;
}

/// What walls give that nothing takes up, over what they and the water give.
double unpaid(const SimulationInput& input) {
  const Powers p = powers(input);
  EXPECT_GT(std::abs(p.given), 1.0);
  return std::abs(p.given + p.stored) / std::abs(p.given);
}

// In a corner, without normals, all that the walls' pressure does is paid for; with them, over a floor, for water that does not slide.
TEST(FluidPasses, walls_neither_give_nor_take_energy) {
  SimulationInput input = pressed_corner(3);
  input.boundary.normal.clear();
  EXPECT_LT(unpaid(input), 5e-4);
  input = pressed_corner(5);
  for (Vec3d& r : input.fluid.position) r += Vec3d{0.08, 0.08, 0.0};
  for (Vec3f& v : input.fluid.velocity) v.x = v.y = 0.0f;
  EXPECT_LT(unpaid(input), 5e-4);
}

TEST(FluidPasses, are_the_same_for_any_number_of_threads) {
  const SimulationInput input = jittered_drop(5, true);
  std::vector<std::vector<test::Rates>> results;
  for (int threads : {1, 2, 5}) {
    exec::set_threads(threads);
    auto fluid = system_of(input);
    fluid.extrapolate_walls();
    fluid.combined_pass();
    results.push_back(test::rates_by_id(fluid));
  }
  for (const auto& result : results)
    for (std::size_t i = 0; i < result.size(); ++i) {
      ASSERT_EQ(result[i].acceleration, results[0][i].acceleration);
      ASSERT_EQ(result[i].dD, results[0][i].dD);
    }
}

TEST(FluidPasses, gradient_of_a_linear_pressure_is_right_inside) {
  // Still water on the lattice balances gravity inside: within 0.5 % and three times the compression (0.5 % at the
  // bottom) by which the lattice is wider than the water it stands for.
  const double dp = 0.02;
  SimulationInput input = test::tank_input({0.4, 0.4, 0.4}, 0.4, dp, 3);
  test::fill_block(input.fluid, {0, 0, 0}, {0.4, 0.4, 0.4}, dp, false);
  auto fluid = system_of(input);
  fluid.extrapolate_walls();
  fluid.momentum_pass();
  const auto rates = test::rates_by_id(fluid);
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const Vec3d r = input.fluid.position[i];
    if (r.z > 0.4 - 3.5 * dp) continue;  // the free surface
    EXPECT_NEAR(rates[i].acceleration.z, 9.81, 0.02 * 9.81) << r.z / dp;
    EXPECT_NEAR(rates[i].acceleration.x, 0.0, 0.05 * 9.81);
  }
}

// A plate, normal z at the start, turned until its normal is x: water lies as deep inside as its distance along x says.
TEST(FluidSystem, normals_turn_with_their_body) {
  const double dp = 0.02;
  SimulationInput input = test::tank_input({0.4, 0.4, 0.4}, 0.2, dp, 3);
  input.boundary = {};
  for (int k = 0; k < 3; ++k)
    for (int i = -4; i <= 4; ++i)
      for (int j = -4; j <= 4; ++j) {
        input.boundary.position.push_back({0.2 + i * dp, 0.2 + j * dp, 0.2 - (k + 0.5) * dp});
        input.boundary.normal.push_back({0.0f, 0.0f, 1.0f});
        input.boundary.depth.push_back(static_cast<float>((k + 0.5) * dp));
        input.boundary.body.push_back(1);
      }
  input.fluid.position = {{0.2 - 0.8 * dp, 0.2, 0.2}};
  auto fluid = system_of(input);
  WallBodyState body;
  body.centre_start = body.centre = {0.2, 0.2, 0.2};
  const float quarter_turn[9] = {0, 0, 1, 0, 1, 0, -1, 0, 0};
  std::copy(quarter_turn, quarter_turn + 9, body.rotation);
  fluid.move_walls({body});
  fluid.rebuild(0.0, 0.0, {}, 0.0);
  fluid.find_walls();
  EXPECT_NEAR(fluid.deepest_in_wall().depth, 0.8 * dp, 0.05 * dp);
}

TEST(FluidSystem, survives_no_water_and_one_particle) {
  SimulationInput input = test::tank_input({0.2, 0.2, 0.2}, 0.2, 0.02, 3);
  EXPECT_EQ(system_of(input).particles(), 0);
  input.fluid.position.push_back({0.1, 0.1, 0.1});
  auto fluid = system_of(input);
  fluid.combined_pass();
  EXPECT_EQ(fluid.particles(), 1);
  EXPECT_EQ(norm(test::rates_by_id(fluid)[0].acceleration), 0.0);
}

}  // namespace
}  // namespace gdesp::sph
