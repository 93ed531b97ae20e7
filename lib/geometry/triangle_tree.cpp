// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/triangle.hpp"

namespace gdesp::geometry {
namespace {

constexpr std::int32_t leaf_size = 4;

double squared_distance(const Box& box, const Vec3d& p) {
  double sum = 0.0;
  for (int a = 0; a < 3; ++a) {
    const double d = std::max({box.lower[a] - p[a], 0.0, p[a] - box.upper[a]});
    sum += d * d;
  }
  return sum;
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  corner_.reserve(mesh.triangle.size());
  for (const auto& t : mesh.triangle) corner_.push_back({{mesh.vertex[t.x], mesh.vertex[t.y], mesh.vertex[t.z]}});
  order_.resize(corner_.size());
  std::iota(order_.begin(), order_.end(), 0);
  node_.reserve(corner_.size());
  if (!corner_.empty()) build(0, static_cast<std::int32_t>(corner_.size()));
}

std::int32_t TriangleTree::build(std::int32_t first, std::int32_t last) {
  const auto self = static_cast<std::int32_t>(node_.size());
  node_.push_back({empty_box(), first, last - first, -1});
  Box box = empty_box(), centres = empty_box();
  const auto centre = [&](std::int32_t t) { return corner_[t].at[0] + corner_[t].at[1] + corner_[t].at[2]; };
  for (std::int32_t k = first; k < last; ++k) {
    for (const auto& c : corner_[order_[k]].at) extend(box, c);
    extend(centres, centre(order_[k]));
  }
  node_[self].box = box;
  if (last - first <= leaf_size) return self;
  const Vec3d size = extent(centres);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const std::int32_t middle = (first + last) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                   [&](std::int32_t a, std::int32_t b) {
                     const double ca = centre(a)[axis], cb = centre(b)[axis];
                     return ca != cb ? ca < cb : a < b;
                   });
  node_[self].count = 0;
  build(first, middle);
  const std::int32_t right = build(middle, last);
  node_[self].right = right;
  return self;
}

void TriangleTree::within(const Vec3d& p, double radius, std::vector<std::int32_t>& found) const {
  found.clear();
  if (node_.empty()) return;
  const double limit = radius * radius;
  std::int32_t stack[128];
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::int32_t n = stack[--top];
    const Node& node = node_[n];
    if (squared_distance(node.box, p) > limit) continue;
    if (node.count == 0) {
      stack[top++] = node.right;
      stack[top++] = n + 1;
      continue;
    }
    for (std::int32_t k = node.first; k < node.first + node.count; ++k) {
      const auto& c = corner_[order_[k]].at;
      const Vec3d d = p - closest_point(p, c[0], c[1], c[2]);
      if (dot(d, d) <= limit) found.push_back(order_[k]);
    }
  }
  std::sort(found.begin(), found.end());
}

NearestPoint TriangleTree::nearest(const Vec3d& p, double limit) const {
  NearestPoint best;
  if (node_.empty()) return best;
  double limit2 = limit * limit;
  std::int32_t stack[128];
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const std::int32_t n = stack[--top];
    const Node& node = node_[n];
    if (squared_distance(node.box, p) > limit2) continue;
    if (node.count == 0) {
      std::int32_t near = n + 1, far = node.right;
      if (squared_distance(node_[far].box, p) < squared_distance(node_[near].box, p)) std::swap(near, far);
      stack[top++] = far;
      stack[top++] = near;
      continue;
    }
    for (std::int32_t k = node.first; k < node.first + node.count; ++k) {
      const auto& c = corner_[order_[k]].at;
      const Vec3d q = closest_point(p, c[0], c[1], c[2]);
      const double d2 = dot(p - q, p - q);
      if (d2 > limit2 || (d2 == limit2 && best.triangle >= 0)) continue;
      limit2 = d2;
      best = {std::sqrt(d2), q, order_[k]};
    }
  }
  return best;
}

Vec3d TriangleTree::normal(std::int32_t triangle) const {
  const auto& c = corner_[triangle].at;
  const Vec3d n = cross(c[1] - c[0], c[2] - c[0]);
  const double length = norm(n);
  return length > 0.0 ? n * (1.0 / length) : Vec3d{};
}

}  // namespace gdesp::geometry
