// SPDX-License-Identifier: GPL-3.0-or-later
#include "neighbors/domain.hpp"

#include <gtest/gtest.h>

namespace gdesp {
namespace {

const bool closed[3] = {false, false, false};

// A slow drift far from the origin: the reason for positions in integers (issue: float32 freezes there).
TEST(Domain, a_slow_drift_is_exact_at_the_far_end_of_a_large_domain) {
  const double dp = 1.0, h = 1.3;
  const double length = 1.0e5 * h;
  const Domain domain = make_domain({0, 0, 0}, {length, 10, 10}, dp, closed, 3);
  const double start = 0.9 * length, step = 1.0e-5 * h;
  FixedPosition p = domain.fixed({start, 1.0, 1.0});
  float naive = static_cast<float>(start);
  const int steps = 20'000;
  for (int k = 0; k < steps; ++k) {
    p = domain.moved(p, {step, 0.0, 0.0});
    naive += static_cast<float>(step);
  }
  const double expected = steps * step;
  const double half_a_unit = 0.5 * domain.tile_size.x / Domain::one_tile;
  EXPECT_NEAR((domain.metres(p).x - start) / expected, 1.0, 1.01 * half_a_unit / step);  // 6e-4
  EXPECT_EQ(naive, static_cast<float>(start));  // the wrong variant does not move at all
}

TEST(Domain, separations_are_exact_at_utm_coordinates) {
  const Vec3d corner{5.0e5, 5.1e6, 300.0};
  const Domain domain = make_domain(corner, corner + Vec3d{5000, 5000, 500}, 0.5, closed, 3);
  const FixedPosition a = domain.fixed(corner + Vec3d{4000.1, 4321.2, 17.0});
  const FixedPosition b = domain.fixed(corner + Vec3d{4000.4, 4321.0, 17.1});
  const Vec3f r = domain.separation(a, b);
  EXPECT_NEAR(r.x, -0.3f, 1e-6);
  EXPECT_NEAR(r.y, 0.2f, 1e-6);
  EXPECT_NEAR(r.z, -0.1f, 1e-6);
}

TEST(Domain, wraps_along_periodic_axes_only) {
  const bool periodic[3] = {true, false, false};
  const Domain domain = make_domain({0, 0, 0}, {10, 10, 10}, 0.1, periodic, 3);
  const FixedPosition outside = domain.moved(domain.fixed({9.95, 5, 5}), {0.1, 0, 0});
  EXPECT_NEAR(domain.metres(domain.wrapped(outside)).x, 0.05, 1e-7);
  EXPECT_NEAR(domain.separation(domain.fixed({0.05, 5, 5}), domain.fixed({9.95, 5, 5})).x, 0.1f, 1e-6);
  EXPECT_TRUE(domain.inside(domain.wrapped(outside)));
  EXPECT_FALSE(domain.inside(domain.moved(domain.fixed({5, 0.05, 5}), {0, -0.1, 0})));
}

}  // namespace
}  // namespace gdesp
