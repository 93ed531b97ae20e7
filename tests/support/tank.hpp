// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes for tests, made without files: a box tank with three layers of wall particles, blocks of water.
#pragma once

#include <algorithm>
#include <cmath>

#include "particles/surface_rows.hpp"
#include "simulation/simulation.hpp"
#include "sph/fluid_system.hpp"
#include "sph/tait.hpp"

namespace gdesp::test {

/// Water on the lattice dp inside [low, high]; two dimensions: low.y = high.y = 0.
inline void fill_block(FluidTable& fluid, const Vec3d& low, const Vec3d& high, double dp, bool two_dimensional) {
  const auto count = [&](double a, double b) { return static_cast<int>(std::lround((b - a) / dp)); };
  const int nx = count(low.x, high.x), ny = two_dimensional ? 1 : count(low.y, high.y), nz = count(low.z, high.z);
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k)
        fluid.position.push_back(
            {low.x + (i + 0.5) * dp, two_dimensional ? 0.0 : low.y + (j + 0.5) * dp, low.z + (k + 0.5) * dp});
}

/// Wall particle at r outside [low, high], with its normal and its depth below the nearest point of that box (open at the top).
inline void add_tank_wall(BoundaryTable& walls, const Vec3d& r, const Vec3d& low, const Vec3d& high) {
  const Vec3d to_surface{std::clamp(r.x, low.x, high.x) - r.x, std::clamp(r.y, low.y, high.y) - r.y,
                         std::max(r.z, low.z) - r.z};
  const double depth = norm(to_surface);
  walls.position.push_back(r);
  walls.normal.push_back(static_cast<Vec3f>(to_surface * (1.0 / depth)));
  walls.depth.push_back(static_cast<float>(depth));
}

/// Wall particles in three layers around the inside [low, high] of a tank that is open at the top.
inline void wall_tank(BoundaryTable& walls, const Vec3d& low, const Vec3d& high, double dp, bool two_dimensional) {
  const auto count = [&](double a, double b) { return static_cast<int>(std::lround((b - a) / dp)); };
  const int nx = count(low.x, high.x), ny = two_dimensional ? 1 : count(low.y, high.y), nz = count(low.z, high.z);
  const int layers = 3;
  for (int i = -layers; i < nx + layers; ++i)
    for (int j = two_dimensional ? 0 : -layers; j < (two_dimensional ? 1 : ny + layers); ++j)
      for (int k = -layers; k < nz; ++k) {
        const bool inside = i >= 0 && i < nx && j >= 0 && j < ny && k >= 0;
        if (inside) continue;
        add_tank_wall(walls,
                      {low.x + (i + 0.5) * dp, two_dimensional ? 0.0 : low.y + (j + 0.5) * dp, low.z + (k + 0.5) * dp},
                      low, high);
      }
}

/// A tank [0, size] with default parameters for water depth `depth` (sound speed 10 sqrt(2 g depth)).
inline SimulationInput tank_input(const Vec3d& size, double depth, double dp, int dimensions) {
  SimulationInput input;
  input.lower = {-5 * dp, dimensions == 2 ? -dp : -5 * dp, -5 * dp};
  input.upper = {size.x + 5 * dp, dimensions == 2 ? dp : size.y + 5 * dp, size.z + 20 * dp};
  auto& p = input.fluid_parameters;
  p.dp = dp;
  p.h = 1.3 * dp;
  p.dimensions = dimensions;
  p.sound_speed = 10.0 * std::sqrt(2.0 * 9.81 * depth);
  p.kinematic_viscosity = 1.0e-6;
  p.skin = 0.15 * p.h;
  wall_tank(input.boundary, {}, size, dp, dimensions == 2);
  return input;
}

/// Brings the rows of still water below z = depth, and the walls beside them, to where they rest (sph.surface-rows), with their pressures.
inline void rest_rows(SimulationInput& input, double depth) {
  const auto& p = input.fluid_parameters;
  const std::vector<double> shift = surface_row_shifts(p.h / p.dp, p.dimensions);
  for (auto* list : {&input.fluid.position, &input.boundary.position}) {
    for (Vec3d& r : *list) {
      const long row = std::lround((depth - r.z) / p.dp - 0.5);
      if (row >= 0 && row < static_cast<long>(shift.size())) r.z += shift[static_cast<std::size_t>(row)] * p.dp;
    }
  }
  for (const Vec3d& r : input.fluid.position) {
    const double A = norm(p.gravity) * (depth - r.z) / (p.sound_speed * p.sound_speed);
    input.fluid.density.push_back(
        static_cast<float>(p.reference_density * (1.0 + sph::tait_density(static_cast<float>(A)))));
  }
}

/// What the passes wrote, in the order of ids.
struct Rates {
  Vec3d acceleration;
  double dD = 0.0;
};
inline std::vector<Rates> rates_by_id(const sph::FluidSystem<exec::OpenMP>& fluid) {
  std::vector<Rates> rates(static_cast<std::size_t>(fluid.particles()));
  for (Index s = 0; s < fluid.slots(); ++s) {
    const std::uint32_t id = fluid.ids()[s];
    if (id == no_particle) continue;
    const float* r = fluid.rates() + 16 * (s / 4) + s % 4;
    rates[id] = {{static_cast<double>(r[0]), static_cast<double>(r[4]), static_cast<double>(r[8])},
                 static_cast<double>(r[12])};
  }
  return rates;
}

}  // namespace gdesp::test
