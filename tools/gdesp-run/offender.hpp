// SPDX-License-Identifier: GPL-3.0-or-later
// Which particle it was: searched in the tables of a simulation that is in trouble.
#pragma once

#include <optional>
#include <string>

#include "guard.hpp"

namespace gdesp::tool {

struct Offender {
  bool is_grain = false;
  std::uint32_t id = 0;
  std::string value;  ///< what is wrong with it, with units
  bool has_place = false;
  Vec3d place;  ///< m, case coordinates
};

/// The particle that shows the trouble most; nullopt when none can be named.
std::optional<Offender> find_offender(Simulation& simulation, const Trouble& trouble, double reference_density);

/// Where the particle is in `simulation` (m, case coordinates); nullopt when it is not there.
std::optional<Vec3d> place_of(Simulation& simulation, const Offender& offender);

/// "water particle 12 at (1, 2, 3) m, 340 m/s": `offset` (m) leads to the scene's own coordinates.
std::string offender_text(const Offender& offender, const Vec3d& offset);

}  // namespace gdesp::tool
