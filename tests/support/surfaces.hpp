// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces and boxes for tests, made without files.
#pragma once

#include <cstdint>

#include "particles/particle_tables.hpp"

namespace gdesp::test {

/// A rectangle a, b, c, d (its front by the right-hand rule) as two triangles.
inline void add_rectangle(TriangleTable& table, const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d,
                          std::int32_t body = 0) {
  const auto base = static_cast<std::int32_t>(table.vertex.size());
  table.vertex.insert(table.vertex.end(), {a, b, c, d});
  table.triangle.push_back({base, base + 1, base + 2});
  table.triangle.push_back({base, base + 2, base + 3});
  table.body.insert(table.body.end(), 2, body);
}

/// A closed box, seen from outside.
inline void add_box(TriangleTable& table, std::int32_t body, const Vec3d& low, const Vec3d& high) {
  const auto at = [&](int i, int j, int k) {
    return Vec3d{i ? high.x : low.x, j ? high.y : low.y, k ? high.z : low.z};
  };
  add_rectangle(table, at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0), body);
  add_rectangle(table, at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1), body);
  add_rectangle(table, at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1), body);
  add_rectangle(table, at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0), body);
  add_rectangle(table, at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0), body);
  add_rectangle(table, at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1), body);
}

/// A closed box seen from inside.
inline TriangleTable tank(const Vec3d& low, const Vec3d& high) {
  TriangleTable table;
  const Vec3d p[8] = {low,
                      {high.x, low.y, low.z},
                      {high.x, high.y, low.z},
                      {low.x, high.y, low.z},
                      {low.x, low.y, high.z},
                      {high.x, low.y, high.z},
                      high,
                      {low.x, high.y, high.z}};
  add_rectangle(table, p[0], p[1], p[2], p[3]);  // floor, upwards
  add_rectangle(table, p[4], p[7], p[6], p[5]);  // lid
  add_rectangle(table, p[0], p[3], p[7], p[4]);  // x low, towards +x
  add_rectangle(table, p[1], p[5], p[6], p[2]);
  add_rectangle(table, p[0], p[4], p[5], p[1]);  // y low
  add_rectangle(table, p[3], p[2], p[6], p[7]);
  return table;
}

/// A free box of given density; in two dimensions the y extent must be 1 m (mass per metre).
inline Body box_body(const Vec3d& lo, const Vec3d& hi, double density) {
  Body body;
  body.name = "box";
  body.kind = BodyKind::free;
  const Vec3d s = hi - lo;
  body.mass = density * s.x * s.y * s.z;
  body.centre = 0.5 * (lo + hi);
  body.inertia[0] = body.mass * (s.y * s.y + s.z * s.z) / 12.0;
  body.inertia[4] = body.mass * (s.x * s.x + s.z * s.z) / 12.0;
  body.inertia[8] = body.mass * (s.x * s.x + s.y * s.y) / 12.0;
  return body;
}

}  // namespace gdesp::test
