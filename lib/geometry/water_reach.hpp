// SPDX-License-Identifier: GPL-3.0-or-later
// Where water can come to, and wall particles are therefore needed.
//
// The rule: water that starts no higher than z0 and is nowhere faster than v has, at each place, a head z + v^2/2g of at most
// E = z0 + v^2/2g (Bernoulli). It can stand on no ground above E, and it can come to a lower place only over ground that lies
// below E all the way. So the reach is every column with open space below E that is joined to the water at the start through
// such columns (eight neighbours each): down any valley to the edge of the domain, up any slope to E, never across a ridge
// higher than E. v is the largest speed the run is made for; a run in which water is faster is no longer valid and is
// stopped for that reason. Gates and bodies count as open: they may go away.
#pragma once

#include <optional>
#include <vector>

#include "geometry/signed_distance.hpp"
#include "geometry/water_fill.hpp"

namespace gdesp::geometry {

struct WaterReach {
  double head = 0.0;  ///< m, E: no wall particles where the ground is higher
  std::vector<bool>
      column;          ///< per column of the fill space: within reach, or nearer to the reach than the walls are thick
  double share = 1.0;  ///< of the columns that have ground
};

/// Height to which water climbs at the scene's largest expected speed (m): v^2/2g with v = numerics.expected_speed, or without it
/// the largest of sqrt(2 g depth), 0.7 sqrt(2 g fall) with the fall of the highest slide to the water's deepest point, and the speeds of
/// slides at the start and of prescribed bodies.
double default_run_up(const Scene& scene, const SceneParts& parts, const std::vector<Vec3d>& water);

/// nullopt when there is no water (nothing is left out then). `walls`: what stands still, on the space's columns; `run_up`: m
/// above the highest water.
std::optional<WaterReach> reach_of_water(const FillSpace& space, const ColumnIntervals& walls,
                                         const std::vector<Vec3d>& water, double run_up);

/// The triangles that have a column within reach under or over them.
WallSurfaces within_reach(const WallSurfaces& walls, const WaterReach& reach, const FillSpace& space);

}  // namespace gdesp::geometry
