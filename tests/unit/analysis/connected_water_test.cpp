// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/connected_water.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "exact_fields.hpp"

namespace gdesp::analysis {
namespace {

using analysis_test::fill;
const auto everywhere = [](const Vec3d&) { return true; };
constexpr double dp = 0.1;

std::vector<std::uint8_t> main_of(const std::vector<Vec3d>& p, int dimensions) {
  return find_connected_water(ColumnGrid(p, 0.26, dimensions), dp).main;
}

TEST(ConnectedWater, ASheetOneParticleThickIsConnected) {
  auto p = fill({0, 0, 0}, {2, 2, 1}, dp, 3, everywhere);
  const std::size_t bulk = p.size();
  const auto sheet = fill({2, 0, 0}, {4, 2, dp}, dp, 3, everywhere);
  p.insert(p.end(), sheet.begin(), sheet.end());
  const auto main = main_of(p, 3);
  EXPECT_EQ(std::accumulate(main.begin(), main.end(), std::size_t{0}), p.size());
  EXPECT_GT(p.size(), bulk);
}

TEST(ConnectedWater, AThreadOfSingleParticlesIsNot) {
  auto p = fill({0, 0, 0}, {2, 2, 1}, dp, 3, everywhere);
  const std::size_t bulk = p.size();
  for (int k = 0; k < 30; ++k) p.push_back({2.05 + 0.1 * k, 1.05, 0.95});
  const auto main = main_of(p, 3);
  for (std::size_t i = 0; i < bulk; ++i) EXPECT_EQ(main[i], 1);
  for (std::size_t i = bulk + 3; i < p.size(); ++i) EXPECT_EQ(main[i], 0) << i - bulk;
}

TEST(ConnectedWater, DropsAndACloudAreSplash) {
  auto p = fill({0, 0, 0}, {2, 2, 1}, dp, 3, everywhere);
  const std::size_t bulk = p.size();
  p.push_back({1.0, 1.0, 1.5});
  const auto cloud = fill({1, 1, 2}, {1.3, 1.3, 2.3}, dp, 3, everywhere);  // 27 particles, compact, far off
  p.insert(p.end(), cloud.begin(), cloud.end());
  const auto main = main_of(p, 3);
  for (std::size_t i = bulk; i < p.size(); ++i) EXPECT_EQ(main[i], 0);
}

TEST(ConnectedWater, TwoLakesAreBothMain) {
  auto p = fill({0, 0, 0}, {2, 2, 1}, dp, 3, everywhere);
  const auto second = fill({5, 0, 0}, {6, 1, 1}, dp, 3, everywhere);
  p.insert(p.end(), second.begin(), second.end());
  const ConnectedWater water = find_connected_water(ColumnGrid(p, 0.26, 3), dp);
  EXPECT_EQ(water.bodies, 2u);
  EXPECT_EQ(water.main_count, p.size());
}

TEST(ConnectedWater, InTwoDimensionsALineIsASheet) {
  auto p = fill({0, 0, 0}, {2, 0, 1}, dp, 2, everywhere);
  for (int k = 0; k < 10; ++k) p.push_back({2.05 + 0.1 * k, 0.0, 0.05});
  p.push_back({3.5, 0.0, 0.05});
  const auto main = main_of(p, 2);
  EXPECT_EQ(main[p.size() - 2], 1);
  EXPECT_EQ(main[p.size() - 1], 0);
}

// Oracle: the same rule by comparing all pairs, on a random gas of particles near the percolation threshold.
TEST(ConnectedWater, AllPairsAgree) {
  const auto p = fill(
      {0, 0, 0}, {1.2, 1.2, 1.2}, dp, 3, [](const Vec3d& q) { return std::sin(1e4 * (q.x + 3 * q.y + 7 * q.z)) > 0.2; },
      0.4);
  const std::size_t n = p.size();
  const double link2 = 0.15 * 0.15;
  std::vector<int> count(n, 0), label(n);
  const auto linked = [&](std::size_t a, std::size_t b) { return a != b && dot(p[a] - p[b], p[a] - p[b]) < link2; };
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) count[a] += linked(a, b);
  }
  std::iota(label.begin(), label.end(), 0);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = 0; b < n; ++b) {
        if (linked(a, b) && count[a] >= 3 && count[b] >= 3 && label[a] < label[b]) label[b] = label[a], changed = true;
      }
    }
  }
  std::vector<int> size(n, 0);
  for (std::size_t a = 0; a < n; ++a) size[label[a]] += count[a] >= 3;
  const ConnectedWater water = find_connected_water(ColumnGrid(p, 0.26, 3), dp);
  std::size_t disagreements = 0, members = 0;
  for (std::size_t a = 0; a < n; ++a) {
    if (count[a] < 3) continue;  // border particles depend on the order; cores do not
    const bool expected = size[label[a]] >= 0.08 * static_cast<double>(n);
    const bool tiny = size[label[a]] < 0.02 * static_cast<double>(n);
    members += expected;
    if ((expected && !water.main[a]) || (tiny && water.main[a])) ++disagreements;
  }
  EXPECT_EQ(disagreements, 0u);
  EXPECT_GT(members, 50u);
}

TEST(ConnectedWater, NoParticlesIsNoWater) {
  const ConnectedWater water = find_connected_water(ColumnGrid({}, 0.26, 3), dp);
  EXPECT_EQ(water.main_count, 0u);
}

}  // namespace
}  // namespace gdesp::analysis
