// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/thin_walls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gdesp::geometry {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int reach = 5;           // columns looked through: a wall aslant is longer along the axes than across
constexpr int finer = 8;           // columns of the close look, per dp
constexpr int directions = 16;     // of the close look
constexpr int open_space = 2;      // dp without wall or water: the space behind a wall
constexpr std::size_t looks = 24;  // places looked at closely

/// A wall that is thin on the lattice.
struct Suspect {
  int i, j;
  Interval open;
  int columns;
};  // open: heights of the space behind

using Pieces = std::vector<Interval>;

Pieces common(const Pieces& a, const Pieces& b) {
  Pieces out;
  for (const auto& p : a) {
    for (const auto& q : b) {
      const Interval both{std::max(p.lower, q.lower), std::min(p.upper, q.upper)};
      if (both.lower < both.upper) out.push_back(both);
    }
  }
  return out;
}

/// What the pieces leave free of all heights.
Pieces complement(const Pieces& sorted) {
  Pieces out;
  double from = -infinity;
  for (const auto& p : sorted) {
    if (p.lower > from) out.push_back({from, p.lower});
    from = std::max(from, p.upper);
  }
  if (from < infinity) out.push_back({from, infinity});
  return out;
}

class Search {
 public:
  Search(const FillSpace& space, const ColumnIntervals& walls, const SceneParts& parts, const std::vector<Vec3d>& water)
      : s_(space), walls_(walls), parts_(parts), grid_(space.columns.grid), dp_(space.lattice.dp),
        wet_(grid_.count(), Interval{infinity, -infinity}) {
    for (const auto& p : water) {
      Interval& w = wet_[grid_.index(column(p.x, grid_.x0, grid_.nx),
                                     s_.lattice.dimensions == 2 ? 0 : column(p.y, grid_.y0, grid_.ny))];
      w = {std::min(w.lower, p.z - 0.5 * dp_), std::max(w.upper, p.z + 0.5 * dp_)};
    }
  }

  std::optional<ThinWall> run() {
    for (int j = 0; j < grid_.ny; ++j) {
      for (int i = 0; i < grid_.nx; ++i) {
        const Interval& w = wet_[grid_.index(i, j)];
        if (w.upper - w.lower < 1.5 * dp_) continue;
        look_along(i, j, 1, 0);
        look_along(i, j, -1, 0);
        if (s_.lattice.dimensions == 3) look_along(i, j, 0, 1), look_along(i, j, 0, -1);
        look_down(i, j);
      }
    }
    look_closely();
    if (!best_) return std::nullopt;
    best_->places = suspects_.size() + floors_;
    return best_;
  }

 private:
  int column(double c, double first, int n) const {
    return std::clamp(static_cast<int>(std::lround((c - first) / dp_)), 0, n - 1);
  }

  Pieces solid(std::size_t c) const {
    return {walls_.interval.begin() + static_cast<std::ptrdiff_t>(walls_.first[c]),
            walls_.interval.begin() + static_cast<std::ptrdiff_t>(walls_.first[c + 1])};
  }

  /// Neither solid nor water.
  Pieces open(std::size_t c) const {
    Pieces free = complement(solid(c));
    if (wet_[c].lower < wet_[c].upper) free = common(free, complement({wet_[c]}));
    return free;
  }

  void look_along(int i, int j, int di, int dj) {
    const Interval& w = wet_[grid_.index(i, j)];
    Pieces front = {
        {w.lower, w.upper - dp_}};  // the part of the water's side before which only wall has been met so far
    for (int n = 1; n <= reach && !front.empty(); ++n) {
      const int a = i + n * di, b = j + n * dj;
      if (a < 0 || b < 0 || a >= grid_.nx || b >= grid_.ny) return;
      const std::size_t c = grid_.index(a, b);
      if (n > 1) {
        for (const auto& hole : common(front, open(c))) {
          if (hole.upper - hole.lower < 0.5 * dp_) continue;
          suspects_.push_back({i, j, hole, n - 1});
          return;
        }
      }
      front = common(front, solid(c));
    }
  }

  void look_down(int i, int j) {
    const std::size_t c = grid_.index(i, j);
    for (std::size_t k = walls_.first[c]; k < walls_.first[c + 1]; ++k) {
      const Interval& floor = walls_.interval[k];
      const double thickness = floor.upper - floor.lower;
      if (std::abs(floor.upper - wet_[c].lower) > dp_ || thickness >= least_wall_spacings * dp_) continue;
      if (k > walls_.first[c] && floor.lower - walls_.interval[k - 1].upper < 0.5 * dp_) continue;
      ++floors_;
      offer({grid_.x(i), grid_.y(j), wet_[c].lower}, thickness);
    }
  }

  /// The thinnest on the lattice first, and as many of them, evenly, as are looked at.
  void look_closely() {
    std::stable_sort(suspects_.begin(), suspects_.end(),
                     [](const Suspect& a, const Suspect& b) { return a.columns < b.columns; });
    const auto least = static_cast<std::size_t>(std::count_if(
        suspects_.begin(), suspects_.end(), [&](const Suspect& a) { return a.columns == suspects_.front().columns; }));
    for (std::size_t k = 0; k < std::min(looks, least); ++k) look_around(suspects_[k * least / std::min(looks, least)]);
    if (!best_ && least < suspects_.size()) {  // aslant: the thinnest along the axes need not be the thinnest across
      for (std::size_t k = 0; k < looks; ++k) look_around(suspects_[k * suspects_.size() / looks]);
    }
  }

  /// Thickness in all directions of the plan, on columns of the true surfaces.
  void look_around(const Suspect& at) {
    const double x = grid_.x(at.i), y = grid_.y(at.j), step = dp_ / finer;
    const bool flat = s_.lattice.dimensions == 2;
    constexpr int half = (reach + 2) * finer;
    const ColumnGrid fine{x - half * step, flat ? 0.0 : y - half * step, step, 2 * half + 1, flat ? 1 : 2 * half + 1};
    const ColumnIntervals solid = static_solid(parts_, fine);
    const int rays = flat ? 2 : directions;
    for (const double share : {0.1, 0.5, 0.9}) {
      const double z = at.open.lower + share * (at.open.upper - at.open.lower);
      for (int d = 0; d < rays; ++d) look_through(fine, solid, half, 2.0 * pi * d / rays, {x, y, z});
    }
  }

  /// Along a ray from the middle of the fine columns: the wall lies between the samples where it is entered and left for good.
  void look_through(const ColumnGrid& fine, const ColumnIntervals& solid, int half, double angle, const Vec3d& from) {
    int entered = 0, left = 0;
    for (int n = 1; n < half; ++n) {
      const int a = half + static_cast<int>(std::lround(n * std::cos(angle))),
                b = fine.ny == 1 ? 0 : half + static_cast<int>(std::lround(n * std::sin(angle)));
      if (solid.contains(fine.index(a, b), from.z)) {
        if (entered == 0) entered = n;
        left = n + 1;
      } else if (entered > 0 && is_near_water(fine.x(a), fine.y(b), from.z, 0)) {
        entered = 0;  // a corner of the water's own side
      } else if (entered > 0 && n - left >= open_space * finer) {
        if (!is_near_water(fine.x(a), fine.y(b), from.z, 1)) offer(from, (left - entered) * fine.spacing);
        return;
      }
    }
  }

  /// Whether there is water at this height within `columns` of the place.
  bool is_near_water(double x, double y, double z, int columns) const {
    const bool flat = s_.lattice.dimensions == 2;
    const int i = column(x, grid_.x0, grid_.nx), j = flat ? 0 : column(y, grid_.y0, grid_.ny);
    for (int b = std::max(0, j - columns); b <= std::min(grid_.ny - 1, j + columns); ++b) {
      for (int a = std::max(0, i - columns); a <= std::min(grid_.nx - 1, i + columns); ++a) {
        const Interval& w = wet_[grid_.index(a, b)];
        if (z > w.lower && z < w.upper) return true;
      }
    }
    return false;
  }

  void offer(const Vec3d& at, double thickness) {
    if (thickness >= least_wall_spacings * dp_ || (best_ && best_->thickness <= thickness)) return;
    best_ = ThinWall{at, thickness, 0};
  }

  const FillSpace& s_;
  const ColumnIntervals& walls_;
  const SceneParts& parts_;
  const ColumnGrid& grid_;
  const double dp_;
  std::vector<Interval> wet_;
  std::vector<Suspect> suspects_;
  std::size_t floors_ = 0;
  std::optional<ThinWall> best_;
};

}  // namespace

std::optional<ThinWall> thinnest_wall(const FillSpace& space, const ColumnIntervals& walls, const SceneParts& parts,
                                      const std::vector<Vec3d>& water) {
  if (water.empty() || space.columns.grid.count() == 0) return std::nullopt;
  return Search(space, walls, parts, water).run();
}

}  // namespace gdesp::geometry
