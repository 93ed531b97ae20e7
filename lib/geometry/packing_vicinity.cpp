// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/packing_vicinity.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/point_cells.hpp"

namespace gdesp::geometry {
namespace {

constexpr double cells_per_grain = 32.0;  // at most; a box much larger than its grains gets wider cells
constexpr std::size_t block_size = 1024;  // grains whose lists one thread finds at a time

}  // namespace

Vicinity::Vicinity(const TriangleTree& walls, double largest, double inflation)
    : walls_(&walls), inflation_(inflation), skin_(0.2 * largest), reach_(inflation * largest + 0.2 * largest) {}

void Vicinity::renew(const PackingState& s) {
  find_pairs(s);
  find_walls(s);
  reference_ = s.position;
}

bool Vicinity::is_stale(const PackingState& s) const {
  const double limit = 0.25 * skin_ * skin_;
  bool stale = false;
#pragma omp parallel for schedule(static) reduction(|| : stale) if (s.position.size() > worth_threads)
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    const Vec3d d = s.position[i] - reference_[i];
    stale = stale || dot(d, d) > limit;
  }
  return stale;
}

namespace {

/// Lists found by blocks of grains, laid end to end: list i is other[first[i]] to other[first[i + 1] - 1].
template <class Item>
void join(const std::vector<std::vector<Item>>& block, std::vector<std::uint32_t>& first, std::vector<Item>& other) {
  std::vector<std::size_t> start(block.size() + 1, 0);
  for (std::size_t b = 0; b < block.size(); ++b) start[b + 1] = start[b] + block[b].size();
  other.resize(start.back());
#pragma omp parallel for schedule(static) if (other.size() > worth_threads)
  for (std::size_t b = 0; b < block.size(); ++b)
    std::copy(block[b].begin(), block[b].end(), other.begin() + static_cast<std::ptrdiff_t>(start[b]));
  for (std::size_t i = 0; i + 1 < first.size(); ++i) first[i + 1] += first[i];
}

}  // namespace

void Vicinity::find_pairs(const PackingState& s) {
  const std::size_t n = s.position.size();
  const PointCells cells(s.position, reach_, cells_per_grain);
  std::vector<std::vector<std::uint32_t>> found(n / block_size + 1);
  first.assign(n + 1, 0);
#pragma omp parallel for schedule(dynamic) if (n > worth_threads)
  for (std::size_t b = 0; b < found.size(); ++b) {
    std::vector<std::uint32_t>& list = found[b];
    for (std::size_t i = b * block_size; i < std::min(n, (b + 1) * block_size); ++i) {
      const Vec3d p = s.position[i];
      const std::size_t before = list.size();
      cells.near(p, reach_, [&](std::uint32_t j, double d2) {
        const double reach = 0.5 * inflation_ * (static_cast<double>(s.diameter[i]) + s.diameter[j]) + skin_;
        if (d2 < reach * reach && j != i) list.push_back(j);
      });
      first[i + 1] = static_cast<std::uint32_t>(list.size() - before);
    }
  }
  join(found, first, other);
}

void Vicinity::find_walls(const PackingState& s) {
  const std::size_t n = s.position.size();
  std::vector<std::vector<std::int32_t>> found(n / block_size + 1);
  first_wall.assign(n + 1, 0);
#pragma omp parallel for schedule(dynamic) if (n > worth_threads)
  for (std::size_t b = 0; b < found.size(); ++b) {
    std::vector<std::int32_t> near;
    for (std::size_t i = b * block_size; i < std::min(n, (b + 1) * block_size); ++i) {
      near.clear();
      walls_->within(s.position[i], 0.5 * inflation_ * s.diameter[i] + skin_, near);
      found[b].insert(found[b].end(), near.begin(), near.end());
      first_wall[i + 1] = static_cast<std::uint32_t>(near.size());
    }
  }
  join(found, first_wall, wall);
}

}  // namespace gdesp::geometry
