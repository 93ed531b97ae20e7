// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/connected_water.hpp"

#include <algorithm>
#include <atomic>

namespace gdesp::analysis {
namespace {

using Label = std::uint32_t;

Label find_root(std::vector<Label>& parent, Label a) {
  for (;;) {
    const Label up = std::atomic_ref(parent[a]).load(std::memory_order_relaxed);
    if (up == a) return a;
    const Label further = std::atomic_ref(parent[up]).load(std::memory_order_relaxed);
    std::atomic_ref(parent[a]).store(further, std::memory_order_relaxed);
    a = up;
  }
}

// The larger root is hung below the smaller, so the final roots do not depend on the order.
void unite(std::vector<Label>& parent, Label a, Label b) {
  for (;;) {
    a = find_root(parent, a);
    b = find_root(parent, b);
    if (a == b) return;
    if (a < b) std::swap(a, b);
    Label expected = a;
    if (std::atomic_ref(parent[a]).compare_exchange_strong(expected, b)) return;
  }
}

template <class Visit>
void for_each_neighbour(const ColumnGrid& grid, std::size_t s, double link, Visit&& visit) {
  const Vec3d p = grid.position(s);
  const double link2 = link * link;
  grid.for_each(p.x, p.y, p.z - link, p.z + link, [&](std::size_t t, double r2) {
    const double dz = grid.position(t).z - p.z;
    if (t != s && r2 + dz * dz < link2) visit(t);
  });
}

std::vector<std::uint8_t> find_torn(const ColumnGrid& grid, double limit, std::span<const float> relative_density) {
  std::vector<std::uint8_t> torn(grid.size(), 0);
  if (relative_density.size() != grid.size()) return torn;
  for (std::size_t s = 0; s < grid.size(); ++s) torn[s] = relative_density[grid.index(s)] < limit;
  return torn;
}

std::vector<std::uint8_t> find_cores(const ColumnGrid& grid, double link, const std::vector<std::uint8_t>& torn) {
  const int needed = grid.dimensions() == 2 ? 1 : 3;
  std::vector<std::uint8_t> core(grid.size(), 0);
#pragma omp parallel for schedule(dynamic, 1024)
  for (std::size_t s = 0; s < grid.size(); ++s) {
    if (torn[s]) continue;
    int count = 0;
    for_each_neighbour(grid, s, link, [&](std::size_t t) { count += !torn[t]; });
    core[s] = count >= needed;
  }
  return core;
}

}  // namespace

ConnectedWater find_connected_water(const ColumnGrid& grid, double dp, const ConnectivityRule& rule,
                                    std::span<const float> relative_density) {
  const std::size_t n = grid.size();
  const double link = rule.link * dp;
  ConnectedWater result;
  const std::vector<std::uint8_t> torn = find_torn(grid, rule.torn_below, relative_density);
  const std::vector<std::uint8_t> core = find_cores(grid, link, torn);
  std::vector<Label> parent(n);
  for (std::size_t s = 0; s < n; ++s) parent[s] = static_cast<Label>(s);
#pragma omp parallel for schedule(dynamic, 1024)
  for (std::size_t s = 0; s < n; ++s) {
    if (!core[s]) continue;
    for_each_neighbour(grid, s, link, [&](std::size_t t) {
      if (t < s && core[t]) unite(parent, static_cast<Label>(s), static_cast<Label>(t));
    });
  }
  // A border particle takes the cluster of its lowest-numbered core neighbour; without one it stands alone.
  std::vector<Label> label(n);
#pragma omp parallel for schedule(dynamic, 1024)
  for (std::size_t s = 0; s < n; ++s) {
    Label best = static_cast<Label>(s);
    if (!core[s] && !torn[s]) {
      Label lowest = static_cast<Label>(n);
      for_each_neighbour(grid, s, link, [&](std::size_t t) {
        if (t < lowest && core[t]) lowest = static_cast<Label>(t);
      });
      if (lowest < n) best = lowest;
    }
    label[s] = find_root(parent, best);
  }
  std::vector<std::uint32_t> members(n, 0);
  for (const Label l : label) ++members[l];
  const double least = rule.main_share * static_cast<double>(n);
  result.main.assign(n, 0);
  result.torn.assign(n, 0);
  for (std::size_t s = 0; s < n; ++s) {
    result.torn[grid.index(s)] = torn[s];
    if (members[s] >= least && members[s] > 1) ++result.bodies;
    if (members[label[s]] < least || members[label[s]] < 2) continue;
    result.main[grid.index(s)] = 1;
    ++result.main_count;
  }
  return result;
}

}  // namespace gdesp::analysis
