// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of a lake as a sheet over the ground, for pictures.
#pragma once

#include <cstdint>
#include <vector>

#include "analysis/measurement.hpp"

namespace gdesp::analysis {

struct WaterSheet {
  std::vector<Vec3d> vertex;                 ///< m, case coordinates
  std::vector<Vec3<std::int32_t>> triangle;  ///< upward by the right-hand rule
  std::vector<float> speed;                  ///< m/s, at the vertices; empty without velocities
};

/// The free surface of the connected water (free_surface.hpp) on a grid of spacing `cell` m, with the speed of the water half a
/// spacing below it. Particles end up to one spacing before the shore; so the sheet goes on at the level of its edge for
/// 3 dp more, where the ground, drawn with it, cuts it off at the shore. For pictures: nothing is measured on it.
WaterSheet make_water_sheet(FrameView& view, double cell);

}  // namespace gdesp::analysis
