// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gdesp::geometry {
namespace {

struct FixedPoint {
  std::int64_t x, y;
};

/// Horizontal coordinates as integers, small enough that a determinant fits 64 bits.
class FixedGrid {
 public:
  FixedGrid(const Box& box, const ColumnGrid& grid) {
    const double x1 = grid.x(grid.nx), y1 = grid.y(grid.ny);
    x0_ = std::min(box.lower.x, grid.x0);
    y0_ = std::min(box.lower.y, grid.y0);
    const double size = std::max({box.upper.x - x0_, box.upper.y - y0_, x1 - x0_, y1 - y0_, 1e-300});
    scale_ = std::ldexp(1.0, 29) / size;
  }
  FixedPoint operator()(double x, double y) const {
    return {std::llround((x - x0_) * scale_), std::llround((y - y0_) * scale_)};
  }

 private:
  double x0_, y0_, scale_;
};

/// Which side of a -> b the point lies on, never 0 for a != b: ties are broken by moving p by (e, e^2).
int side(const FixedPoint& a, const FixedPoint& b, const FixedPoint& p) {
  const std::int64_t ux = b.x - a.x, uy = b.y - a.y;
  const std::int64_t det = ux * (p.y - a.y) - uy * (p.x - a.x);
  if (det != 0) return det > 0 ? 1 : -1;
  if (uy != 0) return uy > 0 ? -1 : 1;
  return ux > 0 ? 1 : (ux < 0 ? -1 : 0);
}

struct Hit {
  std::size_t column;
  Crossing crossing;
};

struct Corner {
  FixedPoint at;
  double z;
};

double height_at(const Corner (&c)[3], const FixedPoint& p, std::int64_t area) {
  const auto weight = [&](const Corner& a, const Corner& b) {
    return static_cast<double>((b.at.x - a.at.x) * (p.y - a.at.y) - (b.at.y - a.at.y) * (p.x - a.at.x));
  };
  const double z = c[0].z * weight(c[1], c[2]) + c[1].z * weight(c[2], c[0]) + c[2].z * weight(c[0], c[1]);
  return z / static_cast<double>(area);
}

/// First and last column within [low, high], clipped to 0..n-1, with one column of slack for rounding.
std::pair<int, int> column_range(double low, double high, double start, double spacing, int n) {
  const double a = std::floor((low - start) / spacing), b = std::ceil((high - start) / spacing);
  return {static_cast<int>(std::clamp(a, 0.0, static_cast<double>(n))),
          static_cast<int>(std::clamp(b, -1.0, static_cast<double>(n - 1)))};
}

void cross_triangle(const Corner (&c)[3], const ColumnGrid& grid, const std::vector<FixedPoint>& xs,
                    const std::vector<FixedPoint>& ys, std::pair<int, int> is, std::pair<int, int> js,
                    std::int32_t triangle, std::vector<Hit>& hits) {
  const std::int64_t area =
      (c[1].at.x - c[0].at.x) * (c[2].at.y - c[0].at.y) - (c[1].at.y - c[0].at.y) * (c[2].at.x - c[0].at.x);
  if (area == 0) return;
  const int up = area > 0 ? 1 : -1;
  for (int j = js.first; j <= js.second; ++j) {
    for (int i = is.first; i <= is.second; ++i) {
      const FixedPoint p{xs[i].x, ys[j].y};
      if (side(c[0].at, c[1].at, p) != up || side(c[1].at, c[2].at, p) != up || side(c[2].at, c[0].at, p) != up)
        continue;
      hits.push_back({grid.index(i, j), {height_at(c, p, area), triangle, static_cast<std::int8_t>(-up)}});
    }
  }
}

Crossings sort_by_column(const std::vector<Hit>& hits, std::size_t columns) {
  Crossings out;
  out.first.assign(columns + 1, 0);
  for (const auto& h : hits) ++out.first[h.column + 1];
  for (std::size_t c = 0; c < columns; ++c) out.first[c + 1] += out.first[c];
  out.hit.resize(hits.size());
  std::vector<std::size_t> next(out.first.begin(), out.first.end() - 1);
  for (const auto& h : hits) out.hit[next[h.column]++] = h.crossing;
  for (std::size_t c = 0; c < columns; ++c) {
    if (out.first[c + 1] - out.first[c] < 2) continue;
    std::sort(out.hit.begin() + out.first[c], out.hit.begin() + out.first[c + 1],
              [](const Crossing& a, const Crossing& b) {
                return a.z != b.z ? a.z < b.z : (a.sign != b.sign ? a.sign > b.sign : a.triangle < b.triangle);
              });
  }
  return out;
}

}  // namespace

Crossings cross_columns(const TriangleMesh& mesh, const ColumnGrid& grid) {
  std::vector<Hit> hits;
  if (grid.count() == 0 || mesh.empty()) return sort_by_column(hits, grid.count());
  const FixedGrid fixed(bounds(mesh), grid);
  std::vector<FixedPoint> xs(grid.nx), ys(grid.ny), corner(mesh.vertex.size());
  for (int i = 0; i < grid.nx; ++i) xs[i] = fixed(grid.x(i), grid.y0);
  for (int j = 0; j < grid.ny; ++j) ys[j] = fixed(grid.x0, grid.y(j));
  for (std::size_t v = 0; v < corner.size(); ++v) corner[v] = fixed(mesh.vertex[v].x, mesh.vertex[v].y);
  hits.reserve(grid.count());
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    const auto& tri = mesh.triangle[t];
    const Vec3d &a = mesh.vertex[tri.x], &b = mesh.vertex[tri.y], &c = mesh.vertex[tri.z];
    const auto is = column_range(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), grid.x0, grid.spacing, grid.nx);
    if (is.first > is.second) continue;
    const auto js = column_range(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), grid.y0, grid.spacing, grid.ny);
    const Corner corners[3] = {{corner[tri.x], a.z}, {corner[tri.y], b.z}, {corner[tri.z], c.z}};
    cross_triangle(corners, grid, xs, ys, is, js, static_cast<std::int32_t>(t), hits);
  }
  return sort_by_column(hits, grid.count());
}

ColumnIntervals solid_intervals(const TriangleMesh& mesh, const ColumnGrid& grid) {
  const Crossings crossings = cross_columns(mesh, grid);
  ColumnIntervals out;
  out.first.assign(grid.count() + 1, 0);
  for (std::size_t c = 0; c < grid.count(); ++c) {
    int winding = 0;
    double entered = 0.0;
    for (std::size_t h = crossings.first[c]; h < crossings.first[c + 1]; ++h) {
      const int before = winding;
      winding += crossings.hit[h].sign;
      if (before <= 0 && winding > 0) entered = crossings.hit[h].z;
      if (before > 0 && winding <= 0 && crossings.hit[h].z > entered) {
        out.interval.push_back({entered, crossings.hit[h].z});
      }
    }
    out.first[c + 1] = out.interval.size();
  }
  return out;
}

std::vector<double> sheet_heights(const TriangleMesh& mesh, const ColumnGrid& grid, double tolerance,
                                  std::size_t* folded, Vec3d* where) {
  const Crossings crossings = cross_columns(mesh, grid);
  std::vector<double> height(grid.count(), std::numeric_limits<double>::quiet_NaN());
  std::size_t folds = 0;
  for (std::size_t c = 0; c < grid.count(); ++c) {
    const std::size_t a = crossings.first[c], b = crossings.first[c + 1];
    if (a == b) continue;
    height[c] = crossings.hit[b - 1].z;
    if (!(crossings.hit[b - 1].z - crossings.hit[a].z > tolerance)) continue;
    ++folds;
    if (where)
      *where = {grid.x(static_cast<int>(c % static_cast<std::size_t>(grid.nx))),
                grid.y(static_cast<int>(c / static_cast<std::size_t>(grid.nx))), height[c]};
  }
  if (folded) *folded = folds;
  return height;
}

bool ColumnIntervals::contains(std::size_t column, double z) const {
  for (std::size_t k = first[column]; k < first[column + 1]; ++k) {
    if (z < interval[k].lower) return false;
    if (z < interval[k].upper) return true;
  }
  return false;
}

ColumnIntervals unite(const ColumnIntervals& a, const ColumnIntervals& b) {
  if (a.first.empty()) return b;
  if (b.first.empty()) return a;
  ColumnIntervals out;
  out.first.assign(a.first.size(), 0);
  std::vector<Interval> both;
  for (std::size_t c = 0; c + 1 < a.first.size(); ++c) {
    both.assign(a.interval.begin() + a.first[c], a.interval.begin() + a.first[c + 1]);
    both.insert(both.end(), b.interval.begin() + b.first[c], b.interval.begin() + b.first[c + 1]);
    std::sort(both.begin(), both.end(), [](const Interval& p, const Interval& q) { return p.lower < q.lower; });
    const std::size_t start = out.interval.size();
    for (const auto& i : both) {
      if (out.interval.size() > start && i.lower <= out.interval.back().upper) {
        out.interval.back().upper = std::max(out.interval.back().upper, i.upper);
      } else {
        out.interval.push_back(i);
      }
    }
    out.first[c + 1] = out.interval.size();
  }
  return out;
}

ColumnIntervals subtract(const ColumnIntervals& a, const ColumnIntervals& b) {
  if (b.first.empty() || a.first.empty()) return a;
  ColumnIntervals out;
  out.first.assign(a.first.size(), 0);
  for (std::size_t c = 0; c + 1 < a.first.size(); ++c) {
    for (std::size_t k = a.first[c]; k < a.first[c + 1]; ++k) {
      double low = a.interval[k].lower;
      const double high = a.interval[k].upper;
      for (std::size_t m = b.first[c]; m < b.first[c + 1] && low < high; ++m) {
        if (b.interval[m].upper <= low) continue;
        if (b.interval[m].lower >= high) break;
        if (b.interval[m].lower > low) out.interval.push_back({low, b.interval[m].lower});
        low = b.interval[m].upper;
      }
      if (low < high) out.interval.push_back({low, high});
    }
    out.first[c + 1] = out.interval.size();
  }
  return out;
}

double volume(const ColumnIntervals& a, const ColumnGrid& grid) {
  double sum = 0.0;
  for (const auto& i : a.interval) sum += i.upper - i.lower;
  return sum * grid.spacing * grid.spacing;
}

std::vector<int> windings(const TriangleMesh& mesh, const std::vector<Vec3d>& points) {
  std::vector<int> winding(points.size(), 0);
  if (points.empty() || mesh.empty()) return winding;
  Box box = empty_box();
  for (const auto& p : points) extend(box, p);
  // Bins of a few points each, so that a triangle meets only the points under its own bounds.
  const double area = std::max((box.upper.x - box.lower.x) * (box.upper.y - box.lower.y), 1e-300);
  const double widest = std::max({box.upper.x - box.lower.x, box.upper.y - box.lower.y, 1e-150});
  const double spacing = std::max(std::sqrt(4.0 * area / static_cast<double>(points.size())), widest / 4000.0);
  ColumnGrid bins{box.lower.x, box.lower.y, spacing, static_cast<int>((box.upper.x - box.lower.x) / spacing) + 1,
                  static_cast<int>((box.upper.y - box.lower.y) / spacing) + 1};
  const FixedGrid fixed(bounds(mesh), bins);
  const auto bin_of = [&](const Vec3d& p) {
    return bins.index(std::min(static_cast<int>((p.x - bins.x0) / spacing), bins.nx - 1),
                      std::min(static_cast<int>((p.y - bins.y0) / spacing), bins.ny - 1));
  };
  std::vector<std::size_t> first(bins.count() + 1, 0), member(points.size());
  for (const auto& p : points) ++first[bin_of(p) + 1];
  for (std::size_t b = 0; b < bins.count(); ++b) first[b + 1] += first[b];
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (std::size_t k = 0; k < points.size(); ++k) member[next[bin_of(points[k])]++] = k;
  for (const auto& tri : mesh.triangle) {
    const Vec3d &a = mesh.vertex[tri.x], &b = mesh.vertex[tri.y], &c = mesh.vertex[tri.z];
    const Corner corner[3] = {{fixed(a.x, a.y), a.z}, {fixed(b.x, b.y), b.z}, {fixed(c.x, c.y), c.z}};
    const std::int64_t twice = (corner[1].at.x - corner[0].at.x) * (corner[2].at.y - corner[0].at.y) -
                               (corner[1].at.y - corner[0].at.y) * (corner[2].at.x - corner[0].at.x);
    if (twice == 0) continue;
    const int up = twice > 0 ? 1 : -1;
    // A point of bin i lies in [i, i + 1) spacings: one bin more to the left.
    auto is = column_range(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), bins.x0, spacing, bins.nx);
    auto js = column_range(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), bins.y0, spacing, bins.ny);
    is.first = std::max(0, is.first - 1);
    js.first = std::max(0, js.first - 1);
    for (int j = js.first; j <= js.second; ++j) {
      for (int i = is.first; i <= is.second; ++i) {
        for (std::size_t m = first[bins.index(i, j)]; m < first[bins.index(i, j) + 1]; ++m) {
          const Vec3d& q = points[member[m]];
          const FixedPoint p = fixed(q.x, q.y);
          if (side(corner[0].at, corner[1].at, p) != up || side(corner[1].at, corner[2].at, p) != up ||
              side(corner[2].at, corner[0].at, p) != up) {
            continue;
          }
          if (height_at(corner, p, twice) > q.z) winding[member[m]] += up;
        }
      }
    }
  }
  return winding;
}

ColumnGrid covering_columns(const Box& box, double spacing) {
  ColumnGrid grid;
  grid.spacing = spacing;
  if (is_empty(box)) return grid;
  grid.nx = std::max(1, static_cast<int>(std::ceil((box.upper.x - box.lower.x) / spacing - 1e-9)));
  grid.ny = std::max(1, static_cast<int>(std::ceil((box.upper.y - box.lower.y) / spacing - 1e-9)));
  grid.x0 = 0.5 * (box.lower.x + box.upper.x) - 0.5 * (grid.nx - 1) * spacing;
  grid.y0 = 0.5 * (box.lower.y + box.upper.y) - 0.5 * (grid.ny - 1) * spacing;
  return grid;
}

}  // namespace gdesp::geometry
