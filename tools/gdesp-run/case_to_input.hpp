// SPDX-License-Identifier: GPL-3.0-or-later
// From a case, as files carry it, to what the solver starts from.
#pragma once

#include <string>

#include "io/case.hpp"
#include "simulation/simulation_input.hpp"

namespace gdesp::tool {

/// The largest speed that is expected, m/s, and what it comes from.
struct ExpectedSpeed {
  double speed = 0.0;
  std::string source;
};

/// numerics.expected_speed when it is given; else the largest of
///   water: sqrt(2 g H), H the height between its lowest and highest particle (a column that falls freely);
///   slides: sqrt(2 g drop), drop from the slide's mean height to the still-water level (without water: to the lowest
///     grain's depth below the mean), times 0.7 for grains (half the energy goes into friction on the way), at most
///     100 m/s, about the highest reported of any rock avalanche;
///   prescribed bodies other than gates: their own speed; initial velocities.
ExpectedSpeed expected_speed(const Case& c);

/// True when the scene's viscosity (morris) acts over less than 0.2 dp until the end, sqrt(nu t): particles cannot see
/// it, the run leaves it out (economy.viscosity).
bool viscosity_is_without_effect(const Scene& scene);

/// The contact of grains as the solver has it.
dem::ContactParameters contact_parameters(const Contact& contact);

/// Where contact.youngs_modulus is 0 (open), sets what contact_softness() proposes for grains that have a weight; else 10 MPa.
/// Needs the input's grains, gravity and dimensions; expected_speed (m/s): of impacts.
void choose_youngs_modulus(SimulationInput& input, double expected_speed);

/// Everything the solver needs. Lengths and times as in the scene; the sound speed is numerics.sound_speed or ten
/// times the expected speed (density errors below about 1 %, Monaghan 1994, doi:10.1006/jcph.1994.1034).
/// The particle tables are moved out of `c`. Throws Error(input) for an option the solver does not have.
SimulationInput case_to_input(Case& c);

}  // namespace gdesp::tool
