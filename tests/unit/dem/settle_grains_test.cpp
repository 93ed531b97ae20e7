// SPDX-License-Identifier: GPL-3.0-or-later
// Packings that come to rest before a run.
#include "dem/settle_grains.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include "core/error.hpp"
#include "grain_scene.hpp"

namespace gdesp::dem::test {
namespace {

SettlingConditions conditions() {
  SettlingConditions c;
  c.contact.youngs_modulus = 1.0e7;
  c.gravity = {0.0, 0.0, -9.81};
  return c;
}

// Grains of 18 to 22 mm on a lattice of 24 mm, a little off its places.
GrainTable loose_grains(std::uint64_t seed = 5) {
  Random random(seed);
  GrainTable table;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      for (int k = 0; k < 10; ++k) {
        const auto off = [&] { return 0.001 * (2.0 * random() - 1.0); };
        add_grain(table, {0.016 + 0.024 * i + off(), 0.016 + 0.024 * j + off(), 0.016 + 0.024 * k + off()},
                  0.018 + 0.004 * random(), 2500.0);
      }
    }
  }
  return table;
}

const Vec3d corner{0.2, 0.2, 0.3};

TEST(SettleGrains, OneGrainRestsOnTheFloorByHertz) {
  GrainTable table;
  add_grain(table, {0.1, 0.1, 0.05}, 0.02, 2500.0);
  const Settlement s = settle_grains(table, tank({}, corner), conditions());
  EXPECT_TRUE(s.at_rest) << s.speed;
  EXPECT_EQ(s.lost, 0u);
  ASSERT_EQ(table.position.size(), 1u);
  // delta = (3 m g / (4 E* sqrt(R)))^(2/3), E* of two bodies alike
  const double weight = grain_mass_of(table, 0) * 9.81, effective = 1.0e7 / (2.0 * (1.0 - 0.09));
  const double depth = std::pow(3.0 * weight / (4.0 * effective * std::sqrt(0.01)), 2.0 / 3.0);
  EXPECT_NEAR(table.position[0].z, 0.01 - depth, 0.1 * depth);
}

TEST(SettleGrains, LoosePackingFallsIntoABedAtRest) {
  GrainTable table = loose_grains();
  const GrainTable before = table;
  const Settlement s = settle_grains(table, tank({}, corner), conditions());
  EXPECT_TRUE(s.at_rest) << s.speed;
  EXPECT_EQ(s.lost, 0u);
  ASSERT_EQ(table.position.size(), before.position.size());
  double fall = 0.0, top = 0.0, worst = 0.0;
  for (std::size_t i = 0; i < table.position.size(); ++i) {
    EXPECT_EQ(table.diameter[i], before.diameter[i]);
    fall += (before.position[i].z - table.position[i].z) / static_cast<double>(table.position.size());
    top = std::max(top, table.position[i].z);
    for (std::size_t j = 0; j < i; ++j) {
      const double d = norm(table.position[i] - table.position[j]),
                   sum = 0.5 * (static_cast<double>(table.diameter[i]) + table.diameter[j]);
      worst = std::max(worst, (sum - d) / sum);
    }
  }
  EXPECT_GT(fall, 0.01);
  EXPECT_LT(top, 0.22);
  EXPECT_LT(worst, 0.02);
  // Already at rest: nothing falls further.
  GrainTable again = table;
  settle_grains(again, tank({}, corner), conditions());
  double moved = 0.0;
  for (std::size_t i = 0; i < table.position.size(); ++i)
    moved += norm(again.position[i] - table.position[i]) / static_cast<double>(table.position.size());
  EXPECT_LT(moved, 0.01 * 0.02);
}

// Grains that roll about between those that bear: 2 mm/s root mean square when time is up, the median a thousandth of it.
TEST(SettleGrains, AFewThatRattleAreNoUnrest) {
  GrainTable table = loose_grains(3);
  const Settlement s = settle_grains(table, tank({}, corner), conditions());
  EXPECT_TRUE(s.at_rest) << s.speed;
}

TEST(SettleGrains, TheSameOnAnyNumberOfThreads) {
  GrainTable one = loose_grains(), three = one;
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  settle_grains(one, tank({}, corner), conditions());
  omp_set_num_threads(3);
  settle_grains(three, tank({}, corner), conditions());
  omp_set_num_threads(threads);
  for (std::size_t i = 0; i < one.position.size(); ++i) EXPECT_TRUE(one.position[i] == three.position[i]);
}

TEST(SettleGrains, NeedsGravity) {
  GrainTable table = loose_grains();
  SettlingConditions c = conditions();
  c.gravity = {};
  EXPECT_THROW(settle_grains(table, tank({}, corner), c), Error);
}

}  // namespace
}  // namespace gdesp::dem::test
