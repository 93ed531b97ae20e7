// SPDX-License-Identifier: GPL-3.0-or-later
// A packing that falls and comes to rest within its space before the run: the discrete element method does it (lib/dem), this
// brings the packing there and back, and measures what came of it.
#pragma once

#include <functional>

#include "geometry/sphere_packing.hpp"
#include "particles/particle_tables.hpp"
#include "particles/settlement.hpp"

namespace gdesp::geometry {

/// Lets grains (m, kg/m3; at rest) come to rest between walls (normals towards the grains). Whoever builds a case and has the solver gives it.
using GrainSettler = std::function<Settlement(GrainTable& grains, const TriangleTable& walls)>;

struct SettledBed {
  Settlement settlement;
  double fall = 0.0;  ///< m, mean of all grains
  double porosity =
      0.0;  ///< of the space below the grains' upper surface, seen by columns a third of the mean diameter apart
};

/// Settles the packing of a request. Grains that ended outside the space count as left out. Throws what the settler throws.
SettledBed settle_packing(const PackingRequest& request, double density, const GrainSettler& settler, Packing& packing);

}  // namespace gdesp::geometry
