// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/run_up.hpp"

#include <gtest/gtest.h>

#include "core/triangle.hpp"
#include "exact_fields.hpp"

namespace gdesp::analysis {
namespace {

using analysis_test::fill;
constexpr double dp = 0.1;

// A channel 0 <= y <= 2 with a floor at z = 0 up to x = 4 and a beach that rises 1:2 from there to x = 10.
double bed(double x) { return std::max(0.0, 0.5 * (x - 4.0)); }

TriangleTable beach() {
  TriangleTable t;
  t.vertex = {{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 2, 0}, {10, 0, 3}, {10, 2, 3}};
  t.triangle = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  t.body = {0, 0, 0, 0};
  return t;
}

std::vector<Vec3d> water_up_to(double level, double tongue_end, double tongue_thickness) {
  return fill({0, 0, 0}, {10, 2, 3.4}, dp, 3, [&](const Vec3d& p) {
    if (p.z < bed(p.x)) return false;
    return p.z < level || (p.x < tongue_end && p.z < bed(p.x) + tongue_thickness);
  });
}

const std::vector<BankRegion> anywhere{{"all", {}, {}, {}}};

RunUpFrame read(const std::vector<Vec3d>& water, const TriangleTable& walls, const std::vector<BankRegion>& regions,
                const std::vector<float>& density = {}) {
  const ColumnGrid grid(water, 0.26, 3);
  return measure_run_up(grid, find_connected_water(grid, dp, {}, density), {dp, 1.0, 2.6 * dp}, WallSurface(walls),
                        regions);
}

TEST(RunUp, StillWaterDoesNotClimb) {
  const auto p = water_up_to(1.0, 0.0, 0.0);
  const RunUpFrame f = read(p, beach(), anywhere);
  EXPECT_NEAR(f.region[0].height, 0.0, 1e-9);
  EXPECT_EQ(f.region[0].splash, 0.0);
}

// A tongue on the beach that ends at x = 8: its top there is bed(8) + thickness, up to the lattice.
TEST(RunUp, ATongueOnTheBeachIsReadToOneParticle) {
  const auto p = water_up_to(1.0, 8.0, 0.25);
  const RunUpFrame f = read(p, beach(), anywhere);
  EXPECT_TRUE(f.region[0].climbs);
  EXPECT_NEAR(f.region[0].height, bed(8.0) + 0.25 - 1.0, dp);
  EXPECT_NEAR(f.region[0].at.x, 8.0, 2 * dp);
}

// The last row of the tongue thinned to a film: single particles on the beach, two spacings apart. A drop farther on is splash.
TEST(RunUp, AFilmThinnerThanAParticleIsFollowed) {
  auto p = water_up_to(1.0, 8.0, 0.25);
  for (const double x : {8.15, 8.35, 8.55, 9.4}) {
    for (double y = 0.5 * dp; y < 2.0; y += dp) {
      if (x < 9.0 || std::abs(y - 1.0) < dp) p.push_back({x, y, bed(x) + 0.03});
    }
  }
  const RunUpFrame f = read(p, beach(), anywhere);
  EXPECT_NEAR(f.region[0].height, bed(8.55) + 0.03 + 0.5 * dp - 1.0, 1e-9);
  EXPECT_NEAR(f.region[0].splash, bed(9.4) + 0.03 + 0.5 * dp - 1.0, 1e-9);
}

TEST(RunUp, SplashOnTheBankAndAWaveInTheMiddleDoNotCount) {
  auto p = water_up_to(1.0, 0.0, 0.0);
  const auto crest = fill({1, 0, 1}, {2, 2, 1.8}, dp, 3, [](const Vec3d&) { return true; });  // away from any wall
  p.insert(p.end(), crest.begin(), crest.end());
  p.push_back({9.0, 1.0, bed(9.0) + 0.05});
  const RunUpFrame f = read(p, beach(), anywhere);
  EXPECT_NEAR(f.region[0].height, 0.0, 1e-9);
  EXPECT_NEAR(f.region[0].splash, bed(9.0) + 0.1 - 1.0, 1e-9);
}

// A crest of three spacings over a shoal two spacings deep, far from the shore, is within reach of the bed and no run-up.
TEST(RunUp, AWaveOverAShoalHasNotClimbed) {
  TriangleTable walls = beach();
  const auto base = static_cast<std::int32_t>(walls.vertex.size());
  walls.vertex.insert(walls.vertex.end(), {{1, 0, 0.8}, {2, 0, 0.8}, {2, 2, 0.8}, {1, 2, 0.8}});
  walls.triangle.insert(walls.triangle.end(), {{base, base + 1, base + 2}, {base, base + 2, base + 3}});
  walls.body.insert(walls.body.end(), 2, 0);
  auto p = water_up_to(1.0, 0.0, 0.0);
  std::erase_if(p, [](const Vec3d& q) { return q.x > 1.0 && q.x < 2.0 && q.z < 0.8; });
  const auto crest = fill({1, 0, 1}, {2, 2, 1.3}, dp, 3, [](const Vec3d&) { return true; });
  p.insert(p.end(), crest.begin(), crest.end());
  EXPECT_NEAR(read(p, walls, anywhere).region[0].height, 0.0, 1e-9);
}

// A jet against the wall that is joined to the lake, but whose density has fallen apart: torn water, counted as splash.
TEST(RunUp, TornWaterIsSplash) {
  auto p = water_up_to(1.0, 0.0, 0.0);
  const std::size_t whole = p.size();
  const auto jet = fill({5.5, 0.5, 1}, {6, 1.5, 2.5}, dp, 3, [](const Vec3d& q) { return q.z > bed(q.x); });
  p.insert(p.end(), jet.begin(), jet.end());
  std::vector<float> density(p.size(), 1.0f);
  EXPECT_NEAR(read(p, beach(), anywhere, density).region[0].height, 0.3, 1e-6);  // of the jet what lies on the beach
  for (std::size_t k = whole; k < p.size(); ++k) density[k] = 0.7f;
  const RunUpFrame torn = read(p, beach(), anywhere, density);
  EXPECT_NEAR(torn.region[0].height, 0.0, 1e-9);
  EXPECT_NEAR(torn.region[0].splash, 1.5, 1e-9);
}

// Drops that pass the wall next to the lake are no film: their density tells.
TEST(RunUp, TornParticlesBesideTheSheetAreNoFilm) {
  auto p = water_up_to(1.0, 8.0, 0.25);
  const std::size_t whole = p.size();
  for (const double x : {8.15, 8.35, 8.55}) {
    for (double y = 0.5 * dp; y < 2.0; y += dp) p.push_back({x, y, bed(x) + 0.03});
  }
  std::vector<float> density(p.size(), 1.0f);
  const double with_film = read(p, beach(), anywhere, density).region[0].height;
  for (std::size_t k = whole; k < p.size(); ++k) density[k] = 0.5f;
  const double torn = read(p, beach(), anywhere, density).region[0].height;
  p.resize(whole);
  density.resize(whole);
  EXPECT_EQ(torn, read(p, beach(), anywhere, density).region[0].height);
  EXPECT_GT(with_film, torn);
}

TEST(RunUp, AVerticalWallIsABank) {
  TriangleTable wall;
  wall.vertex = {{0, 0, 0}, {0, 2, 0}, {0, 2, 4}, {0, 0, 4}};
  wall.triangle = {{0, 1, 2}, {0, 2, 3}};
  const auto p =
      fill({0, 0, 0}, {3, 2, 4}, dp, 3, [](const Vec3d& q) { return q.z < 1.0 || (q.x < 0.2 && q.z < 2.5); });
  const RunUpFrame f = read(p, wall, anywhere);
  EXPECT_NEAR(f.region[0].height, 1.5, 1e-9);
}

TEST(RunUp, AMovingBodyIsNoBank) {
  TriangleTable gate = beach();
  const std::int32_t first = static_cast<std::int32_t>(gate.vertex.size());
  gate.vertex.insert(gate.vertex.end(), {{1.5, 0, 0}, {1.5, 2, 0}, {1.5, 2, 4}});
  gate.triangle.push_back({first, first + 1, first + 2});
  gate.body.push_back(1);
  auto p = water_up_to(1.0, 0.0, 0.0);
  const auto crest = fill({1, 0, 1}, {2, 2, 1.8}, dp, 3, [](const Vec3d&) { return true; });
  p.insert(p.end(), crest.begin(), crest.end());
  const RunUpFrame f = read(p, gate, anywhere);
  EXPECT_NEAR(f.region[0].height, 0.0, 1e-9);
}

TEST(RunUp, RegionsAreReadApart) {
  auto p = water_up_to(1.0, 0.0, 0.0);
  const auto left = fill({5, 0, 1}, {7, 1, 1.6}, dp, 3, [](const Vec3d& q) { return q.z > bed(q.x); });
  p.insert(p.end(), left.begin(), left.end());
  const std::vector<BankRegion> regions{{"right half", {{0, 1}, {10, 1}, {10, 2}, {0, 2}}, {}, {}},
                                        {"left half", {{0, 0}, {10, 0}, {10, 1}, {0, 1}}, {}, {}},
                                        {"side", {}, Point2{0, 1}, Point2{1, 0}}};
  const RunUpFrame f = read(p, beach(), regions);
  EXPECT_NEAR(f.region[0].height, 0.0, 1e-9);
  EXPECT_GT(f.region[1].height, 0.4);
  EXPECT_NEAR(f.region[2].height, 0.0, 1e-9) << "left of the axis is y > 1";
}

TEST(ShoreProfile, KeepsTheHighestPerBinAndItsTime) {
  ShoreProfile profile({0, 0}, {10, 0}, 1.0);
  profile.add(1.0, std::vector<BankParticle>{{{2.5, 3, 0}, 0.4}, {{2.6, 1, 0}, 0.6}}, anywhere[0]);
  profile.add(2.0, std::vector<BankParticle>{{{2.5, 3, 0}, 0.5}, {{7.2, 1, 0}, 0.1}, {{11, 0, 0}, 9.0}}, anywhere[0]);
  EXPECT_NEAR(profile.bins()[2].height, 0.6, 1e-12);
  EXPECT_NEAR(profile.bins()[2].time, 1.0, 1e-12);
  EXPECT_NEAR(profile.bins()[7].height, 0.1, 1e-12);
  EXPECT_FALSE(profile.bins()[0].any);
}

TEST(LongAxis, FollowsTheLake) {
  const auto lake = fill({0, 0, 0}, {10, 2, 0.1}, dp, 3, [](const Vec3d&) { return true; });
  const LongAxis axis = find_long_axis(lake);
  EXPECT_NEAR(std::abs(axis.direction.x), 1.0, 1e-6);
  EXPECT_NEAR(axis.centre.x, 5.0, 1e-9);
  EXPECT_NEAR(std::abs(axis.to.x - axis.from.x), 9.9, 1e-6);
}

TEST(WallSurface, DistanceAgreesWithAllTriangles) {
  TriangleTable t;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      const std::int32_t v = static_cast<std::int32_t>(t.vertex.size());
      const auto z = [](double x, double y) { return std::sin(x) * std::cos(0.7 * y); };
      t.vertex.insert(t.vertex.end(), {{i * 1.0, j * 1.0, z(i, j)},
                                       {i + 1.0, j * 1.0, z(i + 1, j)},
                                       {i + 1.0, j + 1.0, z(i + 1, j + 1)},
                                       {i * 1.0, j + 1.0, z(i, j + 1)}});
      t.triangle.insert(t.triangle.end(), {{v, v + 1, v + 2}, {v, v + 2, v + 3}});
    }
  }
  const WallSurface wall(t);
  for (int k = 0; k < 200; ++k) {
    const Vec3d p{10 + 12 * std::sin(k * 1.7), 10 + 12 * std::cos(k * 2.3), 2 * std::sin(k * 0.9)};
    double best = 1e300;
    for (const auto& f : t.triangle) {
      best = std::min(best, norm(p - closest_point(p, t.vertex[f.x], t.vertex[f.y], t.vertex[f.z])));
    }
    const auto found = wall.nearest(p, 1.0);
    EXPECT_EQ(found.has_value(), best <= 1.0);
    if (found) { EXPECT_NEAR(norm(*found - p), best, 1e-12); }
  }
  EXPECT_NEAR(wall.height(3.0, 4.0).value(), std::sin(3.0) * std::cos(2.8), 1e-9);
  EXPECT_FALSE(wall.height(-1.0, 4.0));
}

TEST(WallSurface, TheGroundIsTheFloorOfAClosedTankNotItsLid) {
  TriangleTable t;
  t.vertex = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 1, 2}};
  t.triangle = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};  // normals into the tank
  EXPECT_NEAR(WallSurface(t).height(0.3, 0.4).value(), 0.0, 1e-12);
  t.triangle = {{4, 6, 5}, {4, 7, 6}};
  EXPECT_NEAR(WallSurface(t).height(0.3, 0.4).value(), 2.0, 1e-12) << "nothing faces up";
  EXPECT_FALSE(WallSurface(t).height(1.3, 0.4));
}

}  // namespace
}  // namespace gdesp::analysis
