// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem/rigid_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "dem/wall_strips.hpp"

namespace gdesp::dem {
namespace {

// Collects points, one for each cell of the weld length, and adds up what they stand for.
class PointCollector {
 public:
  PointCollector(double weld, std::vector<SurfacePoint>& points) : inverse_(1.0 / weld), points_(points) {}
  void add(const Vec3d& p, double area) {
    const std::array<long long, 3> cell{std::llround(p.x * inverse_), std::llround(p.y * inverse_),
                                        std::llround(p.z * inverse_)};
    const auto [known, fresh] = seen_.try_emplace(cell, points_.size());
    if (fresh) points_.push_back({p, 0.0});
    points_[known->second].area += area;
  }

 private:
  double inverse_;
  std::vector<SurfacePoint>& points_;
  std::map<std::array<long long, 3>, std::size_t> seen_;
};

int parts_of(double length, double spacing) {
  return std::max(1, static_cast<int>(std::ceil(length / spacing - 1e-6)));
}

void add_line(const Vec3d& a, const Vec3d& b, double spacing, PointCollector& out) {
  const int n = parts_of(norm(b - a), spacing);
  const double share = norm(b - a) / n;
  for (int i = 0; i <= n; ++i)
    out.add(a + (static_cast<double>(i) / n) * (b - a), i == 0 || i == n ? 0.5 * share : share);
}

// A lattice of barycentric coordinates whose longest side is cut into parts of at most `spacing`.
void add_triangle(const Vec3d (&c)[3], double spacing, PointCollector& out) {
  const Vec3d e = c[1] - c[0], f = c[2] - c[0];
  const int n = parts_of(std::max({norm(e), norm(f), norm(e - f)}), spacing);
  const double third = norm(cross(e, f)) / (6.0 * n * n);
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; i + j <= n; ++j) {
      // The small triangles that meet here: one at a corner of the large one, three on its sides, six inside.
      const int sides = (i == 0) + (j == 0) + (i + j == n);
      out.add(c[0] + (static_cast<double>(i) / n) * e + (static_cast<double>(j) / n) * f,
              third * (sides == 0 ? 6 : (sides == 1 ? 3 : 1)));
    }
  }
}

struct Candidate {
  double distance2;
  Vec3d gap;    // from the surface to the point
  int feature;  // 0 face, 1 + k edge k, 4 + k vertex k
};

// Nearest place of the segment from a to b.
void try_edge(const Vec3d& p, const Vec3d& a, const Vec3d& b, int k, Candidate& best) {
  const Vec3d e = b - a;
  const double share = std::clamp(dot(p - a, e) / dot(e, e), 0.0, 1.0);
  const Vec3d gap = p - (a + share * e);
  const double distance2 = dot(gap, gap);
  if (distance2 < best.distance2)
    best = {distance2, gap, share <= 0.0 ? 4 + k : (share >= 1.0 ? 4 + (k + 1) % 3 : 1 + k)};
}

Candidate nearest_of_triangle(const WallMesh& mesh, const Vec3d& p, Index t) {
  const TriangleCorners& c = mesh.corners[static_cast<std::size_t>(t)];
  const Vec3d normal = cross(c.b - c.a, c.c - c.a);
  const bool inside = dot(cross(normal, c.b - c.a), p - c.a) >= 0.0 && dot(cross(normal, c.c - c.b), p - c.b) >= 0.0 &&
                      dot(cross(normal, c.a - c.c), p - c.c) >= 0.0;
  if (inside) {
    const double height = dot(p - c.a, normal) / dot(normal, normal);
    const Vec3d gap = height * normal;
    return {dot(gap, gap), gap, 0};
  }
  Candidate best{1.0e300, {}, 0};
  try_edge(p, c.a, c.b, 0, best);
  try_edge(p, c.b, c.c, 1, best);
  try_edge(p, c.c, c.a, 2, best);
  return best;
}

// On the rim of an open surface: what lies beyond it is neither in front nor behind.
bool on_rim(const WallMesh& mesh, Index t, int feature) {
  const auto number = static_cast<std::size_t>(t);
  if (feature == 0) return false;
  if (feature < 4) return mesh.edge[3 * number + static_cast<std::size_t>(feature - 1)].open != 0;
  return mesh.ring_of[static_cast<std::size_t>(mesh.vertex[number][feature - 4])].open != 0;
}

// Mean normal of the surface at a feature, not of unit length.
Vec3d outward(const WallMesh& mesh, Index t, int feature) {
  const auto number = static_cast<std::size_t>(t);
  const auto face = static_cast<Vec3d>(mesh.frame[number].n);
  if (feature == 0) return face;
  if (feature < 4) {
    const EdgeSide& side = mesh.edge[3 * number + static_cast<std::size_t>(feature - 1)];
    return side.open ? face : static_cast<Vec3d>(side.outward);
  }
  return static_cast<Vec3d>(mesh.ring_of[static_cast<std::size_t>(mesh.vertex[number][feature - 4])].outward);
}

double box_distance2(const WallNode& node, const Vec3d& p) {
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = std::max(
        {static_cast<double>(node.lower[axis]) - p[axis], 0.0, p[axis] - static_cast<double>(node.upper[axis])});
    sum += d * d;
  }
  return sum;
}

}  // namespace

std::vector<SurfacePoint> surface_points(const TriangleTable& walls, std::int32_t number, double spacing,
                                         int dimensions) {
  TriangleTable own;
  own.vertex = walls.vertex;
  for (std::size_t t = 0; t < walls.triangle.size(); ++t) {
    if (walls.body.empty() || walls.body[t] != number) continue;
    own.triangle.push_back(walls.triangle[t]);
    own.body.push_back(number);
  }
  std::vector<SurfacePoint> points;
  PointCollector collector(1.0e-3 * spacing, points);
  if (dimensions == 2) {
    const TriangleTable strips = make_wall_strips(own, 1.0e-6 * spacing, 1.0);
    for (std::size_t v = 0; v + 3 < strips.vertex.size(); v += 4) {
      add_line(0.5 * (strips.vertex[v] + strips.vertex[v + 3]), 0.5 * (strips.vertex[v + 1] + strips.vertex[v + 2]),
               spacing, collector);
    }
    return points;
  }
  for (const auto& t : own.triangle) {
    const Vec3d corner[3] = {own.vertex[static_cast<std::size_t>(t.x)], own.vertex[static_cast<std::size_t>(t.y)],
                             own.vertex[static_cast<std::size_t>(t.z)]};
    add_triangle(corner, spacing, collector);
  }
  return points;
}

void triangles_near(const WallMesh& mesh, std::int32_t body, const Vec3d& point, double reach,
                    std::vector<Index>& found) {
  const WallBody& tree = mesh.body[static_cast<std::size_t>(body)];
  if (tree.root < 0) return;
  const Vec3d p = point - tree.middle;
  const double reach2 = reach * reach;
  const auto begin = static_cast<std::ptrdiff_t>(found.size());
  std::vector<Index> open{tree.root};
  while (!open.empty()) {
    const WallNode& node = mesh.node[static_cast<std::size_t>(open.back())];
    open.pop_back();
    if (box_distance2(node, p) > reach2) continue;
    if (node.count == 0) {
      open.push_back(node.first);
      open.push_back(node.first + 1);
      continue;
    }
    for (Index t = node.first; t < node.first + node.count; ++t) {
      if (nearest_of_triangle(mesh, point, t).distance2 <= reach2) found.push_back(t);
    }
  }
  std::sort(found.begin() + begin, found.end());
}

NearestPlace nearest_place(const WallMesh& mesh, const Vec3d& point, const Index* triangle, Index count) {
  Candidate best{1.0e300, {}, 0};
  NearestPlace place;
  for (Index k = 0; k < count; ++k) {
    const Candidate one = nearest_of_triangle(mesh, point, triangle[k]);
    if (one.distance2 >= best.distance2) continue;
    best = one;
    place.triangle = triangle[k];
  }
  if (place.triangle < 0) return place;
  const Vec3d out = outward(mesh, place.triangle, best.feature);
  const double distance = std::sqrt(best.distance2), side = dot(best.gap, out) < 0.0 ? -1.0 : 1.0;
  if (on_rim(mesh, place.triangle, best.feature) && norm(cross(best.gap, out)) > 1.0e-3 * distance * norm(out))
    return {};
  place.distance = side * distance;
  // On the surface itself the gap has no direction.
  const Vec3d direction =
      best.feature == 0 || distance < 1.0e-9 * norm(point - mesh.body.front().middle) + 1.0e-12 ? out : side * best.gap;
  place.n = (1.0 / norm(direction)) * direction;
  return place;
}

}  // namespace gdesp::dem
