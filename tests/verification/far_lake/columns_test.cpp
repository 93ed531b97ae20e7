// SPDX-License-Identifier: GPL-3.0-or-later
// The columns of a far lake alone, under the force of water at rest on their wall: what they keep, and the wave they carry.
// @eq far-lake.columns
#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <numbers>

#include "core/error.hpp"
#include "solitary_columns.hpp"

namespace gdesp::test {
namespace {

constexpr double g = 9.81, density = 1000.0, depth = 2.0, width = 3.0;
constexpr double rest_force = 0.5 * density * g * width * depth * depth;

FarLake lake_of(double length, double spacing, double side = 1.0) {
  FarLakeShape shape;
  shape.length = length;
  shape.depth = depth;
  shape.width = width;
  shape.columns = static_cast<int>(std::lround(length / spacing));
  shape.side = side;
  return FarLake(shape, density, g);
}

struct Crest {
  double place = 0.0, height = 0.0;
};

/// Of the highest column, by the parabola through it and its neighbours.
Crest crest_of(const FarLake& lake) {
  const FarLakeTable t = lake.table();
  const auto j = static_cast<std::size_t>(std::max_element(t.level.begin(), t.level.end()) - t.level.begin());
  if (j == 0 || j + 1 == t.level.size()) return {t.x[j], t.level[j]};
  const double left = t.level[j - 1], top = t.level[j], right = t.level[j + 1], bend = left - 2.0 * top + right;
  const double offset = 0.5 * (left - right) / bend, spacing = 0.5 * (t.x[j + 1] - t.x[j - 1]);
  return {t.x[j] + offset * spacing, top - 0.25 * (left - right) * offset};
}

TEST(FarLake, stays_at_rest) {
  for (const double side : {1.0, -1.0}) {
    FarLake lake = lake_of(40.0, 0.5, side);
    const std::vector<double> before = lake.nodes();
    for (int k = 0; k < 200; ++k) lake.step(0.01, side * rest_force);
    for (std::size_t i = 0; i < before.size(); ++i) ASSERT_NEAR(lake.nodes()[i], before[i], 1e-12 * before.back());
    EXPECT_NEAR(lake.displacement(), 0.0, 1e-12);
    EXPECT_NEAR(lake.far_wall_force(), -side * rest_force, 1e-9 * rest_force);
    EXPECT_NEAR(lake.sums().potential, 0.5 * density * g * width * depth * depth * 40.0, 1e-9 * rest_force * 40.0);
  }
}

// Mass is that of the columns; momentum changes by the impulses of the two walls, to round-off.
TEST(FarLake, keeps_mass_and_momentum) {
  for (const double side : {1.0, -1.0}) {
    FarLake lake = lake_of(60.0, 0.4, side);
    set_solitary_wave(lake, {depth, 0.3 * depth, g}, 25.0, 1.0);
    const double mass = lake.sums().mass, momentum = lake.sums().momentum;
    double impulse = 0.0, given = 0.0;
    for (int k = 0; k < 3000; ++k) {
      const double force = side * rest_force * (1.0 + 0.05 * std::sin(0.02 * k)), dt = 0.004;
      lake.step(dt, force);
      impulse += dt * (force + lake.far_wall_force());
      given += dt * rest_force;
    }
    double volume = 0.0;
    const FarLakeTable surface = lake.table();
    for (std::size_t j = 0; j < surface.level.size(); ++j)
      volume += (surface.level[j] + depth) * (lake.nodes()[j + 1] - lake.nodes()[j]);
    EXPECT_NEAR(density * width * volume, mass, 1e-12 * mass);
    EXPECT_EQ(lake.sums().mass, mass);
    EXPECT_GT(std::abs(impulse), 1e-4 * given);
    EXPECT_NEAR(lake.sums().momentum - momentum, impulse, 1e-12 * given);
  }
}

// Over a flat bed the sum of energies and of the work done by the constant force stays, but for an error of second order in the step.
TEST(FarLake, keeps_energy_to_second_order) {
  double error[3];
  int k = 0;
  for (const double dt : {0.04, 0.02, 0.01}) {
    FarLake lake = lake_of(60.0, 0.5);
    set_solitary_wave(lake, {depth, 0.3 * depth, g}, 20.0, 1.0);
    const double start_x = lake.displacement();
    const FarLakeSums start = lake.sums();
    const double wave = start.kinetic;
    double largest = 0.0;
    for (double t = 0.0; t < 16.0 - 0.5 * dt; t += dt) {
      lake.step(dt, rest_force);
      const FarLakeSums now = lake.sums();
      const double energy = now.kinetic + now.potential - rest_force * (lake.displacement() - start_x);
      largest = std::max(largest, std::abs(energy - start.kinetic - start.potential) / wave);
    }
    error[k++] = largest;
  }
  EXPECT_LT(error[2], 1e-3);
  EXPECT_NEAR(error[0] / error[1], 4.0, 1.0);
  EXPECT_NEAR(error[1] / error[2], 4.0, 1.0);
}

// The solitary wave of the equations runs 40 depths with its height and at sqrt(g (h + a)), the better the shorter the columns.
TEST(FarLake, carries_a_solitary_wave) {
  const SolitaryWave wave{depth, 0.3 * depth, g};
  double height_error[3], speed_error[3];
  int k = 0;
  for (const double spacing : {0.2 * depth, 0.1 * depth, 0.05 * depth}) {
    FarLake lake = lake_of(140.0, spacing);
    set_solitary_wave(lake, wave, 30.0, 1.0);
    const double dt = 0.01, end = 40.0 * depth / wave.speed();
    const auto steps = static_cast<int>(std::lround(end / dt));
    const Crest before = crest_of(lake);
    for (int n = 0; n < steps; ++n) lake.step(dt, rest_force);
    const Crest after = crest_of(lake);
    height_error[k] = std::abs(after.height / wave.height - 1.0);
    speed_error[k++] = std::abs((after.place - before.place) / (steps * dt * wave.speed()) - 1.0);
  }
  EXPECT_LT(height_error[0], 0.01);
  EXPECT_LT(speed_error[0], 0.01);
  EXPECT_LT(speed_error[2], 0.3 * speed_error[1]);
}

/// Force over velocity at node 0 (kg/s): of the part of the velocity in phase with a force of small amplitude, and of the part behind it.
struct Impedance {
  double in_phase, behind;
};
Impedance impedance_of(double omega) {
  FarLake lake =
      lake_of(std::ceil(9.0 * 2.0 * std::numbers::pi * std::sqrt(g * depth) / omega / depth) * depth, 0.1 * depth);
  const double period = 2.0 * std::numbers::pi / omega, dt = period / 400.0, force = 1e-5 * rest_force;
  double in = 0.0, behind = 0.0;
  constexpr int before = 4000,
                measured = 1600;  // periods of 400: ten to come to rest, four; nothing is back from the far wall then
  for (int n = 0; n < before + measured; ++n) {
    const double phase = omega * (n + 0.5) * dt, ramp = std::min(1.0, phase / (10.0 * std::numbers::pi)),
                 old = lake.velocity();
    lake.step(dt, rest_force + ramp * force * std::sin(phase));
    const double middle = 0.5 * (old + lake.velocity());
    if (n < before) continue;
    in += 2.0 * middle * std::sin(phase) / measured;
    behind -= 2.0 * middle * std::cos(phase) / measured;
  }
  const double size2 = in * in + behind * behind;
  return {force * in / size2, force * behind / size2};
}

/// |R| of a wave of wave number k in water of full depth profile at a wall that moves as a whole with the impedance Z - iX' (over rho w):
/// incident and reflected wave and all evanescent modes (docs/decisions/0081).
double reflection(double k, double omega, const Impedance& z) {
  const double n0 = 0.5 * depth + std::sinh(2.0 * k * depth) / (4.0 * k), s0 = std::sinh(k * depth) / k;
  double x = 0.0;
  for (int n = 1; n < 400; ++n) {  // omega^2 = -g k_n tan(k_n H), k_n H in the n-th branch
    double low = (n - 0.5) * std::numbers::pi / depth, high = n * std::numbers::pi / depth;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (omega * omega + g * middle * std::tan(middle * depth) < 0.0 ? low : high) = middle;
    }
    const double kn = 0.5 * (low + high), sn = std::sin(kn * depth) / kn;
    x += omega * sn * sn / ((0.5 * depth + std::sin(2.0 * kn * depth) / (4.0 * kn)) * kn);
  }
  const std::complex<double> q =
      std::complex<double>(z.in_phase, -z.behind - density * width * x) * k * n0 / (density * width * omega * s0 * s0);
  return std::abs((q - 1.0) / (q + 1.0));
}

// A wave of water with its full profile is thrown back by less than 2 % where it is longer than 4.5 depths, by less than 0.5 % from 6.5 on.
TEST(FarLake, hardly_reflects_waves_longer_than_4_5_depths) {
  for (const double kH : {0.3, 0.5, 0.7, 1.0, 1.4}) {
    const double k = kH / depth, omega = std::sqrt(g * k * std::tanh(kH));
    const Impedance z = impedance_of(omega);
    const double k_columns = std::sqrt(omega * omega / (g * depth - omega * omega * depth * depth / 3.0));
    EXPECT_NEAR(z.in_phase, density * width * depth * omega / k_columns, 0.005 * z.in_phase) << "k H = " << kH;
    EXPECT_LT(reflection(k, omega, z), kH < 1.0 ? 0.005 : 0.02) << "k H = " << kH;
  }
}

TEST(FarLake, says_when_a_column_is_pressed_to_nothing) {
  FarLake lake = lake_of(20.0, 0.5);
  EXPECT_THROW(
      {
        for (int n = 0; n < 1000; ++n) lake.step(0.5, 1e3 * rest_force);
      },
      Error);
}

}  // namespace
}  // namespace gdesp::test
