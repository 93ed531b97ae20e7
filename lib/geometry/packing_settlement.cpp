// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/packing_settlement.hpp"

#include <algorithm>
#include <cmath>

namespace gdesp::geometry {
namespace {

constexpr double columns_per_diameter = 3.0;

double mean_height(const std::vector<Vec3d>& position) {
  double sum = 0.0;
  for (const Vec3d& p : position) sum += p.z;
  return position.empty() ? 0.0 : sum / static_cast<double>(position.size());
}

/// Highest point of any grain over each column (m); -1e300: none.
std::vector<double> upper_surface(const Packing& p, const ColumnGrid& grid, int dimensions) {
  std::vector<double> top(grid.count(), -1e300);
  for (std::size_t k = 0; k < p.position.size(); ++k) {
    const Vec3d c = p.position[k];
    const double radius = 0.5 * p.diameter[k];
    const auto first = [&](double x, double x0) {
      return std::max(0, static_cast<int>(std::ceil((x - radius - x0) / grid.spacing)));
    };
    const auto last = [&](double x, double x0, int n) {
      return std::min(n - 1, static_cast<int>(std::floor((x + radius - x0) / grid.spacing)));
    };
    const bool flat = dimensions == 2;
    for (int j = flat ? 0 : first(c.y, grid.y0); j <= (flat ? 0 : last(c.y, grid.y0, grid.ny)); ++j) {
      for (int i = first(c.x, grid.x0); i <= last(c.x, grid.x0, grid.nx); ++i) {
        const double dx = grid.x(i) - c.x, dy = flat ? 0.0 : grid.y(j) - c.y,
                     rest = radius * radius - dx * dx - dy * dy;
        if (rest > 0.0) top[grid.index(i, j)] = std::max(top[grid.index(i, j)], c.z + std::sqrt(rest));
      }
    }
  }
  return top;
}

double bed_porosity(const PackingRequest& r, const Packing& p) {
  double solid = 0.0, diameter = 0.0;
  for (const float d : p.diameter)
    solid += grain_volume(d, r.dimensions), diameter += d / static_cast<double>(p.diameter.size());
  ColumnGrid grid = covering_columns(r.box, diameter / columns_per_diameter);
  if (r.dimensions == 2) grid.y0 = 0.0, grid.ny = 1;
  const std::vector<double> top = upper_surface(p, grid, r.dimensions);
  ColumnIntervals bed = r.space(grid);
  double length = 0.0;
  for (std::size_t c = 0; c < grid.count(); ++c) {
    for (std::size_t k = bed.first[c]; k < bed.first[c + 1]; ++k)
      length += std::max(0.0, std::min(bed.interval[k].upper, top[c]) - bed.interval[k].lower);
  }
  const double space = length * grid.spacing * (r.dimensions == 2 ? 1.0 : grid.spacing);
  return space > 0.0 ? 1.0 - solid / space : 0.0;
}

}  // namespace

SettledBed settle_packing(const PackingRequest& r, double density, const GrainSettler& settler, Packing& packing) {
  SettledBed out;
  const double before = mean_height(packing.position);
  const std::size_t given = packing.position.size();
  GrainTable grains;
  grains.position = packing.position;
  grains.diameter = packing.diameter;
  grains.density.assign(given, static_cast<float>(density));
  const TriangleMesh walls = bounding_walls(r);
  out.settlement =
      settler(grains, {walls.vertex, walls.triangle, std::vector<std::int32_t>(walls.triangle.size(), 0), {}});
  const std::vector<bool> inside = r.contains(grains.position);
  packing.position.clear();
  packing.diameter.clear();
  for (std::size_t k = 0; k < inside.size(); ++k) {
    if (!inside[k]) continue;
    packing.position.push_back(grains.position[k]);
    packing.diameter.push_back(grains.diameter[k]);
  }
  packing.left_out += given - packing.position.size();
  measure(r, packing);
  out.fall = before - mean_height(packing.position);
  out.porosity = bed_porosity(r, packing);
  return out;
}

}  // namespace gdesp::geometry
