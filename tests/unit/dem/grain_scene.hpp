// SPDX-License-Identifier: GPL-3.0-or-later
// Small scenes of grains for the tests.
#pragma once

#include <cstdint>

#include "../../support/surfaces.hpp"
#include "dem/grain_system.hpp"

namespace gdesp::dem::test {

using gdesp::test::add_rectangle;
using gdesp::test::tank;
using Grains = GrainSystem<exec::OpenMP>;

/// A box of space (m) without walls; blocks 64 spacings wide.
inline Domain space(const Vec3d& lower, const Vec3d& upper, double spacing, int dimensions = 3) {
  const bool periodic[3] = {false, false, false};
  return make_domain(lower, upper, spacing, periodic, dimensions);
}

inline void add_grain(GrainTable& table, const Vec3d& position, double diameter, double density,
                      const Vec3d& velocity = {}, const Vec3d& spin = {}) {
  table.position.push_back(position);
  table.diameter.push_back(static_cast<float>(diameter));
  table.density.push_back(static_cast<float>(density));
  table.velocity.push_back(Vec3f(velocity));
  table.angular_velocity.push_back(Vec3f(spin));
}

/// kg, of a sphere.
inline double grain_mass_of(const GrainTable& t, std::size_t i) {
  const double d = t.diameter[i];
  return static_cast<double>(t.density[i]) * 3.14159265358979324 / 6.0 * d * d * d;
}

/// A floor at height z with cells of `mesh` metres, front upwards.
inline TriangleTable floor_mesh(double x0, double x1, double y0, double y1, double z, double mesh) {
  TriangleTable table;
  const int nx = static_cast<int>((x1 - x0) / mesh + 0.5), ny = static_cast<int>((y1 - y0) / mesh + 0.5);
  for (int i = 0; i <= nx; ++i) {
    for (int j = 0; j <= ny; ++j) table.vertex.push_back({x0 + i * mesh, y0 + j * mesh, z});
  }
  const auto at = [&](int i, int j) { return static_cast<std::int32_t>(i * (ny + 1) + j); };
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      table.triangle.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      table.triangle.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  table.body.assign(table.triangle.size(), 0);
  return table;
}

/// Numbers in [0, 1) that are the same everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15ull + 1) {}
  double operator()() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return static_cast<double>(state_ >> 11) * (1.0 / 9007199254740992.0);
  }

 private:
  std::uint64_t state_;
};

}  // namespace gdesp::dem::test
