// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene would become, without building it: counts, memory, steps.
#pragma once

#include "geometry/case_builder.hpp"

namespace gdesp::geometry {

struct CaseEstimate {
  std::size_t fluid = 0, boundary = 0, grains = 0, triangles = 0, bodies = 0;
  Vec3d size;                       ///< m, of the domain
  double disk_bytes = 0.0, memory_bytes = 0.0;
  double largest_speed = 0.0;       ///< m/s: sqrt(2 g H) over the height water and slides can fall, or as set
  double sound_speed = 0.0;         ///< m/s
  double fluid_step = 0.0, grain_step = 0.0;   ///< s
  double fluid_steps = 0.0, particle_steps = 0.0;
  std::vector<std::string> models;  ///< which models are on, and why
  Notes notes;
};

/// Counts fluid and walls exactly; grains from volume and porosity. Throws like build_case.
CaseEstimate estimate_case(const Scene& scene);

}  // namespace gdesp::geometry
