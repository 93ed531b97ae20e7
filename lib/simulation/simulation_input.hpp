// SPDX-License-Identifier: GPL-3.0-or-later
// What a simulation is started from: plain tables and parameters, SI units, case coordinates. No file formats here.
#pragma once

#include <string>
#include <vector>

#include "coupling/drag_kinds.hpp"
#include "dem/contact_parameters.hpp"
#include "particles/particle_tables.hpp"
#include "sph/fluid_parameters.hpp"

namespace gdesp {

enum class TimeScheme {
  split,   ///< position Verlet: momentum at mid-step positions, continuity at the end (two light passes)
  verlet,  ///< velocity Verlet, eqs A.1-A.3 of the paper (one full pass)
};

struct CouplingParameters {
  bool enabled = true;
  coupling::Drag drag = coupling::Drag::di_felice;
  double smoothing_length = 0.0;      ///< m; 0: max(h, 2 d_max)
  double added_mass = 0.5;            ///< coefficient times displaced fluid mass
  std::vector<double> real_diameter;  ///< m per grain group, for drag; 0: the grain's own
};

struct TimeParameters {
  TimeScheme scheme = TimeScheme::split;
  double cfl = 0.0;               ///< 0: the scheme's own (split 0.5, verlet 0.2)
  double fixed_step = 0.0;        ///< s; > 0: no adaption
  bool multirate = true;          ///< grains sub-step inside the fluid's step
  double grain_step_share = 0.2;  ///< of the Rayleigh or contact time
};

struct SimulationInput {
  Vec3d lower, upper;  ///< m, the domain
  bool periodic[3] = {false, false, false};
  sph::FluidParameters fluid_parameters;
  FluidTable fluid;
  BoundaryTable boundary;
  GrainTable grains;
  dem::ContactParameters contact;
  std::vector<double> release_time;  ///< s per grain group
  TriangleTable walls;
  std::vector<Body> bodies;
  CouplingParameters coupling;
  TimeParameters time;
};

}  // namespace gdesp
