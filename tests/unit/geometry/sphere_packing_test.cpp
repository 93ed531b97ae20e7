// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/sphere_packing.hpp"

#include <omp.h>

#include <algorithm>
#include <array>

#include "geometry/packing_relaxation.hpp"
#include "geometry/packing_settlement.hpp"
#include "geometry/triangle_tree.hpp"
#include "support.hpp"

namespace gdesp::geometry {
namespace {

constexpr double bound = 1.01 * packing_overlap;  // diameters are stored as float

PackingRequest box_request(const Box& box, double diameter, double porosity) {
  PackingRequest r;
  r.space = [box](const ColumnGrid& g) { return solid_intervals(box_mesh(box), g); };
  r.contains = [box](const std::vector<Vec3d>& points) {
    const auto w = windings(box_mesh(box), points);
    std::vector<bool> in;
    for (const int k : w) in.push_back(k > 0);
    return in;
  };
  r.body = r.walls = box_mesh(box);
  flip(r.walls);
  r.box = box;
  r.diameter = diameter;
  r.porosity = porosity;
  return r;
}

/// Brute force over all pairs.
double worst_overlap(const Packing& p) {
  double worst = -1.0;
  for (std::size_t i = 0; i < p.position.size(); ++i) {
    for (std::size_t j = i + 1; j < p.position.size(); ++j) {
      const double sum = 0.5 * (p.diameter[i] + p.diameter[j]);
      worst = std::max(worst, (sum - norm(p.position[i] - p.position[j])) / std::min(p.diameter[i], p.diameter[j]));
    }
  }
  return worst;
}

double most_outside(const Packing& p, const Box& b) {
  double worst = -1.0;
  for (std::size_t i = 0; i < p.position.size(); ++i) {
    for (int a = 0; a < 3; ++a) {
      const double r = 0.5 * p.diameter[i];
      worst = std::max({worst, b.lower[a] - (p.position[i][a] - r), p.position[i][a] + r - b.upper[a]});
    }
  }
  return worst;
}

TEST(SpherePacking, PorosityIsMetWithoutOverlapAndWithinTheWalls) {
  const Box box{{0, 0, 0}, {0.8, 1.0, 0.7}};
  for (const double porosity : {0.45, 0.42}) {
    const Packing p = pack_spheres(box_request(box, 0.06, porosity));
    EXPECT_NEAR(p.porosity, porosity, 0.005);
    EXPECT_LT(worst_overlap(p), bound);
    EXPECT_LT(most_outside(p, box), bound * 0.06);
    EXPECT_EQ(p.left_out, 0u);
  }
}

TEST(SpherePacking, SameOnAnyNumberOfThreadsAnotherForAnotherSeed) {
  const Box box{{0, 0, 0}, {0.5, 0.5, 0.5}};
  PackingRequest r = box_request(box, 0.05, 0.45);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const Packing a = pack_spheres(r);
  omp_set_num_threads(3);
  const Packing b = pack_spheres(r);
  omp_set_num_threads(threads);
  ASSERT_EQ(a.position.size(), b.position.size());
  for (std::size_t k = 0; k < a.position.size(); ++k) EXPECT_TRUE(a.position[k] == b.position[k]);
  r.seed = 2;
  EXPECT_FALSE(pack_spheres(r).position[0] == a.position[0]);
}

TEST(SpherePacking, SieveSharesAreByMass) {
  const Box box{{0, 0, 0}, {1, 1, 1}};
  PackingRequest r = box_request(box, 0.0, 0.42);
  r.porosity = 0.45;
  r.sieve = {{0.08, 0.5}, {0.16, 0.5}};
  const Packing p = pack_spheres(r);
  double small = 0.0, large = 0.0;
  for (const float d : p.diameter) (d < 0.12f ? small : large) += static_cast<double>(d) * d * d;
  EXPECT_NEAR(small / (small + large), 0.5, 0.02);
  EXPECT_LT(worst_overlap(p), bound);
}

TEST(SpherePacking, NormalDiametersHaveTheirSpread) {
  const Box box{{0, 0, 0}, {1, 1, 1}};
  PackingRequest r = box_request(box, 0.08, 0.45);
  r.deviation = 0.008;
  const Packing p = pack_spheres(r);
  double mean = 0.0, square = 0.0;
  for (const float d : p.diameter) mean += d, square += static_cast<double>(d) * d;
  mean /= static_cast<double>(p.diameter.size());
  EXPECT_NEAR(mean, 0.08, 0.001);
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(p.diameter.size()) - mean * mean), 0.008, 0.001);
}

TEST(SpherePacking, UniformDiametersFillTheirWidthEvenly) {
  const Box box{{0, 0, 0}, {1, 1, 1}};
  PackingRequest r = box_request(box, 0.08, 0.45);
  r.half_width = 0.02;
  const Packing p = pack_spheres(r);
  EXPECT_NEAR(p.porosity, 0.45, 0.005);
  EXPECT_LT(worst_overlap(p), bound);
  std::array<double, 4> quarter{};
  for (const float d : p.diameter) {
    ASSERT_GE(d, 0.06f);
    ASSERT_LE(d, 0.1f);
    quarter[std::min<std::size_t>(3, static_cast<std::size_t>((d - 0.06f) / 0.01f))] +=
        1.0 / static_cast<double>(p.diameter.size());
  }
  for (const double share : quarter)
    EXPECT_NEAR(share, 0.25, 4.0 * std::sqrt(0.25 * 0.75 / static_cast<double>(p.diameter.size())));
}

/// Spheres of one diameter d that touch, layer on layer; `lift` above the floor of a box ten diameters high.
Packing cubic_bed(double d, int across, int layers, double lift) {
  Packing p;
  p.volume = 10.0 * d * across * d * across * d;
  for (int i = 0; i < across; ++i) {
    for (int j = 0; j < across; ++j) {
      for (int k = 0; k < layers; ++k) p.position.push_back({(i + 0.5) * d, (j + 0.5) * d, (k + 0.5) * d + lift});
    }
  }
  p.diameter.assign(p.position.size(), static_cast<float>(d));
  return p;
}

TEST(PackingSettlement, TellsFallAndPorosityOfTheBedAndLeavesOutWhatEscapes) {
  const double d = 0.1;
  const Box box{{0, 0, 0}, {6 * d, 6 * d, 10 * d}};
  Packing p = cubic_bed(d, 6, 5, 2.0 * d);
  const PackingRequest r = box_request(box, d, 0.5);
  const SettledBed bed = settle_packing(
      r, 2650.0,
      [&](GrainTable& grains, const TriangleTable& walls) {
        EXPECT_EQ(walls.triangle.size(), 12u);
        for (const float density : grains.density) EXPECT_EQ(density, 2650.0f);
        for (Vec3d& q : grains.position) q.z -= 2.0 * d;
        grains.position.back().z = -3.0 * d;
        return Settlement{.time = 1.0, .at_rest = true};
      },
      p);
  EXPECT_EQ(p.left_out, 1u);
  EXPECT_EQ(p.position.size(), 179u);
  EXPECT_NEAR(bed.fall, 2.0 * d, 0.02 * d);
  EXPECT_LT(p.largest_overlap, 1e-5);
  // Above the tops of cubic layers, pi/4 of the plan carries half an ellipsoid's shape: the space below ends 1/2 - 1/3 of a radius lower there,
  // a radius lower between them.
  const double pi = 3.14159265358979, below = 5.0 - 0.5 * (pi / 4.0 / 3.0) - (1.0 - pi / 4.0);
  EXPECT_NEAR(bed.porosity, 1.0 - 5.0 * pi / 6.0 / below, 0.05);
}

TEST(SpherePacking, DiscsInThePlane) {
  const Box box{{0, -1, 0}, {1, 1, 1}};
  PackingRequest r = box_request(box, 0.04, 0.25);
  r.dimensions = 2;
  const Packing p = pack_spheres(r);
  EXPECT_NEAR(p.porosity, 0.25, 0.01);
  EXPECT_LT(worst_overlap(p), bound);
  for (const auto& q : p.position) EXPECT_EQ(q.y, 0.0);
}

/// A layer of one thickness on a wavy slope, as a slide on a terrain: closed, normals outward.
TriangleMesh slope_layer(double length, double thickness, int n) {
  TriangleMesh m;
  for (int side = 0; side < 2; ++side) {
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= n; ++j) {
        const double x = length * i / n, y = length * j / n;
        m.vertex.push_back(
            {x, y,
             0.5 * x + 0.05 * length * std::sin(9.0 * x / length) * std::cos(11.0 * y / length) + side * thickness});
      }
    }
  }
  const auto at = [n](int side, int i, int j) { return (side * (n + 1) + i) * (n + 1) + j; };
  const auto quad = [&m](int a, int b, int c, int d) {
    m.triangle.push_back({a, b, c});
    m.triangle.push_back({a, c, d});
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      quad(at(1, i, j), at(1, i + 1, j), at(1, i + 1, j + 1), at(1, i, j + 1));
      quad(at(0, i, j), at(0, i, j + 1), at(0, i + 1, j + 1), at(0, i + 1, j));
    }
    quad(at(0, i, 0), at(0, i + 1, 0), at(1, i + 1, 0), at(1, i, 0));
    quad(at(0, i + 1, n), at(0, i, n), at(1, i, n), at(1, i + 1, n));
    quad(at(0, 0, i + 1), at(0, 0, i), at(1, 0, i), at(1, 0, i + 1));
    quad(at(0, n, i), at(0, n, i + 1), at(1, n, i + 1), at(1, n, i));
  }
  return m;
}

TEST(SpherePacking, TerrainShapedSlideHasNoGrainOutside) {
  const TriangleMesh body = slope_layer(10.0, 2.0, 12);
  PackingRequest r;
  r.space = [&](const ColumnGrid& g) { return solid_intervals(body, g); };
  r.contains = [&](const std::vector<Vec3d>& points) {
    std::vector<bool> in;
    for (const int k : windings(body, points)) in.push_back(k > 0);
    return in;
  };
  r.body = r.walls = body;
  flip(r.walls);
  r.box = bounds(body);
  r.diameter = 0.35;
  r.porosity = 0.44;
  const Packing p = pack_spheres(r);
  EXPECT_NEAR(p.volume, 200.0, 1e-9);
  EXPECT_NEAR(p.porosity, 0.44, 0.01);
  EXPECT_LT(worst_overlap(p), bound);
  for (const int inside : windings(body, p.position)) EXPECT_GT(inside, 0);
  const TriangleTree surface(body);
  for (std::size_t k = 0; k < p.position.size(); ++k) {
    EXPECT_GT(surface.nearest(p.position[k], r.diameter).distance, (0.5 - bound) * p.diameter[k])
        << "grain " << k << " sticks out";
  }
}

// What cannot be packed is told, not squeezed: the porosity reached is reported and nothing overlaps.
TEST(SpherePacking, TooDenseLeavesGrainsOut) {
  const Box box{{0, 0, 0}, {0.3, 0.3, 0.3}};
  const Packing p = pack_spheres(box_request(box, 0.06, 0.3));
  EXPECT_GT(p.left_out, 0u);
  EXPECT_GT(p.porosity, 0.36);
  EXPECT_LT(worst_overlap(p), bound);
}

TEST(SpherePacking, NothingFits) {
  EXPECT_MENTIONS(testing::input_error([] {
                    pack_spheres(box_request({{0, 0, 0}, {1, 1, 1}}, 3.0, 0.4));
                  }),
                  "no grain");
}

// The faces towards y of a plane scene may be nearer than the radius: they bound nothing there.
TEST(SpherePacking, DiscsStayInTheirPlaneBetweenCloseFaces) {
  PackingRequest r = box_request({{0, -0.005, 0}, {0.5, 0.005, 0.5}}, 0.03, 0.25);
  r.dimensions = 2;
  const Packing p = pack_spheres(r);
  EXPECT_NEAR(p.porosity, 0.25, 0.005);
  EXPECT_LT(worst_overlap(p), bound);
  EXPECT_EQ(p.left_out, 0u);
  for (const Vec3d& x : p.position) EXPECT_EQ(x.y, 0.0);
}

}  // namespace
}  // namespace gdesp::geometry
