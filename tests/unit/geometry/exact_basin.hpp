// SPDX-License-Identifier: GPL-3.0-or-later
// Water below a level over a sheet of triangles, integrated exactly: what column sums are compared with.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "geometry/heightfield.hpp"
#include "geometry/triangle_mesh.hpp"
#include "scene/scene.hpp"

namespace gdesp::geometry::testing {

struct Basin {
  double volume = 0.0, area = 0.0;
};  // m3, m2

/// The part of a convex polygon where `height`, linear along its edges, is positive.
template <class Height>
std::vector<Vec3d> clipped(const std::vector<Vec3d>& polygon, const Height& height) {
  std::vector<Vec3d> out;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3d &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double fa = height(a), fb = height(b);
    if (fa >= 0.0) out.push_back(a);
    if (fa * fb < 0.0) out.push_back(a + (b - a) * (fa / (fa - fb)));
  }
  return out;
}

inline Basin prism(const std::vector<Vec3d>& polygon, double level) {
  Basin out;
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    const Vec3d &a = polygon[0], &b = polygon[k], &c = polygon[k + 1];
    const double area = 0.5 * std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    out.area += area;
    out.volume += area * (level - (a.z + b.z + c.z) / 3.0);
  }
  return out;
}

/// The largest connected body of water below `level`; `polygon` (convex, may be empty) bounds it in plan.
inline Basin exact_basin(const TriangleMesh& sheet, double level, const std::vector<Point2>& polygon) {
  double turn = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Point2 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    turn += a.x * b.y - b.x * a.y;
  }
  std::map<std::size_t, Basin> wet;                                                  // by triangle
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::size_t>> across;  // submerged edges
  for (std::size_t t = 0; t < sheet.triangle.size(); ++t) {
    const auto& corner = sheet.triangle[t];
    std::vector<Vec3d> part;
    for (int c = 0; c < 3; ++c) part.push_back(sheet.vertex[corner[c]]);
    part = clipped(part, [&](const Vec3d& p) { return level - p.z; });
    for (std::size_t k = 0; k < polygon.size() && part.size() > 2; ++k) {
      const Point2 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
      part = clipped(part, [&](const Vec3d& p) {
        return std::copysign(1.0, turn) * ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x));
      });
    }
    if (part.size() < 3) continue;
    wet[t] = prism(part, level);
    for (int c = 0; c < 3; ++c) {
      const auto a = corner[c], b = corner[(c + 1) % 3];
      if (std::min(sheet.vertex[a].z, sheet.vertex[b].z) < level) across[std::minmax(a, b)].push_back(t);
    }
  }
  std::map<std::size_t, std::vector<std::size_t>> beside;
  for (const auto& [edge, both] : across) {
    if (both.size() == 2) beside[both[0]].push_back(both[1]), beside[both[1]].push_back(both[0]);
  }
  Basin largest;
  while (!wet.empty()) {
    Basin body;
    std::vector<std::size_t> stack = {wet.begin()->first};
    while (!stack.empty()) {
      const auto found = wet.find(stack.back());
      stack.pop_back();
      if (found == wet.end()) continue;
      body.volume += found->second.volume;
      body.area += found->second.area;
      stack.insert(stack.end(), beside[found->first].begin(), beside[found->first].end());
      wet.erase(found);
    }
    if (body.volume > largest.volume) largest = body;
  }
  return largest;
}

/// Area of a raster's cells around the nodes below `level` that hang together with the place (x, y).
inline double wet_cells_area(const Heightfield& f, double level, double x, double y) {
  std::vector<bool> seen(f.z.size(), false);
  std::vector<std::pair<int, int>> stack = {
      {static_cast<int>(std::lround((x - f.x0) / f.dx)), static_cast<int>(std::lround((y - f.y0) / f.dy))}};
  std::size_t cells = 0;
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    if (i < 0 || j < 0 || i >= f.nx || j >= f.ny) continue;
    const std::size_t k = static_cast<std::size_t>(j) * static_cast<std::size_t>(f.nx) + static_cast<std::size_t>(i);
    if (seen[k] || !(f.z[k] < level)) continue;
    seen[k] = true;
    ++cells;
    stack.insert(stack.end(), {{i - 1, j}, {i + 1, j}, {i, j - 1}, {i, j + 1}});
  }
  return static_cast<double>(cells) * f.dx * f.dy;
}

}  // namespace gdesp::geometry::testing
