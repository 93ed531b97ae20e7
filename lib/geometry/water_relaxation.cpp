// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/water_relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "core/wendland.hpp"
#include "geometry/point_cells.hpp"

namespace gdesp::geometry {
namespace {

constexpr double moving_reach = 4.0;  // dp, of fitted walls
constexpr double pace = 0.2;          // b of the step
constexpr double longest_step = 0.1;  // dp
constexpr double skin = 0.4;          // dp, of the lists of neighbours, which last for a few steps
constexpr int renewal = 10;
constexpr double still = 0.0003;  // dp, mean step at which it counts as settled
constexpr int most_steps = 150;
constexpr double taken = 0.6;  // dp: a lattice place with a particle nearer than this is not empty

class WaterRelaxation {
 public:
  WaterRelaxation(std::vector<Vec3d>& water, const BoundaryTable& boundary, std::size_t first, std::size_t last,
                  const FillSpace& space, double h)
      : water_(water), space_(space), dp_(space.lattice.dp), h_(h), flat_(space.lattice.dimensions == 2) {
    slope_ =
        std::pow(dp_, space.lattice.dimensions) * 5.0 * wendland_normalisation(h, space.lattice.dimensions) / (h * h);
    all_ = water;
    all_.insert(all_.end(), boundary.position.begin(), boundary.position.end());
    const std::vector<Vec3d> fitted(boundary.position.begin() + static_cast<std::ptrdiff_t>(first),
                                    boundary.position.begin() + static_cast<std::ptrdiff_t>(last));
    const PointCells near_walls(fitted, moving_reach * dp_);
    for (std::size_t i = 0; i < water.size(); ++i) {
      bool moves = false;
      near_walls.near(water[i], moving_reach * dp_, [&](std::uint32_t, double) { moves = true; });
      if (moves) moving_.push_back(static_cast<std::uint32_t>(i));
    }
  }

  void run() {
    find_air();
    step_.resize(moving_.size());
    for (int k = 0; k < most_steps; ++k) {
      if (k % renewal == 0) renew();
      if (move() < still) break;
    }
    std::copy_n(all_.begin(), water_.size(), water_.begin());
  }

 private:
  Vec3d pull(const Vec3d& r) const {
    const double t = 1.0 - norm(r) / (2.0 * h_);
    return t > 0.0 ? r * (slope_ * t * t * t) : Vec3d{};
  }

  bool in_solid(const Vec3d& p) const {
    const ColumnGrid& grid = space_.columns.grid;
    const int i = static_cast<int>(std::lround((p.x - grid.x0) / grid.spacing));
    const int j = flat_ ? 0 : static_cast<int>(std::lround((p.y - grid.y0) / grid.spacing));
    return i < 0 || j < 0 || i >= grid.nx || j >= grid.ny || space_.solid.contains(grid.index(i, j), p.z);
  }

  /// Empty lattice places around the water that moves, as points that stay; and the axes along which a particle has air beside it.
  void find_air() {
    const PointCells cells(all_, taken * dp_);
    const int m = static_cast<int>(std::ceil(2.0 * h_ / dp_ - 1e-9));
    open_.assign(moving_.size(), {{false, false, false}});
    std::vector<std::vector<Vec3d>> found(moving_.size());
#pragma omp parallel for schedule(dynamic, 64)
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      const Vec3d p = all_[moving_[k]];
      for (int a = -m; a <= m; ++a) {
        for (int b = flat_ ? 0 : -m; b <= (flat_ ? 0 : m); ++b) {
          for (int c = -m; c <= m; ++c) {
            const Vec3d place = p + Vec3d{a * dp_, b * dp_, c * dp_};
            if (is_taken(cells, place)) continue;
            found[k].push_back(place);
            if (std::abs(a) + std::abs(b) + std::abs(c) == 1) open_[k].axis[a != 0 ? 0 : b != 0 ? 1 : 2] = true;
          }
        }
      }
    }
    std::set<Index3, bool (*)(const Index3&, const Index3&)> known(
        [](const Index3& a, const Index3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
    for (const auto& places : found) {
      for (const Vec3d& p : places) {
        Index3 cell;
        for (int a = 0; a < 3; ++a)
          cell[a] = static_cast<std::int32_t>(std::floor((p[a] - space_.lattice.origin[a]) / dp_));
        if (known.insert(cell).second) all_.push_back(p);
      }
    }
  }

  bool is_taken(const PointCells& cells, const Vec3d& p) const {
    return in_solid(p) || cells.any_within(p, taken * dp_);
  }

  void renew() {
    const double width = 2.0 * h_ + skin * dp_;
    const PointCells cells(all_, width);
    neighbour_.resize(moving_.size());
#pragma omp parallel for schedule(dynamic, 64)
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      neighbour_[k].clear();
      cells.near(all_[moving_[k]], width, [&](std::uint32_t j, double) {
        if (j != moving_[k]) neighbour_[k].push_back(j);
      });
    }
  }

  /// One step of all; returns their mean (root of the mean square), in dp.
  double move() {
#pragma omp parallel for schedule(static)
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      Vec3d sum;
      for (const std::uint32_t j : neighbour_[k]) sum += pull(all_[moving_[k]] - all_[j]);
      for (int a = 0; a < 3; ++a) {
        if (open_[k].axis[a] || (flat_ && a == 1)) sum[a] = 0.0;
      }
      sum *= pace * h_ * h_;
      const double length = norm(sum);
      step_[k] = length > longest_step * dp_ ? sum * (longest_step * dp_ / length) : sum;
    }
    double square = 0.0;
    for (std::size_t k = 0; k < moving_.size(); ++k) {
      all_[moving_[k]] += step_[k];
      square += dot(step_[k], step_[k]);
    }
    return std::sqrt(square / static_cast<double>(moving_.size() + 1)) / dp_;
  }

  struct Open {
    bool axis[3];
  };

  std::vector<Vec3d>& water_;
  const FillSpace& space_;
  double dp_, h_, slope_;
  bool flat_;
  std::vector<Vec3d> all_;  // water, walls, and what air there is near by
  std::vector<std::uint32_t> moving_;
  std::vector<Vec3d> step_;
  std::vector<Open> open_;
  std::vector<std::vector<std::uint32_t>> neighbour_;
};

}  // namespace

void relax_water(std::vector<Vec3d>& water, const BoundaryTable& boundary, std::size_t first, std::size_t last,
                 const FillSpace& space, double h) {
  if (first < last && !water.empty()) WaterRelaxation(water, boundary, first, last, space, h).run();
}

}  // namespace gdesp::geometry
