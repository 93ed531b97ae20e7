// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/vec3.hpp"
#include "sph/activity_parameters.hpp"
#include "sph/pressure_and_viscosity_kinds.hpp"

namespace gdesp::sph {

/// Everything the fluid passes need to know, SI units.
struct FluidParameters {
  double dp = 0.0;                    ///< m, particle spacing
  double h = 0.0;                     ///< m, smoothing length
  double reference_density = 1000.0;  ///< kg/m3
  double sound_speed = 0.0;           ///< m/s
  Vec3d gravity{0.0, 0.0, -9.81};     ///< m/s2
  double kinematic_viscosity = 0.0;   ///< m2/s
  Viscosity viscosity = Viscosity::artificial;
  double artificial_viscosity = 0.02;
  double density_diffusion = 0.1;
  bool extrapolated_walls = true;  ///< else dynamic boundary particles
  bool paper_form = false;         ///< eqs 3 and 5 as the paper has them
  bool cavitates = true;           ///< no tension in water (sph.cavitation)
  bool tensile_control = false;    ///< tension, without clumping (sph.tensile-control); not with cavitates
  double shifting = 0.0;           ///< coefficient of sph.shifting; 0: none
  int dimensions = 3;
  double skin = 0.0;            ///< m, added to the support of the lists; 0: chosen from the motion
  double level = 0.0;           ///< m, still-water level for the hydrostatic start
  ActivityParameters activity;  ///< when still water sleeps
};

}  // namespace gdesp::sph
