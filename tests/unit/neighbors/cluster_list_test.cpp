// SPDX-License-Identifier: GPL-3.0-or-later
// Lists against a brute-force search over all pairs.
#include "neighbors/cluster_list.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace gdesp {
namespace {

using exec::OpenMP;

struct Sorted {
  ClusterSet<OpenMP> set;
  std::vector<FixedPosition> position;  // by slot
  std::vector<std::uint32_t> id;        // by slot
  std::vector<float> record;
};

Sorted sort_points(const Domain& domain, const std::vector<Vec3d>& points, double cell) {
  Sorted s{ClusterSet<OpenMP>({}, domain, cell), {}, {}, {}};
  std::vector<FixedPosition> fixed;
  std::vector<std::uint32_t> ids;
  for (const Vec3d& r : points) {
    ids.push_back(static_cast<std::uint32_t>(ids.size()));
    fixed.push_back(domain.fixed(r));
  }
  Array<FixedPosition, OpenMP> position;
  Array<std::uint32_t, OpenMP> id;
  position.assign(fixed);
  id.assign(ids);
  Array<float, OpenMP> room;
  s.set.build(position, id, static_cast<Index>(fixed.size()), room);
  const auto slots = static_cast<std::size_t>(s.set.slots());
  s.position.resize(slots);
  s.id.resize(slots);
  s.record.assign(slots * 8, 0.0f);
  const auto view = s.set.view();
  for (std::size_t k = 0; k < slots; ++k) {
    const Index source = s.set.source()[k];
    s.id[k] = source < 0 ? no_particle : ids[static_cast<std::size_t>(source)];
    Vec3f x{padding_coordinate, padding_coordinate, padding_coordinate};
    if (source >= 0) {
      s.position[k] = domain.wrapped(fixed[static_cast<std::size_t>(source)]);
      x = domain.relative_to_tile(s.position[k], view.cluster_tile[k / 4]);
    }
    for (int axis = 0; axis < 3; ++axis) s.record[32 * (k / 4) + 4 * static_cast<std::size_t>(axis) + k % 4] = x[axis];
  }
  return s;
}

std::vector<Vec3d> random_points(int n, const Vec3d& low, const Vec3d& high, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<Vec3d> points;
  for (int k = 0; k < n; ++k)
    points.push_back({low.x + u(random) * (high.x - low.x), low.y + u(random) * (high.y - low.y),
                      low.z + u(random) * (high.z - low.z)});
  return points;
}

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

// Pairs that the list reaches within the cutoff, by the coordinates kernels use.
Pairs listed_pairs(const Sorted& i, const Sorted& j, const ClusterListView& list, double cutoff) {
  Pairs pairs;
  for (Index c = 0; c < i.set.clusters(); ++c) {
    for_each_cluster(list, c, [&](Index d, const Vec3f& shift) {
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < 4; ++b) {
          const std::size_t ia = 4 * static_cast<std::size_t>(c) + a, jb = 4 * static_cast<std::size_t>(d) + b;
          if (i.id[ia] == no_particle || j.id[jb] == no_particle) continue;
          const float* ri = &i.record[32 * static_cast<std::size_t>(c) + a];
          const float* rj = &j.record[32 * static_cast<std::size_t>(d) + b];
          const Vec3f r{ri[0] + shift.x - rj[0], ri[4] + shift.y - rj[4], ri[8] + shift.z - rj[8]};
          if (norm(r) < static_cast<float>(cutoff)) {
            EXPECT_TRUE(pairs.insert({i.id[ia], j.id[jb]}).second) << "a pair is listed twice";
          }
        }
    });
  }
  return pairs;
}

Pairs all_pairs(const Domain& domain, const Sorted& i, const Sorted& j, double cutoff) {
  Pairs pairs;
  for (std::size_t a = 0; a < i.id.size(); ++a)
    for (std::size_t b = 0; b < j.id.size(); ++b) {
      if (i.id[a] == no_particle || j.id[b] == no_particle) continue;
      if (norm(domain.separation(i.position[a], j.position[b])) < static_cast<float>(cutoff))
        pairs.insert({i.id[a], j.id[b]});
    }
  return pairs;
}

void check(const Vec3d& size, const bool periodic[3], int dimensions, double cutoff, double cell_i, double cell_j) {
  const double dp = 0.1;
  const Domain domain = make_domain({0, 0, 0}, size, dp, periodic, dimensions);
  auto points_i = random_points(1500, {0, 0, 0}, size, 1), points_j = random_points(900, {0, 0, 0}, size, 2);
  if (dimensions == 2) {
    for (auto* points : {&points_i, &points_j})
      for (auto& r : *points) r.y = 0.5 * size.y;
  }
  const Sorted i = sort_points(domain, points_i, cell_i), j = sort_points(domain, points_j, cell_j);
  ASSERT_EQ(i.set.particles(), 1500);
  ClusterList<OpenMP> list{OpenMP{}};
  list.build(i.set.view(), i.record.data(), j.set.view(), j.record.data(), static_cast<float>(cutoff));
  // A hair inside the cutoff, so that rounding of a distance decides nothing.
  const double inner = cutoff * (1.0 - 1e-5);
  EXPECT_EQ(listed_pairs(i, j, list.view(), inner), all_pairs(domain, i, j, inner));
  ClusterList<OpenMP> self{OpenMP{}};
  self.build(i.set.view(), i.record.data(), i.set.view(), i.record.data(), static_cast<float>(cutoff));
  EXPECT_EQ(listed_pairs(i, i, self.view(), inner), all_pairs(domain, i, i, inner));
}

TEST(ClusterList, finds_every_pair_once_in_one_tile) {
  const bool closed[3] = {false, false, false};
  check({2, 2, 2}, closed, 3, 0.27, 0.2, 0.2);
}
TEST(ClusterList, finds_every_pair_across_tiles) {
  const bool closed[3] = {false, false, false};
  check({14, 0.6, 7}, closed, 3, 0.5, 0.2, 0.2);
}
TEST(ClusterList, finds_pairs_of_sets_with_different_cells) {
  const bool closed[3] = {false, false, false};
  check({8, 1, 1}, closed, 3, 0.7, 0.55, 0.2);
}
TEST(ClusterList, finds_pairs_across_periodic_borders_with_one_tile) {
  const bool periodic[3] = {true, true, false};
  check({2, 2, 2}, periodic, 3, 0.27, 0.2, 0.3);
}
TEST(ClusterList, finds_pairs_across_periodic_borders_with_two_tiles) {
  const bool periodic[3] = {true, false, false};
  check({13.1, 1, 1}, periodic, 3, 0.6, 0.2, 0.2);
}
TEST(ClusterList, works_in_the_plane) {
  const bool closed[3] = {false, false, false};
  check({8, 0.2, 8}, closed, 2, 0.3, 0.2, 0.2);
}

TEST(ClusterList, keeps_every_pair_when_trimmed_and_takes_them_back) {
  const bool periodic[3] = {true, false, false};
  const Domain domain = make_domain({0, 0, 0}, {13.1, 1, 2}, 0.1, periodic, 3);
  const Sorted i = sort_points(domain, random_points(1500, {0, 0, 0}, {13.1, 1, 2}, 1), 0.2);
  ClusterList<OpenMP> list{OpenMP{}};
  list.build(i.set.view(), i.record.data(), i.set.view(), i.record.data(), 0.6f);
  const auto in_use = [&] {
    std::size_t sum = 0;
    for (Index c = 0; c < i.set.clusters(); ++c) sum += list.view().count[c] & ~ClusterListView::crosses_bit;
    return sum;
  };
  const std::size_t whole = in_use();
  for (const double cutoff : {0.3, 0.2, 0.45, 0.6}) {
    exec::pair_pass(OpenMP{}, "trim", i.set.clusters(),
                    list.trim(i.record.data(), i.record.data(), static_cast<float>(cutoff)));
    const double inner = cutoff * (1.0 - 1e-5);
    EXPECT_EQ(listed_pairs(i, i, list.view(), inner), all_pairs(domain, i, i, inner)) << cutoff;
    EXPECT_EQ(in_use() < whole, cutoff < 0.55) << cutoff;
  }
}

TEST(ClusterSet, leaves_out_particles_outside_and_says_how_many) {
  const bool closed[3] = {false, false, false};
  const Domain domain = make_domain({0, 0, 0}, {6.4, 6.4, 6.4}, 0.1, closed, 3);
  auto points = random_points(50, {0, 0, 0}, {6, 6, 6}, 5);
  points.push_back({-0.5, 1, 1});
  points.push_back({1, 1, 7.0});
  const Sorted s = sort_points(domain, points, 0.2);
  EXPECT_EQ(s.set.particles(), 50);
  EXPECT_EQ(s.set.lost(), 2);
  EXPECT_EQ(std::count_if(s.id.begin(), s.id.end(), [](std::uint32_t id) { return id != no_particle; }), 50);
}

TEST(ClusterSet, may_be_empty) {
  const bool closed[3] = {false, false, false};
  const Domain domain = make_domain({0, 0, 0}, {1, 1, 1}, 0.1, closed, 3);
  const Sorted s = sort_points(domain, {}, 0.2);
  EXPECT_EQ(s.set.slots(), 0);
}

}  // namespace
}  // namespace gdesp
