// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/water_reach.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/body_builder.hpp"
#include "geometry/boundary_layers.hpp"

namespace gdesp::geometry {
namespace {

constexpr double slide_efficiency = 0.7;  // speed of a slide over that of a free fall, as gdesp-run expects it
constexpr int margin =
    boundary_layer_count + 2;  // columns kept around the reach: the layers' thickness and what lies aslant

struct Cell {
  int i, j;
};

Cell cell_of(const FillSpace& s, const Vec3d& p) {
  const ColumnGrid& g = s.columns.grid;
  const int i = static_cast<int>(std::lround((p.x - g.x0) / g.spacing));
  const int j = s.lattice.dimensions == 2 ? 0 : static_cast<int>(std::lround((p.y - g.y0) / g.spacing));
  return {std::clamp(i, 0, g.nx - 1), std::clamp(j, 0, g.ny - 1)};
}

/// Whether the column has space below the head that is not solid.
std::vector<bool> open_below(double head, const ColumnIntervals& walls, std::size_t columns) {
  std::vector<bool> open(columns, true);
  for (std::size_t c = 0; c < columns; ++c) {
    double filled = -INFINITY;
    for (std::size_t k = walls.first[c]; k < walls.first[c + 1] && walls.interval[k].lower <= filled; ++k)
      filled = walls.interval[k].upper;
    open[c] = filled < head;
  }
  return open;
}

/// Every column marked, and all within `margin` columns of one: first along x, then along y.
std::vector<bool> widened(const std::vector<bool>& marked, const ColumnGrid& g) {
  std::vector<bool> row(marked.size(), false), out(marked.size(), false);
  for (int j = 0; j < g.ny; ++j) {
    int last = -1 - margin;
    for (int i = 0; i < g.nx + margin; ++i) {
      if (i < g.nx && marked[g.index(i, j)]) last = i;
      const int centre = i - margin;  // sees columns centre - margin .. i
      if (centre >= 0 && last >= centre - margin) row[g.index(centre, j)] = true;
    }
  }
  for (int i = 0; i < g.nx; ++i) {
    int last = -1 - margin;
    for (int j = 0; j < g.ny + margin; ++j) {
      if (j < g.ny && row[g.index(i, j)]) last = j;
      const int centre = j - margin;
      if (centre >= 0 && last >= centre - margin) out[g.index(i, centre)] = true;
    }
  }
  return out;
}

double largest_speed(const PrescribedMotion& motion) {
  double speed = 0.0;
  for (std::size_t k = 1; k < motion.time.size(); ++k) {
    speed = std::max(speed,
                     norm(motion.displacement[k] - motion.displacement[k - 1]) / (motion.time[k] - motion.time[k - 1]));
  }
  return speed;
}

double share_of_ground(const std::vector<bool>& kept, const FillSpace& s) {
  std::size_t all = 0, in = 0;
  for (std::size_t c = 0; c < kept.size(); ++c) {
    if (!std::isfinite(s.ground[c])) continue;
    ++all;
    in += kept[c];
  }
  return all ? static_cast<double>(in) / static_cast<double>(all) : 1.0;
}

}  // namespace

double default_run_up(const Scene& scene, const SceneParts& parts, const std::vector<Vec3d>& water) {
  const double g = norm(scene.gravity);
  if (!(g > 0.0) || water.empty()) return 0.0;
  double speed = scene.numerics.expected_speed;
  if (speed <= 0.0) {
    double low = INFINITY, high = -INFINITY, top = -INFINITY;
    for (const auto& p : water) low = std::min(low, p.z), high = std::max(high, p.z);
    for (const auto& s : parts.slides) top = std::max(top, bounds(s.mesh).upper.z);
    speed = std::sqrt(2.0 * g * (high - low + scene.dp));
    if (top > low) speed = std::max(speed, slide_efficiency * std::sqrt(2.0 * g * (top - low)));
    for (const auto& s : scene.slides) speed = std::max(speed, norm(s.velocity));
    for (const auto& body : scene.moving) speed = std::max(speed, largest_speed(moving_body(body, g).motion));
  }
  return speed * speed / (2.0 * g);
}

std::optional<WaterReach> reach_of_water(const FillSpace& s, const ColumnIntervals& walls,
                                         const std::vector<Vec3d>& water, double run_up) {
  const ColumnGrid& g = s.columns.grid;
  if (water.empty() || g.count() == 0) return std::nullopt;
  WaterReach out;
  out.head = -INFINITY;
  for (const auto& p : water) out.head = std::max(out.head, p.z + 0.5 * s.lattice.dp);
  out.head += run_up;
  const std::vector<bool> open = open_below(out.head, walls, g.count());
  std::vector<bool> reached(g.count(), false);
  std::vector<Cell> stack;
  const auto enter = [&](int i, int j) {
    const std::size_t c = g.index(i, j);
    if (reached[c] || !open[c]) return;
    reached[c] = true;
    stack.push_back({i, j});
  };
  for (const auto& p : water) enter(cell_of(s, p).i, cell_of(s, p).j);
  while (!stack.empty()) {
    const Cell at = stack.back();
    stack.pop_back();
    for (int j = std::max(0, at.j - 1); j <= std::min(g.ny - 1, at.j + 1); ++j) {
      for (int i = std::max(0, at.i - 1); i <= std::min(g.nx - 1, at.i + 1); ++i) enter(i, j);
    }
  }
  out.column = widened(reached, g);
  out.share = share_of_ground(out.column, s);
  return out;
}

WallSurfaces within_reach(const WallSurfaces& walls, const WaterReach& reach, const FillSpace& s) {
  const ColumnGrid& g = s.columns.grid;
  // How many kept columns lie in a rectangle: differences of sums over rectangles from the corner.
  std::vector<std::uint32_t> sum((static_cast<std::size_t>(g.nx) + 1) * (static_cast<std::size_t>(g.ny) + 1), 0);
  const auto at = [&](int i, int j) -> std::uint32_t& {
    return sum[static_cast<std::size_t>(j) * (static_cast<std::size_t>(g.nx) + 1) + static_cast<std::size_t>(i)];
  };
  for (int j = 0; j < g.ny; ++j) {
    for (int i = 0; i < g.nx; ++i)
      at(i + 1, j + 1) = at(i, j + 1) + at(i + 1, j) - at(i, j) + (reach.column[g.index(i, j)] ? 1u : 0u);
  }
  WallSurfaces out;
  out.mesh.vertex = walls.mesh.vertex;
  for (std::size_t t = 0; t < walls.mesh.triangle.size(); ++t) {
    Box box = empty_box();
    for (int c = 0; c < 3; ++c) extend(box, walls.mesh.vertex[walls.mesh.triangle[t][c]]);
    const Cell low = cell_of(s, box.lower), high = cell_of(s, box.upper);
    const int i0 = std::max(0, low.i - 1), j0 = std::max(0, low.j - 1), i1 = std::min(g.nx, high.i + 2),
              j1 = std::min(g.ny, high.j + 2);
    if (at(i1, j1) - at(i0, j1) - at(i1, j0) + at(i0, j0) == 0) continue;
    out.mesh.triangle.push_back(walls.mesh.triangle[t]);
    out.material.push_back(walls.material[t]);
  }
  return out;
}

}  // namespace gdesp::geometry
