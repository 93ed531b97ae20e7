// SPDX-License-Identifier: GPL-3.0-or-later
// A lake whose far part is columns, and the same lake all of particles, in the plane.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "../../support/tank.hpp"
#include "solitary_columns.hpp"

namespace gdesp::test {

struct LakeScene {
  double depth = 0.3, dp = 0.03;  ///< m
  double particles = 4.0;         ///< m of particles' water
  double columns = 0.0;           ///< m of columns behind it; 0: a wall
  double spacing = 0.2;           ///< of columns, over the depth
};

/// A wall, `layers` thick, whose face is at x; `side` 1: it stands to the right of its face.
inline void add_vertical_wall(SimulationInput& input, double x, double side, double height, double dp) {
  constexpr int layers = 4;
  input.boundary.body.resize(input.boundary.position.size(), 0);
  for (int i = 0; i < layers; ++i)
    for (int k = 0; k < static_cast<int>(std::lround(height / dp)); ++k) {
      input.boundary.position.push_back({x + side * (i + 0.5) * dp, 0.0, (k + 0.5) * dp});
      input.boundary.normal.push_back({static_cast<float>(-side), 0.0f, 0.0f});
      input.boundary.depth.push_back(static_cast<float>((i + 0.5) * dp));
    }
  input.boundary.body.resize(input.boundary.position.size(), static_cast<std::int32_t>(input.bodies.size() + 1));
}

/// Puts a far lake on the right of x (`side` 1) or on the left (-1).
inline void add_far_lake(SimulationInput& input, const LakeScene& scene, double x, double side) {
  add_vertical_wall(input, x, side, 2.0 * scene.depth, scene.dp);
  Body body;
  body.name = "far";
  body.kind = BodyKind::far_lake;
  body.far_lake = {scene.columns, scene.depth,
                   1.0,           static_cast<int>(std::lround(scene.columns / (scene.spacing * scene.depth))),
                   side,          x,
                   scene.depth};
  input.bodies.push_back(body);
}

/// Water at rest from x = 0 on; to the left of it a wall at rest, or room for a body.
inline SimulationInput lake(const LakeScene& scene, bool open_left = false) {
  const double dp = scene.dp, depth = scene.depth, room = 1.5 * depth;  // to where walls may go
  const double low = open_left ? -std::ceil(room / dp) * dp : 0.0;
  const double high = scene.particles + (scene.columns > 0.0 ? std::ceil(room / dp) * dp : 0.0);
  SimulationInput input = tank_input({high, 0.0, 2.0 * depth}, depth, dp, 2);
  input.boundary = {};
  wall_tank(input.boundary, {low, 0, 0}, {high, 0, 2.0 * depth}, dp, true);
  input.lower.x = low - 5 * dp;
  input.fluid_parameters.h = 1.5 * dp;
  input.fluid_parameters.artificial_viscosity = 0.05;
  input.fluid_parameters.skin = 0.0;
  fill_block(input.fluid, {0, 0, 0}, {scene.particles, 0, depth}, dp, true);
  if (scene.columns > 0.0) add_far_lake(input, scene, scene.particles, 1.0);
  return input;
}

/// Puts a solitary wave into the particles, its crest at x = `crest`, running to the right.
inline void add_solitary_wave(SimulationInput& input, const SolitaryWave& wave, double crest) {
  for (Vec3d& r : input.fluid.position) {
    const double x = r.x - crest, stretch = 1.0 + wave.rise(x) / wave.depth, u = wave.water_speed(x);
    r.z *= stretch;
    input.fluid.mass_share.push_back(static_cast<float>(stretch));
    const double slope = -2.0 * wave.k() * std::tanh(wave.k() * x) * wave.rise(x);
    input.fluid.velocity.push_back(
        {static_cast<float>(u), 0.0f,
         static_cast<float>(r.z * (wave.speed() - u) * -slope / (wave.depth + wave.rise(x)))});
  }
}

/// m3 a metre of width of the particles' water beyond x; a particle counts by the part of it that is.
inline double volume_beyond(const FluidTable& water, double x, double dp) {
  double volume = 0.0;
  for (std::size_t i = 0; i < water.position.size(); ++i) {
    const double share = water.mass_share.empty() ? 1.0 : static_cast<double>(water.mass_share[i]);
    volume += std::clamp((water.position[i].x - x) / dp + 0.5, 0.0, 1.0) * share * dp * dp;
  }
  return volume;
}

}  // namespace gdesp::test
