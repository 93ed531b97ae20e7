// SPDX-License-Identifier: GPL-3.0-or-later
// @eq wave.solitary-piston
#include "geometry/solitary_wave.hpp"

#include "geometry/body_builder.hpp"
#include "support.hpp"

namespace gdesp::geometry {
namespace {

TEST(SolitaryWave, piston_moves_the_volume_of_the_wave) {
  const double H = 0.06, d = 0.3, g = 9.81;
  const PrescribedMotion m = solitary_wave_motion(H, d, g, {1, 0, 0}, 0.5);
  const double stroke = 4.0 * std::sqrt(H * (H + d) / 3.0);
  EXPECT_EQ(m.time.front(), 0.5);
  EXPECT_EQ(m.displacement.front().x, 0.0);
  // What lies beyond 0.001 H is left out: tanh of acosh(sqrt(1000)) is 0.9995, on both sides.
  EXPECT_NEAR(m.displacement.back().x, 0.9995 * stroke, 2e-4 * stroke);
  double fastest = 0.0;
  for (std::size_t k = 1; k < m.time.size(); ++k) {
    ASSERT_GT(m.time[k], m.time[k - 1]);
    ASSERT_GE(m.displacement[k].x, m.displacement[k - 1].x);
    fastest = std::max(fastest, (m.displacement[k].x - m.displacement[k - 1].x) / (m.time[k] - m.time[k - 1]));
  }
  // Under the crest the piston moves as the mean of the water does: c H / (d + H).
  EXPECT_NEAR(fastest, std::sqrt(g * (d + H)) * H / (d + H), 1e-3);
}

TEST(SolitaryWave, runs_in_the_direction_that_the_scene_gives) {
  MovingBody piston;
  piston.kind = "piston";
  piston.wave.kind = "solitary";
  piston.wave.height = 0.03;
  piston.wave.depth = 0.3;
  piston.wave.direction = {0.0, -2.0, 0.0};
  const Body body = moving_body(piston, 9.81);
  EXPECT_LT(body.motion.displacement.back().y, 0.0);
  EXPECT_EQ(body.motion.displacement.back().x, 0.0);
}

}  // namespace
}  // namespace gdesp::geometry
