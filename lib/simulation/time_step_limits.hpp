// SPDX-License-Identifier: GPL-3.0-or-later
// @eq time.fluid-step
//   dt = min( cfl h/(c + v_max), 0.25 sqrt(h/a_max), 0.125 h^2/nu ).
//   h: smoothing length [m]; c: sound speed, v_max: largest speed [m/s]; a_max: largest acceleration [m/s2];
//   nu: kinematic viscosity, the artificial one included [m2/s].
//   Source: Monaghan (1992), doi:10.1146/annurev.aa.30.090192.002551; Morris et al. (1997) for the viscous limit,
//   doi:10.1006/jcph.1997.5776.
#pragma once

#include <algorithm>
#include <cmath>

namespace gdesp {

/// Courant numbers that the schemes take unless told otherwise.
inline constexpr double split_default_cfl = 0.5, verlet_default_cfl = 0.2;

struct FluidStepLimit {
  double dt = 0.0;              ///< s
  const char* bound = "sound";  ///< which limit binds: sound, force, viscosity
};

inline FluidStepLimit fluid_step_limit(double cfl, double h, double sound_speed, double largest_speed,
                                       double largest_acceleration, double viscosity) {
  FluidStepLimit limit{cfl * h / (sound_speed + largest_speed), "sound"};
  const double force = largest_acceleration > 0.0 ? 0.25 * std::sqrt(h / largest_acceleration) : limit.dt;
  const double viscous = viscosity > 0.0 ? 0.125 * h * h / viscosity : limit.dt;
  if (force < limit.dt) limit = {force, "force"};
  if (viscous < limit.dt) limit = {viscous, "viscosity"};
  return limit;
}

}  // namespace gdesp
