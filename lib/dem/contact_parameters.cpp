// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem/contact_parameters.hpp"

#include <string>

#include "core/error.hpp"

namespace gdesp::dem {
namespace {

void require(bool valid, const char* name, double value, const char* unit, const char* range) {
  if (valid) return;
  throw Error(ErrorKind::input, std::string("contact.") + name + " = " + std::to_string(value) + " " + unit +
                                    " cannot be used; valid: " + range);
}

double or_else(double value, double other) { return value < 0.0 ? other : value; }

template <class Law>
ContactLaws<Law> laws(const Law& law, double friction, const ContactParameters& p) {
  return {law, static_cast<float>(friction), static_cast<float>(p.rolling_friction), static_cast<float>(p.cohesion)};
}

}  // namespace

void check_contact_parameters(const ContactParameters& p) {
  require(p.youngs_modulus > 0.0 && std::isfinite(p.youngs_modulus), "youngs_modulus", p.youngs_modulus, "Pa", "> 0");
  require(p.poisson_ratio >= 0.0 && p.poisson_ratio < 0.5, "poisson_ratio", p.poisson_ratio, "",
          "0 to 0.5, 0.5 excluded");
  require(p.wall_youngs_modulus >= 0.0, "wall_youngs_modulus", p.wall_youngs_modulus, "Pa",
          "0 (as the grains) or more");
  require(p.wall_poisson_ratio >= 0.0 && p.wall_poisson_ratio < 0.5, "wall_poisson_ratio", p.wall_poisson_ratio, "",
          "0 to 0.5, 0.5 excluded");
  require(p.stiffness > 0.0 && std::isfinite(p.stiffness), "stiffness", p.stiffness, "N/m", "> 0");
  require(p.stiffness_ratio > 0.0 && p.stiffness_ratio <= 1.0, "stiffness_ratio", p.stiffness_ratio, "",
          "above 0, to 1");
  require(p.restitution > 0.0 && p.restitution <= 1.0, "restitution", p.restitution, "", "above 0, to 1");
  require(p.wall_restitution != 0.0 && p.wall_restitution <= 1.0, "wall_restitution", p.wall_restitution, "",
          "above 0, to 1; negative: as restitution");
  require(p.friction >= 0.0, "friction", p.friction, "", "0 or more");
  require(p.rolling_friction >= 0.0, "rolling_friction", p.rolling_friction, "", "0 or more");
  require(p.cohesion >= 0.0, "cohesion", p.cohesion, "J/m2", "0 or more");
  require(p.skin >= 0.0 && p.skin <= 1.0, "skin", p.skin, "diameters", "0 (as pays best) to 1");
}

ContactLawSet make_contact_laws(const ContactParameters& p, int dimensions) {
  check_contact_parameters(p);
  const double e_grain = p.youngs_modulus, nu_grain = p.poisson_ratio;
  const double e_wall = p.wall_youngs_modulus > 0.0 ? p.wall_youngs_modulus : e_grain;
  const double nu_wall = p.wall_youngs_modulus > 0.0 ? p.wall_poisson_ratio : nu_grain;
  const double wall_friction = or_else(p.wall_friction, p.friction);
  const double wall_restitution = or_else(p.wall_restitution, p.restitution);
  const double e_pair = effective_modulus(e_grain, nu_grain, e_grain, nu_grain);
  const double g_pair = effective_shear_modulus(e_grain, nu_grain, e_grain, nu_grain);
  const double e_star_wall = effective_modulus(e_grain, nu_grain, e_wall, nu_wall);
  const double g_star_wall = effective_shear_modulus(e_grain, nu_grain, e_wall, nu_wall);
  ContactLawSet set;
  set.kind = dimensions == 2 ? ContactLawKind::linear : p.law;
  set.hertz = laws(make_hertz_mindlin(e_pair, g_pair, p.restitution), p.friction, p);
  set.hertz_wall = laws(make_hertz_mindlin(e_star_wall, g_star_wall, wall_restitution), wall_friction, p);
  const bool lines = p.law == ContactLawKind::hertz;
  const double k = lines ? line_contact_stiffness(e_pair) : p.stiffness;
  const double k_wall = lines ? line_contact_stiffness(e_star_wall) : p.stiffness;
  const double ratio = lines ? 4.0 * g_pair / e_pair : p.stiffness_ratio;
  const double ratio_wall = lines ? 4.0 * g_star_wall / e_star_wall : p.stiffness_ratio;
  set.linear = laws(make_linear_spring_dashpot(k, ratio, p.restitution), p.friction, p);
  set.linear_wall = laws(make_linear_spring_dashpot(k_wall, ratio_wall, wall_restitution), wall_friction, p);
  return set;
}

}  // namespace gdesp::dem
