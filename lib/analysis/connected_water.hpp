// SPDX-License-Identifier: GPL-3.0-or-later
// Which particles belong to the connected water, and which are splash.
//
// Definition (density-based clustering: Ester, Kriegel, Sander, Xu 1996, Proc. KDD-96, 226-231): two particles
// closer than `link` = 1.5 dp are neighbours; a particle with at least n_min neighbours is a core particle; core
// particles that are neighbours belong together, and a neighbour of a core particle belongs to its cluster.
// n_min = 3 in three dimensions, 1 in two: a sheet one particle thick is connected (4 neighbours on a square
// lattice, 3 at a corner), a thread of single particles (2) and a drop are not. The main body is made of the clusters that hold
// at least 5 % of the particles (a scene may have two lakes); everything else is splash.
// Where the frame carries densities, particles below 0.9 of the reference density are splash too: weakly compressible water
// holds its density within a few per cent, so these are torn off, whatever lies near them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/column_grid.hpp"

namespace gdesp::analysis {

struct ConnectivityRule {
  double link = 1.5;         ///< in dp
  double main_share = 0.05;  ///< of all particles, for a cluster to be part of the main body
  double torn_below = 0.9;   ///< of the reference density
};

struct ConnectedWater {
  std::vector<std::uint8_t> main;  ///< per particle (caller's order): 1 in the main body, 0 splash
  std::size_t main_count = 0;
  std::size_t bodies = 0;          ///< clusters that make the main body
  std::vector<std::uint8_t> torn;  ///< per particle (caller's order): 1 where its density makes it splash
};

/// `relative_density`: rho / rho_0 per particle in the caller's order, or empty. `grid`'s cell must be at least rule.link * dp.
/// Deterministic: does not depend on the number of threads.
ConnectedWater find_connected_water(const ColumnGrid& grid, double dp, const ConnectivityRule& rule = {},
                                    std::span<const float> relative_density = {});

}  // namespace gdesp::analysis
