// SPDX-License-Identifier: GPL-3.0-or-later
// A packing of grains falls under gravity and comes to rest between walls, before the run.
#pragma once

#include "dem/contact_parameters.hpp"
#include "particles/particle_tables.hpp"
#include "particles/settlement.hpp"

namespace gdesp::dem {

struct SettlingConditions {
  ContactParameters contact;
  Vec3d gravity;  ///< m/s2
  int dimensions = 3;
};

/// Moves grains that start at rest until their root mean square speed stays below 0.001 sqrt(g d), d the mean diameter, for
/// sqrt(d / g); at most for ten times sqrt(2 H / g), H their height (at rest all the same when 95 of 100 are slower then: the
/// few that roll about between them are no unrest of the bed). Collisions restore half of the speed whatever the contact
/// says: the rest itself does not depend on it. Walls: closed around the grains, normals towards them, m.
/// On the processor; the same on any number of threads. Throws Error(input) without gravity and for contact parameters that
/// cannot be used, Error(numerical) when a grain's speed leaves any sensible range.
Settlement settle_grains(GrainTable& grains, const TriangleTable& walls, const SettlingConditions& conditions);

}  // namespace gdesp::dem
