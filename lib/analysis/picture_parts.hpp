// SPDX-License-Identifier: GPL-3.0-or-later
// What stands in a picture (picture.hpp): ground, water, slide, as actors of a VTK renderer.
#pragma once

#include <vtkLookupTable.h>
#include <vtkRenderer.h>

#include "analysis/frame_source.hpp"

namespace gdesp::analysis {

constexpr int supersampling = 2;  ///< drawn larger, then averaged: smooth edges on every driver

struct PictureScene {
  vtkRenderer* renderer;
  const Frame& frame;
  const RunInfo& info;
  double vertical_exaggeration = 1.0;
  bool has_terrain() const { return !info.scene.terrain.files.empty() && info.dimensions == 3; }
};

/// Terrain: shaded and tinted by elevation, with contour lines, the still-water shore and a plinth.
/// Tank: its inner faces. Two dimensions: its outline.
void add_ground(const PictureScene& scene);
/// Water coloured by speed: a lake as a sheet over the ground and its splash as balls; in a tank the surface of its particles;
/// in two dimensions the particles. False when the frame carries no velocities.
bool add_water(const PictureScene& scene, vtkLookupTable* colours);
/// Grains as balls, bodies as triangles, in orange.
void add_slide(const PictureScene& scene);
/// From deep blue to yellow: dark to bright, whatever the reader's colour vision, and seen on any ground.
void fill_speed_colours(vtkLookupTable* table, double largest);

}  // namespace gdesp::analysis
