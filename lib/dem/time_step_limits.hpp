// SPDX-License-Identifier: GPL-3.0-or-later
// @eq dem.time_step.rayleigh
//   T_R = pi R sqrt(rho / G) / (0.1631 nu + 0.8766)
//   T_R: time of a Rayleigh wave over half a grain [s]; R: radius [m]; rho: density [kg/m3]; G: shear modulus [Pa];
//   nu: Poisson ratio. A step is a share of it (0.1-0.3). Source: Li, Xu, Thornton (2005), Powder Technol. 160, 219,
//   doi:10.1016/j.powtec.2005.09.002, after Thornton & Randall (1988).
// @eq dem.time_step.linear
//   T_c = sqrt(pi^2 + ln^2 e) / sqrt(k / m*)
//   T_c: contact time [s] of the damped linear contact; k: stiffness [N/m]; m*: effective mass [kg]; e: restitution.
//   Source: Schafer, Dippel, Wolf (1996), J. Phys. I France 6, 5, doi:10.1051/jp1:1996129.
#pragma once

#include <cmath>

namespace gdesp::dem {

/// s; radius m, density kg/m3, Young's modulus Pa.
inline double rayleigh_time(double radius, double density, double youngs_modulus, double poisson_ratio) {
  const double shear_modulus = youngs_modulus / (2.0 * (1.0 + poisson_ratio));
  return 3.14159265358979324 * radius * std::sqrt(density / shear_modulus) / (0.1631 * poisson_ratio + 0.8766);
}

/// s; stiffness N/m, mass (m*) kg.
inline double linear_contact_time(double stiffness, double mass, double restitution) {
  const double logarithm = std::log(restitution);
  return std::sqrt((9.869604401089358 + logarithm * logarithm) * mass / stiffness);
}

}  // namespace gdesp::dem
