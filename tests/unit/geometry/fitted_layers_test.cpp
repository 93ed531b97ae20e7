// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/fitted_layers.hpp"

#include <algorithm>
#include <map>

#include "geometry/water_relaxation.hpp"
#include "support.hpp"

namespace gdesp::geometry {
namespace {

constexpr double pi = 3.14159265358979323846, dp = 0.1;

// The solid below a plane through the origin, in the plane x-z, `angle` degrees down along x.
struct Slope {
  Vec3d up, along;
  TriangleMesh mesh;
  Lattice lattice{{0, -0.5 * dp, 0}, dp, 2};
  std::vector<BandPoint> band;

  explicit Slope(double angle) : up{std::sin(angle * pi / 180), 0, std::cos(angle * pi / 180)}, along{up.z, 0, -up.x} {
    const Vec3d end = along * 9.0, side{0, 9, 0};
    mesh.vertex = {end * -1.0 - side, end - side, end + side, end * -1.0 + side};
    mesh.triangle = {{0, 1, 2}, {0, 2, 3}};
    for (std::int32_t i = -40; i < 40; ++i) {
      for (std::int32_t k = -60; k < 60; ++k) {
        const double s = dot(lattice.point({i, 0, k}), up);
        if (std::abs(s) < fitted_band * dp)
          band.push_back({{i, 0, k}, static_cast<float>(s), static_cast<Vec3f>(up), 0});
      }
    }
  }
  LayerRequest request() const { return {&mesh, lattice, {{-9, -9, -9}, {9, 9, 9}}, {}, {}, 0.0}; }
};

TEST(FittedLayers, CubeBelowPlaneByHand) {
  EXPECT_NEAR(cube_below_plane({0, 0, 1}, 0.25), 0.75, 2e-3);  // slab
  EXPECT_NEAR(cube_below_plane({0, 0, 1}, -0.6), 0.0, 1e-12);
  const double half = std::sqrt(0.5), third = std::sqrt(1.0 / 3.0);
  EXPECT_NEAR(cube_below_plane({half, 0, half}, -0.25 * std::sqrt(2.0)), 0.125, 2e-3);  // prism of legs 1/2
  EXPECT_NEAR(cube_below_plane({third, third, third}, -third), 1.0 / 48.0, 1e-9);       // corner of legs 1/2
  EXPECT_NEAR(cube_below_plane({third, third, third}, 0.0), 0.5, 1e-12);
  EXPECT_NEAR(cube_below_plane({0.6, 0, -0.8}, 0.3) + cube_below_plane({0.6, 0, -0.8}, -0.3), 1.0, 1e-9);
}

// Three layers at dp/2, 3dp/2, 5dp/2, each with one particle a dp; 45 degrees and 1:2 are where lattice rows fall together.
TEST(FittedLayers, EvenAtAnyAngle) {
  for (const double angle : {0.0, 11.31, 26.565, 30.0, 45.0, 60.0}) {
    const Slope slope(angle);
    std::map<int, std::vector<double>> layer;
    for (const LayerPoint& p : fit_layers(slope.band, slope.request())) {
      EXPECT_NEAR(-dot(p.position, slope.up), p.depth, 1e-6 * dp);
      EXPECT_NEAR(norm(p.normal - slope.up), 0.0, 1e-6);
      layer[static_cast<int>(p.depth / dp)].push_back(dot(p.position, slope.along) / dp);
    }
    ASSERT_EQ(layer.size(), 3u) << angle;
    for (auto& [k, at] : layer) {
      std::sort(at.begin(), at.end());
      double square = 0.0;
      std::size_t n = 0;
      for (std::size_t i = 8; i + 8 < at.size(); ++i, ++n) square += std::pow(at[i + 1] - at[i] - 1.0, 2);
      ASSERT_GT(n, 30u) << angle;
      EXPECT_LT(std::sqrt(square / static_cast<double>(n)), 0.05) << "layer " << k << " at " << angle << " degrees";
    }
  }
}

TEST(FittedLayers, BesideWaterThatAsksForItTheLatticeStays) {
  const Slope slope(30.0);
  LayerRequest request = slope.request();
  request.wet = {slope.lattice.point({-10, 0, 6})};
  request.wet_reach = 4.0 * dp;
  int near = 0;
  for (const LayerPoint& p : fit_layers(slope.band, request)) {
    if (norm(p.position - request.wet[0]) > 2.5 * dp) continue;
    ++near;
    const double x = p.position.x / dp - 0.5;
    EXPECT_NEAR(x, std::round(x), 1e-9);
  }
  EXPECT_GT(near, 3);
}

TEST(FittedLayers, ARidgeTooThinForALayerKeepsItsLatticePoints) {
  TriangleMesh ridge;  // between z = 0 and z = 0.6 dp
  ridge.vertex = {{-9, -9, 0},    {9, -9, 0},    {9, 9, 0},    {-9, 9, 0},
                  {-9, -9, 0.06}, {9, -9, 0.06}, {9, 9, 0.06}, {-9, 9, 0.06}};
  ridge.triangle = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  const Lattice lattice{{0, -0.5 * dp, 0}, dp, 2};
  std::vector<BandPoint> band;
  for (std::int32_t i = 0; i < 20; ++i) {
    for (std::int32_t k = -3; k < 4; ++k) {
      const double z = lattice.coordinate(2, k);
      const float s = static_cast<float>(z > 0.03 ? z - 0.06 : -z);
      band.push_back({{i, 0, k}, s, {0, 0, z > 0.03 ? 1.0f : -1.0f}, 0});
    }
  }
  const auto layers = fit_layers(band, {&ridge, lattice, {{-9, -9, -9}, {9, 9, 9}}, {}, {}, 0.0});
  EXPECT_EQ(std::count_if(layers.begin(), layers.end(),
                          [](const LayerPoint& p) { return std::abs(p.position.z - 0.05) < 1e-9; }),
            20);
}

// What the pressure of still water feels: sum V0 grad W, of water and walls, with air above.
double unevenness(const std::vector<Vec3d>& water, const BoundaryTable& walls, double h) {
  double worst = 0.0;
  for (const Vec3d& p : water) {
    if (p.z > -0.4 || std::abs(p.x) > 1.0) continue;  // away from the surface, and from the ends
    Vec3d sum;
    for (const auto* list : {&water, &walls.position}) {
      for (const Vec3d& q : *list) {
        const double t = std::max(0.0, 1.0 - norm(p - q) / (2.0 * h));
        sum += (p - q) * (dp * dp * 5.0 * 7.0 / (4.0 * pi * h * h * h * h) * t * t * t);
      }
    }
    worst = std::max(worst, norm(sum) * dp);
  }
  return worst;
}

TEST(WaterRelaxation, LeavesNothingForPressureToPushAgainst) {
  const Slope slope(26.565);
  BoundaryTable walls;
  for (const LayerPoint& p : fit_layers(slope.band, slope.request())) walls.position.push_back(p.position);
  FillSpace space;
  space.lattice = slope.lattice;
  space.columns.i0 = -40;
  space.columns.grid = {slope.lattice.coordinate(0, -40), 0.0, dp, 80, 1};
  space.solid.first = {0};
  std::vector<Vec3d> water;
  for (std::int32_t i = -40; i < 40; ++i) {
    const double ground = -slope.up.x / slope.up.z * slope.lattice.coordinate(0, i);
    space.solid.interval.push_back({-1e300, ground});
    space.solid.first.push_back(space.solid.interval.size());
    for (std::int32_t k = -60; k < 0; ++k) {
      if (slope.lattice.coordinate(2, k) > ground && slope.lattice.coordinate(2, k) < ground + 1.5)
        water.push_back(slope.lattice.point({i, 0, k}));
    }
  }
  std::vector<Vec3d> settled = water;
  const double h = 1.5 * dp;
  relax_water(settled, walls, 0, walls.position.size(), space, h);
  EXPECT_EQ(settled.size(), water.size());
  EXPECT_LT(unevenness(settled, walls, h), 0.2 * unevenness(water, walls, h));
  for (std::size_t i = 0; i < water.size(); ++i) {
    if (water[i].z > -dp && water[i].x > 1.0) { EXPECT_EQ(settled[i].z, water[i].z) << "the surface stays"; }
  }
}

}  // namespace
}  // namespace gdesp::geometry
