// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/slide_state.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gdesp::analysis {

double cap_share(double centre_z, double diameter, double level, int dimensions) {
  const double radius = 0.5 * diameter;
  const double h = std::clamp(level - (centre_z - radius), 0.0, diameter);
  if (dimensions == 3) return h * h * (3.0 * radius - h) / (4.0 * radius * radius * radius);
  const double a = std::acos(std::clamp(1.0 - h / radius, -1.0, 1.0));
  return (a - std::sin(a) * std::cos(a)) / std::numbers::pi;
}

SlideState measure_grains(const GrainTable& g, int dimensions, const LevelAt& level) {
  double volume = 0, mass = 0, x = 0, y = 0, z = 0, u = 0, v = 0, w = 0, wet = 0, fastest = 0;
  const bool moving = g.velocity.size() == g.position.size();
#pragma omp parallel for schedule(static) reduction(+ : volume, mass, x, y, z, u, v, w, wet) reduction(max : fastest)
  for (std::size_t i = 0; i < g.position.size(); ++i) {
    const double d = g.diameter[i];
    const double part = dimensions == 2 ? std::numbers::pi * d * d / 4.0 : std::numbers::pi * d * d * d / 6.0;
    const double m = part * (i < g.density.size() ? g.density[i] : 1.0);
    const Vec3d& p = g.position[i];
    volume += part, mass += m;
    x += m * p.x, y += m * p.y, z += m * p.z;
    if (const auto top = level(p.x, p.y)) wet += part * cap_share(p.z, d, *top, dimensions);
    if (!moving) continue;
    const Vec3d speed(g.velocity[i]);
    u += m * speed.x, v += m * speed.y, w += m * speed.z;
    fastest = std::max(fastest, norm(speed));
  }
  SlideState s;
  s.volume = volume, s.mass = mass, s.fastest = fastest;
  if (mass > 0.0) {
    s.centre = Vec3d{x, y, z} * (1.0 / mass);
    s.velocity = Vec3d{u, v, w} * (1.0 / mass);
    s.submerged = wet / volume;
  }
  return s;
}

namespace {

struct BodySums {
  double volume = 0.0, wet = 0.0;
  Vec3d moment;
};

// A triangle and the vertical prism below it: signed volume A_xy z, from the body's lowest point up.
void add_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c, double base, double piece, int depth,
                  const LevelAt& level, BodySums& sums) {
  const double edge = std::max({norm(b - a), norm(c - b), norm(a - c)});
  if (edge > piece && depth < 8) {
    const Vec3d ab = (a + b) * 0.5, bc = (b + c) * 0.5, ca = (c + a) * 0.5;
    add_triangle(a, ab, ca, base, piece, depth + 1, level, sums);
    add_triangle(ab, b, bc, base, piece, depth + 1, level, sums);
    add_triangle(ca, bc, c, base, piece, depth + 1, level, sums);
    add_triangle(ab, bc, ca, base, piece, depth + 1, level, sums);
    return;
  }
  const double area = 0.5 * ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
  const Vec3d m = (a + b + c) * (1.0 / 3.0);
  const double height = m.z - base;
  sums.volume += area * height;
  sums.moment += Vec3d{m.x, m.y, 0.5 * (m.z + base)} * (area * height);
  if (const auto top = level(m.x, m.y)) sums.wet += area * std::clamp(*top - base, 0.0, height);
}

}  // namespace

SlideState measure_body(const TriangleTable& body, double piece, const LevelAt& level) {
  SlideState s;
  if (body.triangle.empty()) return s;
  double base = body.vertex[0].z;
  for (const Vec3d& v : body.vertex) base = std::min(base, v.z);
  BodySums sums;
  for (const auto& t : body.triangle) {
    add_triangle(body.vertex[t.x], body.vertex[t.y], body.vertex[t.z], base, piece, 0, level, sums);
  }
  s.volume = sums.volume;
  if (sums.volume > 0.0) {
    s.centre = sums.moment * (1.0 / sums.volume);
    s.submerged = std::clamp(sums.wet / sums.volume, 0.0, 1.0);
  }
  return s;
}

}  // namespace gdesp::analysis
