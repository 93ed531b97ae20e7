// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes of the benchmarks, made without files.
#pragma once

#include "bench.hpp"
#include "dem/grain_system.hpp"
#include "simulation/simulation.hpp"

namespace gdesp::bench {

inline constexpr double spacing = 0.01;         ///< m, of water particles
inline constexpr double grain_diameter = 0.01;  ///< m

/// n^3 particles of water with random offsets of up to 0.15 dp and small velocities.
FluidTable jittered_block(int n, double dp);

/// A dam break in the middle of its run: a cube of about `particles` of water in a closed tank three cubes long, walls
/// of three layers that know their surface, on a disturbed lattice, moving at up to sqrt(2 g H) as the front does, so
/// that lists go stale as often as they do then. Split scheme, artificial viscosity 0.05, density diffusion 0.1.
SimulationInput dam_break(long particles, double h_over_dp);

/// About `grains` grains at rest under their weight on a floor, 20 grains deep, periodic in x and y: one patch that
/// was let settle (mean of 5 contacts a grain with friction), repeated. `side` receives the period (m).
GrainTable settled_grains(long grains, double& side);
/// The floor under them.
TriangleTable floor_of(double side);
Domain layer_domain(double side, double height);
dem::ContactParameters glass_like();

/// A layer of those grains under water twice as deep, both moving over each other; about `particles` in all.
SimulationInput flooded_bed(long particles);

}  // namespace gdesp::bench
