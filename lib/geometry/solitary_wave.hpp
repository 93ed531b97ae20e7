// SPDX-License-Identifier: GPL-3.0-or-later
// @eq wave.solitary-piston
//   dX/dt = c eta/(d + eta),  eta = H sech^2(k (c (t - t0) - X)),  k = sqrt(3 H/(4 d^2 (d + H))),  c = sqrt(g (d + H))
//   X: displacement of a piston [m] that makes a solitary wave of height H [m] in water of depth d [m]; g: gravity [m/s2];
//   k: Rayleigh's outskirt decay [1/m]; c: speed of the wave [m/s]. t0 is taken so that eta(0) = 0.001 H. The stroke is
//   4 sqrt(H (H + d)/3). For H/d up to about 0.5. Source: Goring (1978), Caltech KH-R-38 (the piston follows the water);
//   Rayleigh's wave: Guizien and Barthelemy (2002), J. Hydraul. Res. 40, 321, doi:10.1080/00221680209499946.
#pragma once

#include <algorithm>
#include <cmath>

#include "particles/particle_tables.hpp"

namespace gdesp::geometry {

/// The motion, along the unit vector `along`, from time `start` (s), in steps of 1/400 of its duration.
inline PrescribedMotion solitary_wave_motion(double height, double depth, double gravity, const Vec3d& along,
                                             double start) {
  const double k = std::sqrt(3.0 * height / (4.0 * depth * depth * (depth + height)));
  const double c = std::sqrt(gravity * (depth + height));
  const double reach = std::acosh(std::sqrt(1000.0)) / k;  // m, from the crest to 0.001 H
  const double stroke = 4.0 * std::sqrt(height * (height + depth) / 3.0);
  const double duration = (2.0 * reach + stroke) / c, t0 = reach / c;
  const auto speed = [&](double t, double x) {
    const double s = 1.0 / std::cosh(k * (c * (t - t0) - x)), eta = height * s * s;
    return c * eta / (depth + eta);
  };
  PrescribedMotion motion;
  const int steps = 400, inner = 10;
  const double dt = duration / (steps * inner);
  double x = 0.0;
  for (int n = 0; n <= steps * inner; ++n) {
    const double t = n * dt;
    if (n % inner == 0) {
      motion.time.push_back(start + t);
      motion.displacement.push_back(along * x);
    }
    const double a = speed(t, x), b = speed(t + 0.5 * dt, x + 0.5 * dt * a), e = speed(t + 0.5 * dt, x + 0.5 * dt * b);
    x += dt / 6.0 * (a + 2.0 * b + 2.0 * e + speed(t + dt, x + dt * e));
  }
  return motion;
}

}  // namespace gdesp::geometry
