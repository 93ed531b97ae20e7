// SPDX-License-Identifier: GPL-3.0-or-later
// @eq coupling.buoyancy
// @eq coupling.porosity
#include "coupling/buoyancy.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "sph/wendland_c2.hpp"

namespace gdesp::coupling {
namespace {

constexpr double h = 0.15, dp = 0.1;

double W(double r) {
  const double t = std::max(0.0, 1.0 - r / (2 * h));
  return sph::wendland_normalisation(h, 3) * t * t * t * t * (5.0 - 4.0 * t);
}
// grad_i W = -slope r.
double slope(double r) {
  const double t = std::max(0.0, 1.0 - r / (2 * h));
  return 5.0 * sph::wendland_normalisation(h, 3) / (h * h) * t * t * t;
}

struct Particle {
  Vec3d r;
  double V, pressure;
};
const Vec3f rho_g{0.0f, 0.0f, -9810.0f};

// A jittered lattice of water from the floor z = 0 up to z = top.
template <class Pressure>
std::vector<Particle> surroundings(double top, const Pressure& pressure) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> jitter(-0.02, 0.02);
  std::vector<Particle> out;
  for (int x = -5; x < 5; ++x)
    for (int y = -5; y < 5; ++y)
      for (int z = 0; (z + 0.5) * dp < top; ++z) {
        const Vec3d r{(x + 0.5) * dp + jitter(random), (y + 0.5) * dp + jitter(random),
                      (z + 0.5) * dp + jitter(random)};
        out.push_back({r, dp * dp * dp, pressure(r.z)});
      }
  return out;
}

// Three layers of wall below z = 0 leave the rest of the room.
Surroundings sums_at(const std::vector<Particle>& around, const Vec3d& x) {
  double N = 0.0, Q = 0.0, S = 0.0;
  Vec3d dN, dQ, dS;
  for (int i = -5; i < 5; ++i)
    for (int j = -5; j < 5; ++j)
      for (int k = -3; k < 0; ++k) {
        const Vec3d d = x - Vec3d{(i + 0.5) * dp, (j + 0.5) * dp, (k + 0.5) * dp};
        S += dp * dp * dp * W(norm(d));
        dS += d * (-dp * dp * dp * slope(norm(d)));
      }
  for (const Particle& a : around) {
    const Vec3d d = x - a.r;
    const double p = a.pressure - 9810.0 * d.z;
    const Vec3d g = d * (-a.V * slope(norm(d)));
    N += a.V * W(norm(d));
    Q += a.V * p * W(norm(d));
    dN += g;
    dQ += g * p;
  }
  return {static_cast<float>(N),
          static_cast<float>(Q),
          static_cast<Vec3f>(dN),
          static_cast<Vec3f>(dQ),
          open_share(static_cast<float>(S)),
          static_cast<Vec3f>(dS)};
}

double energy(const std::vector<Particle>& around, const Vec3d& x, double volume) {
  const Surroundings s = sums_at(around, x);
  return volume * static_cast<double>(immersion(s.water / s.room)) * static_cast<double>(s.pressure) /
         static_cast<double>(s.water);
}

TEST(Immersion, hand_values) {
  EXPECT_EQ(immersion(0.2f), 0.0f);
  EXPECT_EQ(immersion(0.25f), 0.0f);
  EXPECT_NEAR(immersion(0.375f), 0.15625f, 1e-6f);  // t = 1/4: 1/16 (3 - 1/2)
  EXPECT_EQ(immersion(0.5f), 0.5f);
  EXPECT_EQ(immersion(1.0f), 1.0f);
  EXPECT_NEAR(immersion_slope(0.5f), 3.0f, 1e-6f);
  EXPECT_EQ(immersion_slope(0.8f), 0.0f);
  EXPECT_NEAR(deposited_volume(2.0f, 0.8f, 1.0f), 2.5f, 1e-6f);
  EXPECT_NEAR(deposited_volume(2.0f, 0.25f, 0.5f), 4.0f, 1e-6f);  // N = 1/2
  EXPECT_EQ(deposited_volume(2.0f, 0.1f, 1.0f), 0.0f);
}

// The force is minus the derivative of the energy, at the free surface and on the floor as in the deep.
TEST(Buoyancy, is_the_derivative_of_the_energy) {
  const auto around = surroundings(0.4, [](double z) { return 5000.0 + 15000.0 * (0.4 - z); });
  const auto film = surroundings(0.1, [](double z) { return 5000.0 + 15000.0 * (0.1 - z); });
  ASSERT_GT(immersion_slope(sums_at(film, {0.0, 0.0, 0.13}).water / sums_at(film, {0.0, 0.0, 0.13}).room), 1.0f);
  ASSERT_LT(sums_at(film, {0.0, 0.0, 0.13}).room, 0.97f);
  const auto check = [](const std::vector<Particle>& around, const Vec3d& x) {
    const Buoyancy b = buoyancy(1e-3f, sums_at(around, x), rho_g);
    const double step = 2e-3;
    const Vec3d up{0, 0, step}, side{step, 0, 0};
    const double z = -(energy(around, x + up, 1e-3) - energy(around, x - up, 1e-3)) / (2 * step);
    const double side_force = -(energy(around, x + side, 1e-3) - energy(around, x - side, 1e-3)) / (2 * step);
    EXPECT_NEAR(static_cast<double>(b.force.z), z, 0.01 * std::abs(z) + 0.05) << x.z;
    EXPECT_NEAR(static_cast<double>(b.force.x), side_force, 0.01 * std::abs(z) + 0.05) << x.z;
  };
  for (const Vec3d& x :
       {Vec3d{0.01, 0.02, 0.21}, Vec3d{0.03, -0.01, 0.38}, Vec3d{0.0, 0.0, 0.42}, Vec3d{0.02, 0.01, 0.05}})
    check(around, x);
  check(film, {0.0, 0.0, 0.13});
}

// What the water particles take adds up to minus what the grain takes.
TEST(Buoyancy, pairs_add_up_to_the_force) {
  const auto around = surroundings(0.4, [](double z) { return 15000.0 * (0.4 - z); });
  for (const Vec3d& x : {Vec3d{0.01, 0.02, 0.21}, Vec3d{0.03, -0.01, 0.37}}) {
    const Buoyancy b = buoyancy(1e-3f, sums_at(around, x), rho_g);
    Vec3d taken;
    for (const Particle& a : around) {
      const Vec3d d = x - a.r;
      const double p = a.pressure - 9810.0 * d.z,
                   push = static_cast<double>(b.slope) * p + static_cast<double>(b.offset);
      taken +=
          (d * (-slope(norm(d)) * push) + static_cast<Vec3d>(rho_g) * (static_cast<double>(b.slope) * W(norm(d)))) *
          a.V;
    }
    EXPECT_LT(norm(taken + static_cast<Vec3d>(b.force)), 2e-3 * norm(static_cast<Vec3d>(b.force)));
  }
}

// Still water gives Archimedes exactly, in the deep and on the floor; the nearest wrong variants, pressure that is not
// carried and a gradient without the mean pressure, are wrong by more than a twentieth and more than a half on the floor.
TEST(Buoyancy, still_water_gives_archimedes) {
  const auto around = surroundings(1.0, [](double z) { return 9810.0 * (1.0 - z); });
  for (double height : {0.5, 0.3, 0.05}) {
    EXPECT_NEAR(buoyancy(1e-3f, sums_at(around, {0.02, 0.01, height}), rho_g).force.z, 9.81f, 2e-3f) << height;
  }
  Surroundings plain = sums_at(around, {0.02, 0.01, 0.05});
  plain.water = plain.pressure = 0.0f;
  plain.water_gradient = plain.pressure_gradient = {};
  for (const Particle& a : around) {
    const Vec3d d = Vec3d{0.02, 0.01, 0.05} - a.r;
    const Vec3d g = d * (-a.V * slope(norm(d)));
    plain.water += static_cast<float>(a.V * W(norm(d)));
    plain.pressure += static_cast<float>(a.V * a.pressure * W(norm(d)));
    plain.water_gradient += static_cast<Vec3f>(g);
    plain.pressure_gradient += static_cast<Vec3f>(g * a.pressure);
  }
  EXPECT_GT(std::abs(buoyancy(1e-3f, plain, {}).force.z / 9.81f - 1.0f), 0.05f);
  plain.water_gradient = {};
  EXPECT_GT(std::abs(buoyancy(1e-3f, plain, {}).force.z / 9.81f - 1.0f), 0.5f);
}

}  // namespace
}  // namespace gdesp::coupling
