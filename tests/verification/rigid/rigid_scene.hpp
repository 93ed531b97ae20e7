// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies and floors for tests, made without files.
#pragma once

#include <cmath>
#include <cstddef>

#include "../../support/surfaces.hpp"
#include "dem/rigid_bodies.hpp"

namespace gdesp::test {

inline void add_triangle(TriangleTable& walls, int body, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const auto base = static_cast<std::int32_t>(walls.vertex.size());
  walls.vertex.insert(walls.vertex.end(), {a, b, c});
  walls.triangle.push_back({base, base + 1, base + 2});
  walls.body.push_back(body);
}

/// Floor z = height over [low, high] x [low, high], normal upwards.
inline void add_floor(TriangleTable& walls, double low, double high, double height) {
  add_rectangle(walls, {low, low, height}, {high, low, height}, {high, high, height}, {low, high, height});
}

/// A cylinder along y, cut into `sides`, of 1 m length around (0, z).
inline Body add_cylinder(TriangleTable& walls, int number, double radius, double z, int sides, double density) {
  const double pi = 3.14159265358979323846;
  for (int k = 0; k < sides; ++k) {
    const double a = 2.0 * pi * k / sides, b = 2.0 * pi * (k + 1) / sides;
    const Vec3d p{radius * std::sin(a), 0.0, z + radius * std::cos(a)},
        q{radius * std::sin(b), 0.0, z + radius * std::cos(b)};
    const Vec3d side{0.0, 0.5, 0.0};
    add_rectangle(walls, p - side, q - side, q + side, p + side, number);
  }
  Body body;
  body.name = "cylinder";
  body.kind = BodyKind::free;
  body.mass = density * pi * radius * radius;
  body.centre = {0, 0, z};
  body.inertia[0] = body.inertia[8] = body.mass;
  body.inertia[4] = 0.5 * body.mass * radius * radius;
  return body;
}

/// A sphere of triangles between circles of latitude, around (0, 0, z).
inline Body add_sphere(TriangleTable& walls, int number, double radius, double z, int rings, double density) {
  const double pi = 3.14159265358979323846;
  const auto at = [&](int i, int j) {
    const double t = pi * i / rings, f = pi * j / rings;
    return Vec3d{radius * std::sin(t) * std::cos(f), radius * std::sin(t) * std::sin(f), z + radius * std::cos(t)};
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      if (i + 1 < rings) add_triangle(walls, number, at(i, j), at(i + 1, j), at(i + 1, j + 1));
      if (i > 0) add_triangle(walls, number, at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  Body body;
  body.name = "sphere";
  body.kind = BodyKind::free;
  body.mass = density * 4.0 / 3.0 * pi * radius * radius * radius;
  body.centre = {0, 0, z};
  for (int k = 0; k < 9; k += 4) body.inertia[k] = 0.4 * body.mass * radius * radius;
  return body;
}

/// Bodies alone, without water and grains, until `end` (s).
inline void run_dry(dem::RigidBodies& bodies, double end, double longest) {
  double t = 0.0;
  while (t < end - 1e-12) {
    const double h = std::min({longest, bodies.contact_time_step(), end - t});
    bodies.release(t);
    bodies.begin_step();
    bodies.substep(h, 1.0, {});
    t += h;
  }
}

}  // namespace gdesp::test
