// SPDX-License-Identifier: GPL-3.0-or-later
// @eq coupling.drag.ergun-wen-yu
// @eq coupling.drag.di-felice
#include "coupling/drag.hpp"

#include <gtest/gtest.h>

namespace gdesp::coupling {
namespace {

constexpr double pi = 3.14159265358979;

double sphere(double d) { return pi * d * d * d / 6.0; }

// Speed at which drag carries the submerged weight of a sphere.
template <class Law>
double terminal_velocity(const Law& law, double d, double rho_s, double rho, double mu) {
  double low = 0.0, high = 20.0;
  for (int k = 0; k < 200; ++k) {
    const double v = 0.5 * (low + high);
    const DragState state{1.0f, static_cast<float>(v), static_cast<float>(d), static_cast<float>(rho),
                          static_cast<float>(mu)};
    const double drag = static_cast<double>(law(state)) * sphere(d) * v;
    (drag < (rho_s - rho) * 9.81 * sphere(d) ? low : high) = v;
  }
  return 0.5 * (low + high);
}

TEST(DiFelice, terminal_velocities_of_published_spheres) {
  // 2.7 mm glass bead in water with Dallavalle's coefficient: 0.287 m/s. Robinson et al. (2014), d = 100 um,
  // 2500 kg/m3: water 7.609e-3, water-glycerol 8.27e-4, air 0.501 m/s.
  EXPECT_NEAR(terminal_velocity(di_felice_drag, 2.7e-3, 2500, 1000, 1.0e-3), 0.287, 0.002);
  EXPECT_NEAR(terminal_velocity(di_felice_drag, 1e-4, 2500, 1000, 8.9e-4), 7.609e-3, 0.01 * 7.609e-3);
  EXPECT_NEAR(terminal_velocity(di_felice_drag, 1e-4, 2500, 1150, 8.9e-3), 8.27e-4, 0.02 * 8.27e-4);
  EXPECT_NEAR(terminal_velocity(di_felice_drag, 1e-4, 2500, 1.18, 1.86e-5), 0.501, 0.01 * 0.501);
}

TEST(ErgunWenYu, terminal_velocity_with_schiller_naumann) {
  EXPECT_NEAR(terminal_velocity(ergun_wen_yu_drag, 2.7e-3, 2500, 1000, 1.0e-3), 0.343, 0.002);
}

TEST(ErgunWenYu, pressure_drop_of_a_packed_bed) {
  // Ergun: eps = 0.4, d = 2.7 mm, water, superficial U: 121.8, 1765, 72338 Pa/m. In this form (the pressure gradient acts
  // on grains too) dp/L = K (1 - eps)/eps times the interstitial velocity.
  const double expected[3] = {121.8, 1765.0, 72338.0}, speed[3] = {1e-3, 1e-2, 0.1};
  for (int k = 0; k < 3; ++k) {
    const double eps = 0.4, w = speed[k] / eps;
    const DragState state{0.4f, static_cast<float>(w), 2.7e-3f, 1000.0f, 1.0e-3f};
    EXPECT_NEAR(static_cast<double>(ergun_wen_yu_drag(state)) * (1.0 - eps) / eps * w, expected[k],
                0.002 * expected[k]);
  }
}

TEST(Drag, is_finite_at_rest_and_grows_with_slip) {
  for (float eps : {0.3f, 0.5f, 0.79f, 0.81f, 1.0f}) {
    float before_e = 0.0f, before_f = 0.0f;
    for (float slip : {0.0f, 1e-6f, 1e-3f, 1.0f, 50.0f}) {
      const DragState state{eps, slip, 1e-3f, 1000.0f, 1e-3f};
      const float e = ergun_wen_yu_drag(state), f = di_felice_drag(state);
      EXPECT_TRUE(std::isfinite(e) && std::isfinite(f));
      EXPECT_GE(e, before_e);
      EXPECT_GE(f, 0.99f * before_f);
      before_e = e;
      before_f = f;
    }
  }
}

}  // namespace
}  // namespace gdesp::coupling
