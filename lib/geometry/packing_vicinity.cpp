// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/packing_vicinity.hpp"

#include <algorithm>
#include <cmath>

namespace gdesp::geometry {
namespace {

constexpr std::size_t cells_per_grain = 32;   // at most; a box much larger than its grains gets wider cells
constexpr std::size_t block_size = 1024;      // grains whose lists one thread finds at a time

}  // namespace

/// Grains sorted into the cells of a box, z fastest, so that the three cells above each other are one range.
struct Vicinity::Cells {
  Vec3d origin;
  double width;
  std::int64_t n[3];
  std::vector<std::uint32_t> start, member;
  std::vector<Vec3d> at;         // positions in the order of `member`

  Cells(const PackingState& s, double least_width) : width(least_width) {
    Box box = empty_box();
    for (const auto& p : s.position) extend(box, p);
    origin = box.lower;
    const Vec3d size = extent(box);
    const auto limit = static_cast<double>(cells_per_grain * s.position.size() + 1000);
    for (;; width *= 1.25) {
      double cells = 1.0;
      for (int a = 0; a < 3; ++a) n[a] = static_cast<std::int64_t>(size[a] / width) + 1, cells *= static_cast<double>(n[a]);
      if (cells <= limit) break;
    }
    start.assign(static_cast<std::size_t>(n[0] * n[1] * n[2]) + 1, 0);
    std::vector<std::uint32_t> cell(s.position.size());
    for (std::size_t i = 0; i < cell.size(); ++i) {
      cell[i] = index(s.position[i]);
      ++start[cell[i] + 1];
    }
    for (std::size_t c = 0; c + 1 < start.size(); ++c) start[c + 1] += start[c];
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    member.resize(cell.size());
    at.resize(cell.size());
    for (std::size_t i = 0; i < cell.size(); ++i) {
      const std::uint32_t k = next[cell[i]]++;
      member[k] = static_cast<std::uint32_t>(i);
      at[k] = s.position[i];
    }
  }

  std::int64_t along(int axis, double x) const { return std::clamp<std::int64_t>(static_cast<std::int64_t>((x - origin[axis]) / width), 0, n[axis] - 1); }
  std::uint32_t index(const Vec3d& p) const { return static_cast<std::uint32_t>((along(0, p.x) * n[1] + along(1, p.y)) * n[2] + along(2, p.z)); }

  /// use(k) for every grain, as a place in `member`, of the cells around p.
  template <class Use>
  void around(const Vec3d& p, const Use& use) const {
    const std::int64_t i = along(0, p.x), j = along(1, p.y), k = along(2, p.z);
    const std::int64_t low = std::max<std::int64_t>(0, k - 1), high = std::min(n[2] - 1, k + 1);
    for (std::int64_t a = std::max<std::int64_t>(0, i - 1); a <= std::min(n[0] - 1, i + 1); ++a) {
      for (std::int64_t b = std::max<std::int64_t>(0, j - 1); b <= std::min(n[1] - 1, j + 1); ++b) {
        const auto row = static_cast<std::size_t>((a * n[1] + b) * n[2]);
        const std::uint32_t end = start[row + static_cast<std::size_t>(high) + 1];
        for (std::uint32_t m = start[row + static_cast<std::size_t>(low)]; m < end; ++m) use(m);
      }
    }
  }
};

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
  for (std::size_t b = 0; b < block.size(); ++b) std::copy(block[b].begin(), block[b].end(), other.begin() + static_cast<std::ptrdiff_t>(start[b]));
  for (std::size_t i = 0; i + 1 < first.size(); ++i) first[i + 1] += first[i];
}

}  // namespace

void Vicinity::find_pairs(const PackingState& s) {
  const std::size_t n = s.position.size();
  const Cells cells(s, reach_);
  std::vector<std::vector<std::uint32_t>> found(n / block_size + 1);
  first.assign(n + 1, 0);
#pragma omp parallel for schedule(dynamic) if (n > worth_threads)
  for (std::size_t b = 0; b < found.size(); ++b) {
    std::vector<std::uint32_t>& list = found[b];
    for (std::size_t i = b * block_size; i < std::min(n, (b + 1) * block_size); ++i) {
      const Vec3d p = s.position[i];
      const std::size_t before = list.size();
      cells.around(p, [&](std::uint32_t m) {
        const Vec3d d = p - cells.at[m];
        const double d2 = dot(d, d);
        if (d2 >= reach_ * reach_) return;
        const std::uint32_t j = cells.member[m];
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
