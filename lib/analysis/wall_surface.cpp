// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/wall_surface.hpp"

#include <algorithm>
#include <limits>

#include "core/triangle.hpp"

namespace gdesp::analysis {
namespace {

constexpr std::uint32_t leaf_size = 4;

Vec3d lower_of(const Vec3d& a, const Vec3d& b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3d upper_of(const Vec3d& a, const Vec3d& b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

double squared_distance_to_box(const Vec3d& p, const Vec3d& lower, const Vec3d& upper) {
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = std::max({lower[axis] - p[axis], 0.0, p[axis] - upper[axis]});
    sum += d * d;
  }
  return sum;
}

}  // namespace

WallSurface::WallSurface(const TriangleTable& walls) {
  for (std::size_t k = 0; k < walls.triangle.size(); ++k) {
    if (k < walls.body.size() && walls.body[k] > 0) continue;
    const auto& t = walls.triangle[k];
    triangle_.push_back({walls.vertex[t.x], walls.vertex[t.y], walls.vertex[t.z]});
  }
  if (triangle_.empty()) return;
  node_.reserve(triangle_.size());
  node_.resize(1);
  build(0, 0, static_cast<std::uint32_t>(triangle_.size()));
}

void WallSurface::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  Vec3d lower = triangle_[first].a, upper = lower;
  for (std::uint32_t k = first; k < first + count; ++k) {
    const Triangle& t = triangle_[k];
    lower = lower_of(lower, lower_of(t.a, lower_of(t.b, t.c)));
    upper = upper_of(upper, upper_of(t.a, upper_of(t.b, t.c)));
  }
  node_[node].lower = lower;
  node_[node].upper = upper;
  if (count <= leaf_size) {
    node_[node].first = first;
    node_[node].count = count;
    return;
  }
  const Vec3d size = upper - lower;
  const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  const auto begin = triangle_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count, [axis](const Triangle& s, const Triangle& t) {
    return s.a[axis] + s.b[axis] + s.c[axis] < t.a[axis] + t.b[axis] + t.c[axis];
  });
  const auto child = static_cast<std::uint32_t>(node_.size());
  node_.resize(node_.size() + 2);
  node_[node].first = child;
  node_[node].count = 0;
  build(child, first, count / 2);
  build(child + 1, first + count / 2, count - count / 2);
}

std::optional<Vec3d> WallSurface::nearest(const Vec3d& p, double limit) const {
  if (empty()) return std::nullopt;
  double best2 = limit * limit;
  std::optional<Vec3d> best;
  std::uint32_t stack[64];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = node_[stack[--depth]];
    if (squared_distance_to_box(p, node.lower, node.upper) > best2) continue;
    if (node.count == 0) {
      stack[depth++] = node.first;
      stack[depth++] = node.first + 1;
      continue;
    }
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      const Triangle& t = triangle_[k];
      const Vec3d here = closest_point(p, t.a, t.b, t.c), d = p - here;
      if (dot(d, d) <= best2) {
        best2 = dot(d, d);
        best = here;
      }
    }
  }
  return best;
}

std::optional<double> WallSurface::height(double x, double y) const {
  constexpr double nothing = -std::numeric_limits<double>::infinity();
  double ground = nothing, any = nothing;
  if (empty()) return std::nullopt;
  std::uint32_t stack[64];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Node& node = node_[stack[--depth]];
    if (x < node.lower.x || x > node.upper.x || y < node.lower.y || y > node.upper.y || node.upper.z <= ground)
      continue;
    if (node.count == 0) {
      stack[depth++] = node.first;
      stack[depth++] = node.first + 1;
      continue;
    }
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      const Triangle& t = triangle_[k];
      const double area = (t.b.x - t.a.x) * (t.c.y - t.a.y) - (t.c.x - t.a.x) * (t.b.y - t.a.y);
      if (std::abs(area) < 1e-12 * (1.0 + std::abs(t.a.x) + std::abs(t.a.y))) continue;  // vertical
      const double u = ((x - t.a.x) * (t.c.y - t.a.y) - (t.c.x - t.a.x) * (y - t.a.y)) / area;
      const double v = ((t.b.x - t.a.x) * (y - t.a.y) - (x - t.a.x) * (t.b.y - t.a.y)) / area;
      if (u < -1e-9 || v < -1e-9 || u + v > 1.0 + 1e-9) continue;
      const double z = t.a.z + u * (t.b.z - t.a.z) + v * (t.c.z - t.a.z);
      any = std::max(any, z);
      if (area > 0.0) ground = std::max(ground, z);  // counter-clockwise from above: faces up
    }
  }
  if (!std::isfinite(any)) return std::nullopt;
  return std::isfinite(ground) ? ground : any;
}

}  // namespace gdesp::analysis
