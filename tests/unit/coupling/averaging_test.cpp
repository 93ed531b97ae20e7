// SPDX-License-Identifier: GPL-3.0-or-later
// Averaging over nodes: the spline, the spread of the kernel that it makes, and which nodes are chosen.
// @eq coupling.averaging
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <set>

#include "coupling/averaging_nodes.hpp"
#include "coupling/node_reading.hpp"
#include "exec/array.hpp"

namespace gdesp::coupling {
namespace {

using exec::OpenMP;

TEST(AveragingSpline, weights_add_up_to_one_and_carry_linear_functions) {
  for (float x = 0.0f; x < 1.0f; x += 0.07f) {
    float sum = 0.0f, mean = 0.0f, slope = 0.0f;
    for (int n = -3; n <= 3; ++n) {
      const float s = x - static_cast<float>(n);
      sum += cubic_spline(s);
      mean += cubic_spline(s) * static_cast<float>(n);
      slope += cubic_spline_slope(s) * static_cast<float>(n);
    }
    EXPECT_NEAR(sum, 1.0f, 1e-6f);
    EXPECT_NEAR(mean, x, 1e-6f);
    EXPECT_NEAR(slope, 1.0f, 1e-5f);
  }
}

TEST(AveragingSpline, gradient_is_the_derivative_and_the_cut_off_corners_weigh_nothing) {
  const AveragingSpline spline{{2.0f, 3.0f, 4.0f}, 24.0f, false};
  const float x = 0.31f, y = -0.22f, z = 0.17f, d = 1e-3f;
  AveragingSpline::Gradient<float> gradient;
  EXPECT_FLOAT_EQ(spline.weight(x, y, z, gradient), spline.weight(x, y, z));
  EXPECT_NEAR(gradient.x, (spline.weight(x + d, y, z) - spline.weight(x - d, y, z)) / (2 * d), 2e-3f);
  EXPECT_NEAR(gradient.y, (spline.weight(x, y + d, z) - spline.weight(x, y - d, z)) / (2 * d), 2e-3f);
  EXPECT_NEAR(gradient.z, (spline.weight(x, y, z + d) - spline.weight(x, y, z - d)) / (2 * d), 2e-3f);
  float sum = 0.0f;  // the middle of a cell: the corners are furthest there
  for (int i = -2; i < 2; ++i)
    for (int j = -2; j < 2; ++j)
      for (int k = -2; k < 2; ++k) {
        sum += spline.weight((static_cast<float>(i) + 0.5f) / 2.0f, (static_cast<float>(j) + 0.5f) / 3.0f,
                             (static_cast<float>(k) + 0.5f) / 4.0f);
      }
  EXPECT_NEAR(sum, 1.0f, 1e-4f);
}

// The variance of two splines, one after the other, is that of the Wendland kernel of length h_c.
TEST(AveragingSpline, spread_is_that_of_the_kernel) {
  const double h = 1.0;
  for (const int dimensions : {2, 3}) {
    double moment = 0.0, sum = 0.0;
    for (double r = 5e-4; r < 2.0 * h; r += 1e-3) {
      const double q = r / (2.0 * h), w = std::pow(1.0 - q, 4) * (1.0 + 4.0 * q) * std::pow(r, dimensions - 1);
      sum += w;
      moment += w * r * r / dimensions;
    }
    const double spacing = node_spacing(h, dimensions);
    EXPECT_NEAR(2.0 * spacing * spacing / 3.0, moment / sum, 1e-4);
  }
}

// Places as a sorted set, with the records that passes read.
struct Places {
  exec::Array<FixedPosition, OpenMP> position;
  exec::Array<std::uint32_t, OpenMP> id;
  ClusterSet<OpenMP> set;
  std::vector<float> record;

  Places(const Domain& domain, double cell, const std::vector<Vec3d>& places) : set(OpenMP(), domain, cell) {
    std::vector<FixedPosition> fixed;
    std::vector<std::uint32_t> ids;
    for (const Vec3d& r : places) {
      fixed.push_back(domain.fixed(r));
      ids.push_back(static_cast<std::uint32_t>(ids.size()));
    }
    position.assign(fixed);
    id.assign(ids);
    exec::Array<float, OpenMP> room;
    set.build(position, id, static_cast<Index>(places.size()), room);
    record.assign(static_cast<std::size_t>(set.clusters()) * record_size, padding_coordinate);
    for (Index slot = 0; slot < set.slots(); ++slot) {
      const Index source = set.source()[slot], c = slot / exec::cluster_size;
      if (source < 0) continue;
      const Vec3f r = domain.relative_to_tile(fixed[static_cast<std::size_t>(source)], set.view().cluster_tile[c]);
      for (int axis = 0; axis < 3; ++axis)
        record[static_cast<std::size_t>(record_offset(c) + 4 * axis + slot % exec::cluster_size)] = r[axis];
    }
  }
  PlacesOfSet<const FixedPosition*> view() { return {position.data(), id.data(), static_cast<Index>(id.size())}; }
};
// Grains were listed a way off: where they are is in their records.
struct PlacesOfGrains : Places {
  std::vector<FixedPosition> listed;
  std::vector<dem::GrainRecord> grain;
  PlacesOfGrains(const Domain& domain, double cell, const std::vector<Vec3d>& places) : Places(domain, cell, places) {
    for (const Vec3d& r : places) {
      const FixedPosition p = domain.fixed(r);
      listed.push_back(domain.fixed(r + Vec3d{0.4 * cell, domain.dimensions == 2 ? 0.0 : -0.3 * cell, 0.2 * cell}));
      grain.push_back({});
      grain.back().x = dem::GrainPlaces::bits(p.x);
      grain.back().y = dem::GrainPlaces::bits(p.y);
      grain.back().z = dem::GrainPlaces::bits(p.z);
    }
  }
  PlacesOfSet<dem::GrainPlaces> view() {
    return {{listed.data(), grain.data()}, id.data(), static_cast<Index>(id.size())};
  }
};

struct FirstRows {
  static constexpr Index groups = 2;
  void operator()(const float* n, const Vec3f&, float* out) const {
    for (int q = 0; q < 8; ++q) out[q] = n[4 * q];
  }
};

// Against the sum over all nodes: places about the corner of four tiles, periodic along x, in space and in the plane; each moved
// by what lists allow since the nodes were chosen.
TEST(AveragingNodes, particles_read_the_sum_over_the_nodes_around_them) {
  const double dp = 0.01, skin = 0.19 * 2.85 * dp;
  const bool periodic[3] = {true, false, false};
  for (const int dimensions : {3, 2}) {
    const Domain domain = make_domain({0, 0, 0}, {1.28, 0.5, 1.28}, dp, periodic, dimensions);
    const NodeLattice lattice(domain, 2.85 * dp);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<Vec3d> places, moved;
    for (int k = 0; k < 200; ++k) {
      const double x = 0.15 * uniform(random) + (k % 2 ? 0.64 : 0.0);
      places.push_back({x < 0.0 ? x + 1.28 : x, dimensions == 2 ? 0.0 : 0.25 + 0.1 * uniform(random),
                        0.64 + 0.15 * uniform(random)});
      moved.push_back(places.back() + Vec3d{skin, 0.0, -skin} * (0.5 * uniform(random)));
    }
    PlacesOfGrains grains(domain, 2.0 * dp, places);
    Places water(domain, 3.0 * dp, places);
    AveragingNodes<OpenMP> nodes(OpenMP(), lattice);
    nodes.build(grains.set.view(), grains.view(), water.view(), skin);

    constexpr Index rows = 32;
    std::vector<float> sums(static_cast<std::size_t>(nodes.clusters()) * rows);
    for (float& value : sums) value = static_cast<float>(uniform(random));
    nodes.fill_bricks("test", sums.data(), rows, FirstRows{});
    const AveragingSpline spline = lattice.spline();
    const ClusterSet<OpenMP>& set = grains.set;
    for (Index slot = 0; slot < set.slots(); ++slot) {
      const Index source = set.source()[slot], c = slot / exec::cluster_size;
      if (source < 0) continue;
      const Vec3f r =
          domain.relative_to_tile(domain.fixed(moved[static_cast<std::size_t>(source)]), set.view().cluster_tile[c]);
      for (int axis = 0; axis < 3; ++axis)
        grains.record[static_cast<std::size_t>(record_offset(c) + 4 * axis + slot % exec::cluster_size)] = r[axis];
    }
    std::vector<float> read(static_cast<std::size_t>(set.slots()) * sums_of_grain);
    exec::pair_pass(
        OpenMP(), "test", set.clusters(),
        GatherAtGrains{{spline, nodes.bricks(), set.view().cluster_tile, grains.record.data()}, read.data()});

    for (Index slot = 0; slot < set.slots(); ++slot) {
      const Index source = set.source()[slot];
      float expected[sums_of_grain] = {};
      for (Index n = 0; source >= 0 && n < nodes.set().slots(); ++n) {
        const float* at = nodes.records() + record_offset(n / exec::cluster_size) + n % exec::cluster_size;
        if (at[0] > 0.5f * padding_coordinate) continue;
        const Vec3<std::int32_t> tile = nodes.set().view().cluster_tile[n / exec::cluster_size];
        for (const double image : {-1.28, 0.0, 1.28}) {
          Vec3d d = moved[static_cast<std::size_t>(source)] - Vec3d{image, 0.0, 0.0};
          for (int axis = 0; axis < 3; ++axis)
            d[axis] -= tile[axis] * domain.tile_size[axis] + static_cast<double>(at[4 * axis]);
          AveragingSpline::Gradient<float> gradient;
          const float S =
              spline.weight(static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z), gradient);
          const float* q = sums.data() + rows * (n / exec::cluster_size) + n % exec::cluster_size;
          const float slope[3] = {gradient.x, gradient.y, gradient.z};
          for (int k = 0; k < 8; ++k) expected[k] += S * q[4 * k];
          for (int k = 0; k < 12; ++k) expected[8 + k] += slope[k / 4] * q[4 * (k % 4)];
        }
      }
      for (int k = 0; k < sums_of_grain; ++k)
        // What one node weighs where it is cut off, which rounding may or may not count.
        EXPECT_NEAR(read[static_cast<std::size_t>(slot * sums_of_grain + k)], expected[k], k < 8 ? 3e-4 : 5e-2)
            << dimensions << " " << slot << " " << k;
    }
  }
}

// Nodes are those of the lattice with grains and water in reach: against a search over all, periodic along x.
TEST(AveragingNodes, are_all_that_are_in_reach_of_both) {
  const bool periodic[3] = {true, false, false};
  const double dp = 0.01;
  const Domain domain = make_domain({0, 0, 0}, {1.28, 0.5, 0.9}, dp, periodic, 3);
  const NodeLattice lattice(domain, 2.5 * dp);
  OpenMP exec;
  const std::vector<Vec3d> grains{{0.004, 0.25, 0.3}, {0.7, 0.01, 0.64}},
      water{{1.26, 0.24, 0.31}, {0.72, 0.03, 0.66}, {0.4, 0.4, 0.4}};
  PlacesOfGrains of_grains(domain, 2.0 * dp, grains);
  Places of_water(domain, 2.0 * dp, water);
  AveragingNodes<OpenMP> nodes(exec, lattice);
  nodes.build(of_grains.set.view(), of_grains.view(), of_water.view(), 0.0);

  std::set<std::array<int, 3>> chosen;
  for (Index s = 0; s < nodes.set().slots(); ++s) {
    const float* r = nodes.records() + record_offset(s / exec::cluster_size) + s % exec::cluster_size;
    if (r[0] > 0.5f * padding_coordinate) continue;
    const Vec3<std::int32_t> tile = nodes.set().view().cluster_tile[s / exec::cluster_size];
    std::array<int, 3> at{};
    for (int axis = 0; axis < 3; ++axis) {
      const double spacing = domain.tile_size[axis] / lattice.count[axis];
      const double c = (tile[axis] * domain.tile_size[axis] + static_cast<double>(r[4 * axis])) / spacing - 0.5;
      EXPECT_NEAR(c, std::round(c), 1e-4);
      at[static_cast<std::size_t>(axis)] = static_cast<int>(std::lround(c));
    }
    EXPECT_TRUE(chosen.insert(at).second) << "a node stands twice";
  }
  const auto in_reach = [&](const std::vector<Vec3d>& places, const Vec3d& node) {
    for (const Vec3d& r : places)
      for (const double image : {-1.28, 0.0, 1.28}) {
        const Vec3d d = node - (r + Vec3d{image, 0.0, 0.0});
        if (std::sqrt(dot(d, d)) < lattice.reach()) return true;
      }
    return false;
  };
  std::size_t wanted = 0;
  for (int x = 0; x < domain.tiles.x * lattice.count.x; ++x)
    for (int y = 0; y < domain.tiles.y * lattice.count.y; ++y)
      for (int z = 0; z < domain.tiles.z * lattice.count.z; ++z) {
        const Vec3d node{(x + 0.5) * domain.tile_size.x / lattice.count.x,
                         (y + 0.5) * domain.tile_size.y / lattice.count.y,
                         (z + 0.5) * domain.tile_size.z / lattice.count.z};
        if (!in_reach(grains, node) || !in_reach(water, node)) continue;
        ++wanted;
        EXPECT_TRUE(chosen.count({x, y, z})) << x << " " << y << " " << z;
      }
  EXPECT_GT(wanted, 20u);
  EXPECT_LT(chosen.size(), 8 * wanted);  // those in reach, and not all that there are
}

}  // namespace
}  // namespace gdesp::coupling
