// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/solid_columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace gdesp::geometry {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// One interval per column from a function of (x, y) that fills up to two of them.
template <class Fill>
ColumnIntervals per_column(const ColumnGrid& grid, const Fill& fill) {
  ColumnIntervals out;
  out.first.assign(grid.count() + 1, 0);
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      fill(grid.x(i), grid.y(j), out.interval);
      out.first[grid.index(i, j) + 1] = out.interval.size();
    }
  }
  return out;
}

ColumnIntervals below_heights(const std::vector<double>& height, const ColumnGrid& grid, bool missing_is_solid) {
  ColumnIntervals out;
  out.first.assign(grid.count() + 1, 0);
  for (std::size_t c = 0; c < grid.count(); ++c) {
    if (std::isfinite(height[c])) {
      out.interval.push_back({-infinity, height[c]});
    } else if (missing_is_solid) {
      out.interval.push_back({-infinity, infinity});
    }
    out.first[c + 1] = out.interval.size();
  }
  return out;
}

ColumnIntervals tank_solid(const WallPart& tank, const ColumnGrid& grid) {
  const Vec3d lo = tank.tank.lower, hi = tank.tank.upper;
  const double top = is_open(tank, "top") ? hi.z : infinity;
  const bool face[4] = {!is_open(tank, "x-"), !is_open(tank, "x+"), !is_open(tank, "y-"), !is_open(tank, "y+")};
  const bool bottom = !is_open(tank, "bottom");
  return per_column(grid, [&](double x, double y, std::vector<Interval>& out) {
    const bool wall =
        (x < lo.x && face[0]) || (x >= hi.x && face[1]) || (y < lo.y && face[2]) || (y >= hi.y && face[3]);
    if (wall) {
      out.push_back({-infinity, top});
      return;
    }
    if (bottom) out.push_back({-infinity, lo.z});
    if (std::isfinite(top)) return;
    out.push_back({hi.z, infinity});
  });
}

/// Several tanks: solid only where all of them are.
ColumnIntervals intersect(const ColumnIntervals& a, const ColumnIntervals& b) { return subtract(a, subtract(a, b)); }

ColumnIntervals box_solid(const Box& box, const ColumnGrid& grid) {
  return per_column(grid, [&](double x, double y, std::vector<Interval>& out) {
    if (x >= box.lower.x && x < box.upper.x && y >= box.lower.y && y < box.upper.y)
      out.push_back({box.lower.z, box.upper.z});
  });
}

ColumnIntervals part_solid(const SolidPart& part, const ColumnGrid& grid) {
  return part.box ? box_solid(*part.box, grid) : solid_intervals(part.mesh, grid);
}

}  // namespace

bool is_open(const WallPart& tank, const char* face) {
  return std::find(tank.open.begin(), tank.open.end(), face) != tank.open.end();
}

LatticeColumns lattice_columns(const Lattice& lattice, const Box& box) {
  LatticeColumns out;
  out.i0 = lattice.first_at_or_above(0, box.lower.x);
  const std::int32_t i1 = lattice.last_at_or_below(0, box.upper.x);
  std::int32_t j1 = 0;
  if (lattice.dimensions == 3) {
    out.j0 = lattice.first_at_or_above(1, box.lower.y);
    j1 = lattice.last_at_or_below(1, box.upper.y);
  }
  const double nx = std::max(0.0, static_cast<double>(i1) - out.i0 + 1),
               ny = std::max(0.0, static_cast<double>(j1) - out.j0 + 1);
  if (nx * ny > 4e8) {
    throw Error(ErrorKind::resource, "resolution.dp = " + std::to_string(lattice.dp) + " m makes " +
                                         std::to_string(static_cast<long long>(nx * ny)) +
                                         " lattice columns, more than 4e8; coarsen it or give a smaller domain");
  }
  out.grid = {lattice.coordinate(0, out.i0), lattice.coordinate(1, out.j0), lattice.dp, static_cast<int>(nx),
              static_cast<int>(ny)};
  return out;
}

ColumnIntervals static_solid(const SceneParts& parts, const ColumnGrid& columns, std::vector<double>* ground) {
  ColumnIntervals solid, tanks;
  solid.first.assign(columns.count() + 1, 0);
  bool has_tank = false;
  for (const auto& w : parts.walls) {
    if (w.kind != WallPart::Kind::tank) continue;
    tanks = has_tank ? intersect(tanks, tank_solid(w, columns)) : tank_solid(w, columns);
    has_tank = true;
  }
  if (has_tank) solid = tanks;
  std::vector<double> height(columns.count(), std::numeric_limits<double>::quiet_NaN());
  if (!parts.terrain.empty()) {
    height = sheet_heights(parts.terrain, columns, 0.0, nullptr);
    solid = unite(solid, below_heights(height, columns, !has_tank));
  }
  for (const auto& w : parts.walls) {
    if (w.kind == WallPart::Kind::solid) solid = unite(solid, solid_intervals(w.mesh, columns));
    if (w.kind != WallPart::Kind::sheet) continue;
    const auto sheet = sheet_heights(w.mesh, columns, 0.0, nullptr);
    solid = unite(solid, below_heights(sheet, columns, false));
    for (std::size_t c = 0; c < sheet.size(); ++c) {
      if (std::isfinite(sheet[c])) height[c] = std::isfinite(height[c]) ? std::max(height[c], sheet[c]) : sheet[c];
    }
  }
  if (ground) *ground = std::move(height);
  return solid;
}

ColumnIntervals body_solid(const SceneParts& parts, const Scene& scene, const ColumnGrid& columns) {
  ColumnIntervals solid;
  solid.first.assign(columns.count() + 1, 0);
  for (const auto* list : {&parts.moving, &parts.floating}) {
    for (const auto& p : *list) solid = unite(solid, part_solid(p, columns));
  }
  for (std::size_t k = 0; k < parts.slides.size(); ++k) {
    if (scene.slides[k].kind != "granular") solid = unite(solid, part_solid(parts.slides[k], columns));
  }
  return solid;
}

double tank_clearance(const WallPart& tank, const Vec3d& p) {
  const Vec3d lo = tank.tank.lower, hi = tank.tank.upper;
  double d = infinity;
  if (!is_open(tank, "x-")) d = std::min(d, p.x - lo.x);
  if (!is_open(tank, "x+")) d = std::min(d, hi.x - p.x);
  if (!is_open(tank, "y-")) d = std::min(d, p.y - lo.y);
  if (!is_open(tank, "y+")) d = std::min(d, hi.y - p.y);
  if (!is_open(tank, "bottom")) d = std::min(d, p.z - lo.z);
  if (!is_open(tank, "top")) d = std::min(d, hi.z - p.z);
  return d;
}

double box_distance(const Box& box, const Vec3d& p, int dimensions) {
  double sum = 0.0;
  for (int a = 0; a < 3; ++a) {
    if (dimensions == 2 && a == 1) continue;
    const double d = std::max({box.lower[a] - p[a], 0.0, p[a] - box.upper[a]});
    sum += d * d;
  }
  return std::sqrt(sum);
}

}  // namespace gdesp::geometry
