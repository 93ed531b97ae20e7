// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem/wall_strips.hpp"

#include <cmath>
#include <set>
#include <tuple>
#include <utility>

namespace gdesp::dem {
namespace {

struct Segment {
  Vec3d from, to;  // y = 0; the fluid lies to the side of `normal`
  double length;
};

// The longest edge as seen along y, directed so that (to - from) x y points to the triangle's front.
Segment seen_along_y(const Vec3d (&corner)[3], const Vec3d& normal) {
  Segment best{{}, {}, -1.0};
  for (int k = 0; k < 3; ++k) {
    Vec3d a = corner[k], b = corner[(k + 1) % 3];
    a.y = b.y = 0.0;
    if (norm(b - a) > best.length) best = {a, b, norm(b - a)};
  }
  const Vec3d front = cross(best.to - best.from, Vec3d{0.0, 1.0, 0.0});
  if (dot(front, normal) < 0.0) std::swap(best.from, best.to);
  return best;
}

}  // namespace

TriangleTable make_wall_strips(const TriangleTable& table, double weld, double half_width) {
  TriangleTable strips;
  std::set<std::tuple<long long, long long, long long, long long, int>> seen;
  const auto place = [&](double x) { return std::llround(x / (4.0 * weld)); };
  for (std::size_t t = 0; t < table.triangle.size(); ++t) {
    const Vec3<std::int32_t>& v = table.triangle[t];
    const Vec3d corner[3] = {table.vertex[static_cast<std::size_t>(v.x)], table.vertex[static_cast<std::size_t>(v.y)],
                             table.vertex[static_cast<std::size_t>(v.z)]};
    const Vec3d normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
    if (!(std::abs(normal.y) < 0.5 * norm(normal))) continue;
    const Segment s = seen_along_y(corner, normal);
    const int body = table.body.empty() ? 0 : table.body[t];
    if (!seen.insert({place(s.from.x), place(s.from.z), place(s.to.x), place(s.to.z), body}).second) continue;
    const auto base = static_cast<std::int32_t>(strips.vertex.size());
    const Vec3d side{0.0, half_width, 0.0};
    strips.vertex.insert(strips.vertex.end(), {s.from - side, s.to - side, s.to + side, s.from + side});
    // (to - from) x y is the front, so from-, to-, to+ turns about it by the right hand.
    strips.triangle.push_back({base, base + 1, base + 2});
    strips.triangle.push_back({base, base + 2, base + 3});
    strips.body.insert(strips.body.end(), 2, body);
    if (!table.smooth.empty()) strips.smooth.insert(strips.smooth.end(), 2, table.smooth[t]);
  }
  return strips;
}

}  // namespace gdesp::dem
