// SPDX-License-Identifier: GPL-3.0-or-later
// From the host's table of grains to the state a system starts with, and the step its contacts allow.
#pragma once

#include "dem/contact_parameters.hpp"
#include "dem/grain_views.hpp"
#include "particles/particle_tables.hpp"

namespace gdesp::dem {

struct GrainStart {
  std::vector<FixedPosition> position;
  std::vector<std::uint32_t> id;
  std::vector<std::int32_t> group;
  std::vector<GrainRecord> record;
  std::vector<Vec3f> velocity, spin;
  double largest_radius = 0.0, smallest_radius = 0.0, mean_radius = 0.0;  ///< m; 1 without grains
  double mass = 0.0;                                                      ///< kg, of all
  float speed2 = 0.0f;
};

/// kg: of a sphere, or in two dimensions of a disc of unit length.
double grain_mass(double diameter, double density, int dimensions);

/// Throws Error(input) for a diameter or density that is not positive and for columns of different length.
GrainStart make_grain_start(const Domain& domain, const GrainTable& table);

/// s: the smallest Rayleigh time (hertz) or a quarter of the smallest contact time (linear, and discs) of the grains: the
/// same share of either gives steps of like accuracy, and keeps clear of instability with many contacts a grain.
double critical_time(const GrainStart& start, const ContactParameters& contact, const ContactLawSet& laws);

/// Throws Error(input) when grains are too large for exact separations within the domain's blocks.
void check_reach(const Domain& domain, double reach);

}  // namespace gdesp::dem
