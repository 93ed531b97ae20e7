// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of the contact laws, and the laws made of them.
#pragma once

#include <limits>

#include "dem/contact_force.hpp"

namespace gdesp::dem {

enum class ContactLawKind { hertz, linear };

/// Contact of grains with each other and with walls. SI units.
struct ContactParameters {
  ContactLawKind law = ContactLawKind::hertz;
  double youngs_modulus = 1.0e7;  ///< Pa, hertz
  double poisson_ratio = 0.3;
  double wall_youngs_modulus = 0.0;    ///< Pa; 0: as the grains; infinity: rigid walls
  double wall_poisson_ratio = 0.3;     ///< used when wall_youngs_modulus > 0
  double stiffness = 1000.0;           ///< N/m, linear
  double stiffness_ratio = 2.0 / 7.0;  ///< tangential / normal, linear
  double restitution = 0.5;            ///< (0, 1]
  double wall_restitution = -1.0;      ///< < 0: as restitution
  double friction = 0.5;
  double wall_friction = -1.0;    ///< < 0: as friction
  double rolling_friction = 0.0;  ///< 0: no rolling resistance
  double cohesion = 0.0;          ///< J/m2, work of adhesion
  double skin = 0.0;              ///< of the mean diameter: how far lists reach beyond contact; 0: as pays best
};

/// The laws of grain-grain and grain-wall contacts; only those of `kind` are set.
struct ContactLawSet {
  ContactLawKind kind = ContactLawKind::hertz;
  ContactLaws<HertzMindlin> hertz, hertz_wall;
  ContactLaws<LinearSpringDashpot> linear, linear_wall;
};

/// Throws Error(input) naming the parameter, the value and what is valid.
void check_contact_parameters(const ContactParameters& parameters);
/// In two dimensions `hertz` means the line contact of rods, which is linear (dem.line.normal).
ContactLawSet make_contact_laws(const ContactParameters& parameters, int dimensions);

}  // namespace gdesp::dem
