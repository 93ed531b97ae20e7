// SPDX-License-Identifier: GPL-3.0-or-later
// @eq sph.kernel.wendland-c2
// @eq sph.eos.tait
// @eq sph.density-diffusion
// @eq sph.viscosity.artificial
// @eq sph.viscosity.morris
// @eq sph.momentum
// @eq sph.continuity
// @eq sph.wall.extrapolation
// @eq sph.wall.volume
// @eq sph.wall.guard
// @eq sph.surface-rows
// @eq sph.cavitation
// @eq sph.shifting
// @eq sph.tensile-control
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "exec/lanes.hpp"
#include "particles/surface_rows.hpp"
#include "sph/fluid_views.hpp"
#include "sph/lattice_count.hpp"
#include "sph/particle_shifting.hpp"
#include "sph/pressure_and_viscosity.hpp"
#include "sph/tait.hpp"
#include "sph/wall_extrapolation.hpp"
#include "sph/wall_guard.hpp"
#include "sph/wall_volume.hpp"
#include "sph/wendland_c2.hpp"

namespace gdesp::sph {
namespace {

constexpr double pi = std::numbers::pi;

double W(double r, double h, int dimensions) {
  const auto t = static_cast<float>(std::max(0.0, 1.0 - r / (2.0 * h)));
  return wendland_normalisation(h, dimensions) * static_cast<double>(wendland_shape(t));
}

TEST(WendlandC2, integrates_to_one) {
  const double h = 0.7;
  for (int dimensions : {2, 3}) {
    double integral = 0.0;
    const int n = 20'000;
    for (int k = 0; k < n; ++k) {
      const double r = (k + 0.5) * 2.0 * h / n, shell = dimensions == 2 ? 2.0 * pi * r : 4.0 * pi * r * r;
      integral += W(r, h, dimensions) * shell * 2.0 * h / n;
    }
    EXPECT_NEAR(integral, 1.0, 1e-6);
  }
  // The constant printed in the paper, 7/(8 pi h^3), would give 2/3.
  EXPECT_NEAR(7.0 / (8.0 * pi) / wendland_normalisation(1.0, 3), 2.0 / 3.0, 1e-12);
}

TEST(WendlandC2, slope_is_the_derivative) {
  const double h = 1.3, r = 0.9, d = 1e-3;
  const double slope = -5.0 * wendland_normalisation(h, 3) / (h * h) *
                       static_cast<double>(wendland_slope_shape(static_cast<float>(1.0 - r / (2.0 * h))));
  EXPECT_NEAR(slope * r, (W(r + d, h, 3) - W(r - d, h, 3)) / (2.0 * d), 2e-5);
}

TEST(WendlandC2, lattice_moment_matches_hand_values) {
  EXPECT_NEAR(lattice_gradient_moment(1.3, 2), 0.973921, 1e-5);
  EXPECT_NEAR(lattice_gradient_moment(1.3, 3), 0.978896, 1e-5);
  EXPECT_NEAR(lattice_gradient_moment(6.0, 3), 1.0, 1e-4);
}

// A kernel sum on a particle counts the particle itself: 7/(4 pi 1.5^2) of a lattice at least. Values by hand (sum over a lattice).
TEST(LatticeCount, TellsTheShareOfThinnedLattices) {
  EXPECT_NEAR(lattice_count(1.5, 2, 1.0), 1.0051, 1e-4);
  EXPECT_NEAR(lattice_count(1.5, 2, 0.4), 0.4 * 1.0454, 1e-4);
  EXPECT_NEAR(lattice_count(1.5, 2, 0.2), 0.2 * 1.3208, 1e-4);
  EXPECT_NEAR(lattice_count(1.5, 3, 0.4), 0.4 * 1.0242, 1e-4);
  for (const int dimensions : {2, 3}) {
    const ShareOfCount share(1.5, dimensions);
    for (const double s : {0.25, 0.33, 0.4, 0.6, 0.85, 1.0}) {
      EXPECT_NEAR(static_cast<double>(share(static_cast<float>(lattice_count(1.5, dimensions, s)))), s, 0.005 * s)
          << dimensions;
    }
    EXPECT_EQ(share(0.01f), 0.0f);
    EXPECT_NEAR(share(1.2f * static_cast<float>(lattice_count(1.5, dimensions, 1.0))), 1.2f, 1e-5f);
  }
}

TEST(Tait, matches_the_power_law_and_its_inverse) {
  for (double D : {-0.02, -1e-4, 0.0, 1e-6, 1e-3, 0.05}) {
    const double expected = (std::pow(1.0 + D, 7.0) - 1.0) / 7.0;
    const float A = tait_pressure(static_cast<float>(D));
    EXPECT_NEAR(A, expected, 2e-7 * std::abs(expected) + 1e-12);
    EXPECT_NEAR(tait_density(A), D, 3e-7 * std::abs(D) + 1e-12);
  }
}

FluidPairLaw law_for(double h) {
  FluidPairLaw law{};
  law.inverse_support = static_cast<float>(1.0 / (2.0 * h));
  law.slope = 2.0f;
  law.artificial = 0.3f;
  law.eta2 = static_cast<float>(0.01 * h * h);
  law.morris = 0.4f;
  law.gz = -0.05f;
  return law;
}

template <Viscosity Kind>
FluidRates<float> pair(float sign, const FluidPairLaw& law) {
  FluidRates<float> rates;
  // r, v from i to j and back: swap A_i, A_j with the sign.
  const float A_i = sign > 0 ? 0.02f : 0.05f, A_j = sign > 0 ? 0.05f : 0.02f;
  add_fluid_pair<true, true, Kind, true>(law, sign * 0.3f, sign * -0.2f, sign * 0.5f, sign * -1.0f, sign * 0.1f,
                                         sign * 0.4f, A_i, A_j, 1.0f, 1.0f, rates);
  return rates;
}

TEST(FluidPair, action_is_minus_reaction_to_the_last_bit) {
  const FluidPairLaw law = law_for(1.0);
  for (const auto& [a, b] : {std::pair{pair<Viscosity::none>(1, law), pair<Viscosity::none>(-1, law)},
                             std::pair{pair<Viscosity::morris>(1, law), pair<Viscosity::morris>(-1, law)},
                             std::pair{pair<Viscosity::artificial>(1, law), pair<Viscosity::artificial>(-1, law)}}) {
    EXPECT_EQ(a.ax, -b.ax);
    EXPECT_EQ(a.ay, -b.ay);
    EXPECT_EQ(a.az, -b.az);
    EXPECT_EQ(a.compression, b.compression);
    EXPECT_EQ(a.diffusion, -b.diffusion);
  }
}

TEST(FluidPair, hand_values) {
  // r = (0.6, 0, 0.8), |r| = 1, h = 1: t = 0.5, G = 2 * 0.125 = 0.25; v = (-1, 0, 0): v.r = -0.6.
  const FluidPairLaw law = law_for(1.0);
  FluidRates<float> rates;
  add_fluid_pair<true, true, Viscosity::artificial, true>(law, 0.6f, 0.0f, 0.8f, -1.0f, 0.0f, 0.0f, 0.1f, 0.3f, 1.0f,
                                                          1.0f, rates);
  const float Pi = 0.3f * 0.6f / 1.01f;
  EXPECT_NEAR(rates.ax, 0.25f * (0.4f + Pi) * 0.6f, 1e-6);
  EXPECT_NEAR(rates.az, 0.25f * (0.4f + Pi) * 0.8f, 1e-6);
  EXPECT_NEAR(rates.compression, 0.15f, 1e-6);  // approaching: density grows
  EXPECT_NEAR(rates.diffusion, 0.25f * (0.2f - 0.05f * 0.8f), 1e-6);
}

TEST(FluidPair, diffusion_is_never_against_nor_above_the_difference_of_pressure) {
  const FluidPairLaw law = law_for(1.0);
  const auto diffusion = [&](float rz, float jump) {
    FluidRates<float> rates;  // G = 0.25, as above
    add_fluid_pair<false, true, Viscosity::none, true>(law, std::sqrt(1.0f - rz * rz), 0.0f, rz, 0.0f, 0.0f, 0.0f, 0.1f,
                                                       0.1f + jump, 1.0f, 1.0f, rates);
    return rates.diffusion / 0.25f;
  };
  EXPECT_NEAR(diffusion(0.8f, 0.04f), 0.0f, 1e-7) << "hydrostatic: j lies below i";
  EXPECT_NEAR(diffusion(0.8f, 0.1f), 0.06f, 1e-7);
  EXPECT_NEAR(diffusion(-0.8f, 0.1f), 0.1f, 1e-7) << "j lies above i and has the higher pressure: all of it, not 0.14";
  EXPECT_EQ(diffusion(0.8f, 0.03f), 0.0f) << "less than hydrostatic: not made larger";
  EXPECT_EQ(diffusion(-0.8f, -0.03f), 0.0f);
  for (float rz = -0.9f; rz < 1.0f; rz += 0.1f)
    for (float jump = -0.1f; jump < 0.1f; jump += 0.007f)
      EXPECT_GE(diffusion(rz, jump) * jump, 0.0f) << rz << " " << jump;
}

TEST(FluidPair, separating_particles_feel_no_artificial_viscosity) {
  const FluidPairLaw law = law_for(1.0);
  FluidRates<float> with, without;
  add_fluid_pair<true, false, Viscosity::artificial, false>(law, 0.6f, 0.0f, 0.8f, 1.0f, 0.0f, 0.0f, 0.1f, 0.3f, 1.0f,
                                                            1.0f, with);
  add_fluid_pair<true, false, Viscosity::none, false>(law, 0.6f, 0.0f, 0.8f, 1.0f, 0.0f, 0.0f, 0.1f, 0.3f, 1.0f, 1.0f,
                                                      without);
  EXPECT_EQ(with.ax, without.ax);
}

TEST(FluidPair, a_particle_adds_nothing_to_itself_and_padding_adds_nothing) {
  const FluidPairLaw law = law_for(1.0);
  FluidRates<float> rates;
  add_fluid_pair<true, true, Viscosity::artificial, true>(law, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.3f, 0.3f, 1.0f,
                                                          1.0f, rates);
  add_fluid_pair<true, true, Viscosity::artificial, true>(law, -1e15f, -1e15f, -1e15f, 1.0f, 2.0f, 0.0f, 0.3f, 0.0f,
                                                          1.0f, 1.0f, rates);
  EXPECT_EQ(rates.ax, 0.0f);
  EXPECT_EQ(rates.compression, 0.0f);
  EXPECT_EQ(rates.diffusion, 0.0f);
}

TEST(SurfaceRows, take_the_imbalance_of_the_first_rows_away) {
  for (const double smoothing_ratio : {1.3, 1.5, 2.0}) {
    const SurfaceRows rows(smoothing_ratio, 3);
    const std::vector<double> lattice(SurfaceRows::count, 0.0), shift = surface_row_shifts(smoothing_ratio, 3);
    ASSERT_EQ(shift.size(), lattice.size());
    EXPECT_LT(rows.acceleration(lattice, 0), -0.02) << "too little presses the first row up";
    EXPECT_GT(rows.acceleration(lattice, 1), 0.02);
    for (int k = 0; k < SurfaceRows::count; ++k) EXPECT_NEAR(rows.acceleration(shift, k), 0.0, 1e-6);
    EXPECT_NEAR(rows.acceleration(shift, SurfaceRows::count + 6), 0.0, 1e-12) << "the lattice is exact below";
  }
  EXPECT_NEAR(surface_row_shifts(1.5, 3)[0], -0.0551, 1e-4);
  EXPECT_NEAR(surface_row_shifts(1.5, 2)[0], -0.0617, 1e-4);
}

TEST(WallPair, a_wall_under_still_water_gets_the_hydrostatic_pressure) {
  // Fluid layers above a wall particle at z = 0, A linear in depth: the extrapolation must be exact.
  const float h = 1.0f, slope = -0.01f, A0 = 0.2f;  // A(z) = A0 + slope z = hydrostatic for g_z/c^2 = slope
  WallSums<float> sums;
  for (int x = -2; x <= 2; ++x)
    for (int z = 1; z <= 2; ++z)
      add_wall_pair(0.5f / h, -0.7f * static_cast<float>(x), 0.0f, -0.7f * static_cast<float>(z),
                    A0 + slope * 0.7f * static_cast<float>(z), sums);
  EXPECT_NEAR((sums.pressure + slope * sums.rz) / sums.weight, A0, 1e-6);
}

TEST(WallGuard, stops_half_way_to_the_wall_and_leaves_the_rest_alone) {
  WallGuardSums<float> sums;
  for (int k = -1; k <= 1; ++k) {
    const float r[3] = {0.5f * static_cast<float>(k), 0.0f, 0.9f}, n[3] = {0.0f, 0.0f, 1.0f}, v[3] = {0, 0, 0};
    add_wall_guard(0.5f, r, n, 0.5f, v, sums);  // the surface lies 0.5 above these: s = 0.4
  }
  const NearWall wall{sums.weight, sums.distance, sums.nx, sums.ny, sums.nz, sums.wall_speed};
  const Vec3f fast = guarded_velocity({3.0f, 0.0f, -10.0f}, wall, 0.1f, 100.0f, 1.0f);
  EXPECT_NEAR(fast.z, -0.5f * 0.4f / 0.1f, 1e-5f);
  EXPECT_EQ(fast.x, 3.0f);
  const Vec3f slow = guarded_velocity({3.0f, 0.0f, -1.9f}, wall, 0.1f, 100.0f, 1.0f);
  EXPECT_EQ(slow.z, -1.9f);
  EXPECT_EQ(guarded_velocity({0, 0, -9.0f}, {}, 0.1f, 100.0f, 1.0f).z, -9.0f);
}

TEST(WallGuard, pushes_out_what_lies_deeper_than_a_tenth_of_a_spacing) {
  const auto behind = [](float s, float v) {
    return guarded_velocity({0.0f, 0.0f, v}, {1.0f, s, 0.0f, 0.0f, 1.0f, 0.0f}, 0.1f, 1000.0f, 1.0f).z;
  };
  EXPECT_EQ(behind(-0.05f, -2.0f), 0.0f) << "no further in, and not thrown";
  EXPECT_EQ(behind(-0.05f, 0.5f), 0.5f);
  EXPECT_NEAR(behind(-0.6f, -2.0f), 0.5f, 1e-6f) << "half a spacing too deep, out in ten steps";
  EXPECT_NEAR(behind(-900.0f, 0.0f), 50.0f, 1e-3f) << "c/20 at most";
}

// -grad C and D over a square lattice of spacing dp, particles with z > top left out, one moved by (dx, 0).
SpacingSums<float> lattice_spacing(double dp, double h, double top, double dx) {
  SpacingSums<float> sums;
  const double slope = dp * dp * 5.0 * wendland_normalisation(h, 2) / (h * h) / lattice_gradient_moment(h / dp, 2);
  for (int i = -4; i <= 4; ++i)
    for (int k = -4; k <= 4; ++k) {
      if ((i == 0 && k == 0) || k * dp > top) continue;
      const float r[3] = {static_cast<float>(-i * dp + dx), 0.0f, static_cast<float>(-k * dp)};
      add_spacing_pair(static_cast<float>(0.5 / h), static_cast<float>(slope), r, 1.0f, sums);
    }
  return sums;
}

TEST(Shifting, moves_back_towards_the_lattice_and_not_at_the_surface) {
  const double dp = 0.1, h = 0.15;
  const SpacingSums<float> inside = lattice_spacing(dp, h, 1.0, 0.0);
  EXPECT_NEAR(inside.divergence, 2.0f, 0.02f);
  EXPECT_NEAR(inside.x, 0.0f, 1e-4f);
  const SpacingSums<float> displaced = lattice_spacing(dp, h, 1.0, 0.02);
  const Vec3f back = shift_of({displaced.x, displaced.y, displaced.z}, 0.0f, 1.0f, 0.3f, 0.01f);
  EXPECT_LT(back.x, 0.0f);
  EXPECT_NEAR(back.x, 0.3f * 0.01f * displaced.x, 1e-7f);
  EXPECT_NEAR(back.z, 0.0f, 1e-7f);
  const SpacingSums<float> surface = lattice_spacing(dp, h, 0.05, 0.0);
  EXPECT_LT(surface.divergence, surface_divergence * 2.0f);
  EXPECT_GT(displaced.divergence, surface_divergence * 2.0f);
  EXPECT_GT(surface.z, 1.0f) << "without f they would be pushed out of the water";
  EXPECT_EQ(norm(shift_of({surface.x, surface.y, surface.z}, 0.5f, 1.0f, 0.3f, 0.01f)), 0.0f)
      << "within h of the surface";
  EXPECT_EQ(norm(shift_of({1.0f, 0.0f, 0.0f}, 0.0f, 0.0f, 0.3f, 0.01f)), 0.0f) << "still water stays";
  EXPECT_NEAR(norm(shift_of({1e6f, 0.0f, 0.0f}, 0.0f, 1.0f, 0.3f, 0.01f)), 0.4f * 0.01f, 1e-6f) << "bounded";
}

TEST(TensileControl, turns_the_sign_of_tension_inside_only) {
  EXPECT_EQ(controlled_pressure(-3.0f, 0.0f), 3.0f);
  EXPECT_EQ(controlled_pressure(-3.0f, 1.0f), -3.0f) << "at the surface";
  EXPECT_EQ(controlled_pressure(5.0f, 0.0f), 5.0f);
}

TEST(WallGuard, crest_of_a_dam_does_not_speak_for_water_beside_its_face) {
  // A dam of 7 m above the water particle, face at 2 m: below the crest's plane, but well outside.
  WallGuardSums<float> sums;
  const float v[3] = {0, 0, 0}, out[3] = {1.0f, 0.0f, 0.0f}, up[3] = {0.0f, 0.0f, 1.0f};
  const float face[3] = {6.0f, 0.0f, 0.0f}, crest[3] = {10.0f, 0.0f, 0.0f};  // from wall particles 4 m and 8 m behind
  add_wall_guard(1.0f / 16.0f, face, out, 4.0f, v, sums);
  add_wall_guard(1.0f / 16.0f, crest, up, 7.0f, v, sums);
  EXPECT_GT(sums.distance / sums.weight, 1.8f);
  EXPECT_GT(sums.nx, 20.0f * sums.nz);
}

TEST(WallGuard, far_face_of_a_ridge_does_not_speak_for_water_on_this_side) {
  // dp = 16 m. A ridge thinner than that, whose one particle faces away (-y); behind it the dam faces the water (+y).
  WallGuardSums<float> sums;
  const float v[3] = {0, 0, 0}, away[3] = {0.0f, -1.0f, 0.0f}, out[3] = {0.0f, 1.0f, 0.0f};
  const float ridge[3] = {0.0f, 16.0f, 0.0f}, dam[3] = {0.0f, 32.0f, 0.0f};
  add_wall_guard(1.0f / 32.0f, ridge, away, 1.0f, v, sums);
  add_wall_guard(1.0f / 32.0f, dam, out, 4.0f, v, sums);
  EXPECT_NEAR(sums.distance / sums.weight, 28.0f, 1e-4f);
  EXPECT_EQ(guarded_velocity({}, {sums.weight, sums.distance, sums.nx, sums.ny, sums.nz, sums.wall_speed}, 0.02f,
                             400.0f, 16.0f)
                .y,
            0.0f);
  // Water that is inside is told so: 0.4 dp from the wall particle, 0.6 dp below the surface.
  WallGuardSums<float> within;
  const float close[3] = {0.0f, -6.4f, 0.0f};
  add_wall_guard(1.0f / 32.0f, close, out, 3.2f, v, within);
  EXPECT_NEAR(within.distance / within.weight, -9.6f, 1e-4f);
}

TEST(WallGuard, water_that_touches_a_face_is_not_thrown_by_the_crest_above) {
  // Alpe Gera, dp = 8 m: a centimetre behind the dam's oblique face, whose nearest particle is 1.04 dp away; the crest is 5.5 m above.
  const float v[3] = {0, 0, 0}, up[3] = {0.0f, 0.0f, 1.0f}, out[3] = {-0.31f, 0.95f, 0.0f};
  const float crest[3] = {-0.1f, 7.75f, 1.94f}, face[3] = {-8.1f, -0.25f, 1.94f};
  for (bool beside_face : {true, false}) {
    WallGuardSums<float> sums;
    add_wall_guard(1.0f / 16.0f, crest, up, 7.44f, v, sums);
    if (beside_face) add_wall_guard(1.0f / 16.0f, face, out, 2.28f, v, sums);
    const Vec3f free{0.3f, -0.1f, 0.2f};
    const Vec3f kept = guarded_velocity(free, {sums.weight, sums.distance, sums.nx, sums.ny, sums.nz, sums.wall_speed},
                                        0.0145f, 400.0f, 8.0f);
    EXPECT_LT(norm(kept - free), 0.25f) << "the crest alone gave 20 m/s";
  }
}

TEST(WallPair, a_wall_above_still_water_neither_pushes_nor_pulls) {
  EXPECT_EQ(pressing_wall(-0.3f, 0.3f), -0.3f) << "the linear field of still water: the pair's sum is zero";
  EXPECT_FLOAT_EQ(pressing_wall(-0.1f, 0.3f), -0.3f)
      << "the second row is not pushed off a wall that has air beside it";
  EXPECT_FLOAT_EQ(pressing_wall(-0.01f, 0.3f), -0.04f) << "and what changes sign does so without a jump";
  EXPECT_EQ(pressing_wall(-0.5f, 0.3f), -0.3f) << "never pulls";
  EXPECT_EQ(pressing_wall(0.2f, 0.3f), 0.2f);
  EXPECT_EQ(pressing_wall(-0.2f, -0.3f), 0.0f) << "water in tension finds the wall at zero";
}

// @eq sph.wall.no-slip
// Water around a wall particle at the origin, of which the surface above has the normal z.
WallVolumeSums<double> around_wall(const Vec3d& velocity, double porosity) {
  FluidPairLaw law{};
  law.inverse_support = 0.25f;
  law.slope = 2.0f;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-2.0, 2.0);
  WallVolumeSums<double> sums;
  for (int k = 0; k < 20; ++k) {
    const Vec3d at{u(random), u(random), 1.0 + 0.5 * u(random)};
    add_wall_volume<double>(law, {-at.x, -at.y, -at.z}, {-velocity.x, -velocity.y, -velocity.z}, 1.1, porosity, sums);
  }
  return sums;
}

TEST(WallVolume, is_that_of_water_that_comes_near_and_not_of_water_that_slides_by) {
  const double up[3] = {0.0, 0.0, 1.0}, unknown[3] = {0.0, 0.0, 0.0};
  const auto sliding = around_wall({3.0, -2.0, 0.0}, 1.0), coming = around_wall({0.0, 0.0, -1.0}, 1.0);
  EXPECT_GT(std::abs(wall_volume(sliding, unknown, 0.9)), 0.01);
  EXPECT_NEAR(wall_volume(sliding, up, 0.9), 0.0, 1e-6);
  EXPECT_GT(wall_volume(coming, up, 0.9), 0.1);  // compressed
  EXPECT_NEAR(wall_volume(coming, up, 0.9), 0.9 * coming.compression / coming.weight, 1e-6);
  // Among grains all of it counts.
  EXPECT_NEAR(wall_volume(around_wall({3.0, -2.0, 0.0}, 0.6), up, 0.9), wall_volume(sliding, unknown, 0.9), 1e-6);
}

TEST(WallExtrapolation, a_no_slip_wall_continues_the_profile) {
  // A wall particle half a spacing deep and water that is 0.7 spacings high in the mean: linear through zero at the surface.
  const float share = no_slip_share(0.5f, 0.5f + 0.7f), slope = 3.0f;
  EXPECT_FLOAT_EQ(-share * slope * 0.7f, slope * -0.5f);
  EXPECT_EQ(no_slip_share(2.5f, 2.5f + 0.5f), 3.0f) << "deep layers are bounded";
  EXPECT_EQ(no_slip_share(0.5f, 0.4f), 3.0f)
      << "beside an edge the mean of the water may lie below the surface's plane";
  EXPECT_EQ(no_slip_share(0.5f, 0.0f), 1.0f) << "no normal: mirrored";
}

TEST(RecordPacker, water_in_tension_has_no_pressure_where_it_cavitates) {
  Domain domain{};
  domain.tile_size = {1, 1, 1};
  const Vec3<std::int32_t> tile{};
  const std::uint32_t id[4] = {0, 1, 2, 3};
  float record[32] = {};
  RecordPacker packer{domain, false, &tile, id, nullptr, nullptr, true, record};
  packer(0, FixedPosition{}, Vec3f{}, -0.01f);
  packer(1, FixedPosition{}, Vec3f{}, 0.01f);
  EXPECT_EQ(record[28], 0.0f);
  EXPECT_GT(record[29], 0.0f);
  packer.cavitates = false;
  packer(0, FixedPosition{}, Vec3f{}, -0.01f);
  EXPECT_LT(record[28], 0.0f);
}

}  // namespace
}  // namespace gdesp::sph
