// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/vec3.hpp"

namespace gdesp {

enum class TriangleFeature { face, edge, vertex };

/// The point of triangle abc nearest to p (Ericson 2005, Real-Time Collision Detection, section 5.1.5, doi:10.1201/b14581), and what it lies on.
inline Vec3d closest_point(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                           TriangleFeature* feature = nullptr) {
  const auto on = [feature](TriangleFeature what, const Vec3d& point) {
    if (feature) *feature = what;
    return point;
  };
  using enum TriangleFeature;
  const Vec3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return on(vertex, a);
  const Vec3d bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return on(vertex, b);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return on(edge, a + ab * (d1 / (d1 - d3)));
  const Vec3d cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return on(vertex, c);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return on(edge, a + ac * (d2 / (d2 - d6)));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return on(edge, b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
  const double scale = 1.0 / (va + vb + vc);
  return on(face, a + ab * (vb * scale) + ac * (vc * scale));
}

}  // namespace gdesp
