// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/closed_union.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <optional>

#include "core/error.hpp"
#include "exact_fields.hpp"

namespace gdesp::analysis {
namespace {

using analysis_test::fill;

/// F at a voxel; nothing where no tile holds it.
std::optional<float> at(const std::vector<VoxelTile>& tiles, int x, int y, int z) {
  for (const VoxelTile& t : tiles) {
    const int i = x - t.first.x, j = y - t.first.y, k = z - t.first.z;
    if (i >= 0 && i < 8 && j >= 0 && j < 8 && k >= 0 && k < 8) return t.value[64 * i + 8 * j + k];
  }
  return std::nullopt;
}

// One ball of 20 voxels, far from the origin: a signed distance, up to what the mean over 27 voxels adds (2 / 3r of a
// voxel) and what lies between the crossings.
TEST(ClosedUnion, OneBallIsItsSignedDistance) {
  const double voxel = 0.1, radius = 2.0, inwards = 0.5;
  const Vec3d centre{1000.03, -500.07, 20.01};
  const auto tiles = closed_union(std::vector{centre}, {voxel, radius, inwards, 3.0});
  ASSERT_FALSE(tiles.empty());
  std::size_t inside_band = 0;
  for (const VoxelTile& t : tiles) {
    for (int i = 0; i < 512; ++i) {
      if (std::abs(t.value[i]) >= 0.299f) continue;
      ++inside_band;
      const Vec3d x = Vec3d(t.first + Vec3<std::int32_t>{i / 64, i / 8 % 8, i % 8}) * voxel;
      EXPECT_NEAR(t.value[i], norm(x - centre) - (radius - inwards), 0.1 * voxel);
    }
  }
  EXPECT_NEAR(static_cast<double>(inside_band), 4.0 * 3.14159 * 15.0 * 15.0 * 6.0, 0.03 * 17000.0);
}

// Two blocks of particles: a gap up to 2R is closed, a wider one is not.
TEST(ClosedUnion, GapsAreClosedUpToTwiceTheRadius) {
  for (const double gap : {1.5, 2.0, 3.2}) {
    auto blocks = fill({0, 0, 0}, {8, 8, 8}, 1.0, 3, [](const Vec3d&) { return true; });
    const auto upper = fill({0, 0, 7 + gap}, {8, 8, 15 + gap}, 1.0, 3, [](const Vec3d&) { return true; });
    blocks.insert(blocks.end(), upper.begin(), upper.end());
    const auto tiles = closed_union(blocks, {0.5, 1.3, 0.8, 3.0});
    const auto middle = at(tiles, 8, 8, static_cast<int>(std::round(2.0 * (7.5 + 0.5 * gap))));
    if (gap > 2.6)
      EXPECT_GT(middle.value_or(1.0f), 0.0f) << gap;
    else
      EXPECT_LT(middle.value_or(-1.0f), 0.0f) << gap;
  }
}

TEST(ClosedUnion, DeepWaterCostsNoTiles) {
  const auto block = fill(
      {0, 0, 0}, {40, 40, 40}, 1.0, 3, [](const Vec3d&) { return true; }, 0.2);
  const auto tiles = closed_union(block, {0.5, 1.3, 0.8, 1.5});
  EXPECT_FALSE(at(tiles, 40, 40, 40).has_value());
  EXPECT_LT(tiles.size(), 12u * 12u * 12u - 8u * 8u * 8u);
}

TEST(ClosedUnion, SameForAnyNumberOfThreads) {
  const auto drop = fill(
      {-6, -6, -6}, {6, 6, 6}, 1.0, 3, [](const Vec3d& p) { return norm(p) < 5.0; }, 0.3);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const auto one = closed_union(drop, {0.5, 1.3, 0.8, 3.0});
  omp_set_num_threads(3);
  const auto three = closed_union(drop, {0.5, 1.3, 0.8, 3.0});
  omp_set_num_threads(threads);
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t t = 0; t < one.size(); ++t) EXPECT_EQ(one[t].value, three[t].value);
}

TEST(ClosedUnion, NowhereIsRefused) {
  EXPECT_TRUE(closed_union({}, {0.5, 1.3, 0.8, 3.0}).empty());
  EXPECT_THROW(closed_union(std::vector{Vec3d{0, std::nan(""), 0}}, {0.5, 1.3, 0.8, 3.0}), Error);
  EXPECT_THROW(closed_union(std::vector{Vec3d{0, 1e9, 0}}, {0.5, 1.3, 0.8, 3.0}), Error);
}

}  // namespace
}  // namespace gdesp::analysis
