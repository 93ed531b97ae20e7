// SPDX-License-Identifier: GPL-3.0-or-later
// Still water against walls that do not stand on its lattice: moved until the kernel's gradient sums to nothing.
//
//   dr_i = -b h^2 sum_j V0 grad W_ij   over water and walls, and over the empty lattice places above the surface
//
// Where that sum vanishes pressure of any height pushes nowhere, which is what keeps water still. Only water within a few dp of fitted
// walls moves, and towards open air not at all. Source: Colagrossi, Bouscasse, Antuono, Marrone (2012), Comput. Phys. Commun. 183, 1641,
// doi:10.1016/j.cpc.2012.02.032; kernel: sph.kernel.wendland-c2.
#pragma once

#include "geometry/water_fill.hpp"
#include "particles/particle_tables.hpp"

namespace gdesp::geometry {

/// Moves the water near the wall particles [first, last) of `boundary`; h: smoothing length (m). All wall particles count as neighbours.
/// Deterministic for any number of threads.
void relax_water(std::vector<Vec3d>& water, const BoundaryTable& boundary, std::size_t first, std::size_t last,
                 const FillSpace& space, double h);

}  // namespace gdesp::geometry
