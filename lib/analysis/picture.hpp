// SPDX-License-Identifier: GPL-3.0-or-later
// One picture of a run in three dimensions: terrain shaded, water coloured by speed, the slide in a colour of its own.
// Drawn by VTK, which in Debian needs an X display (the tool starts itself again under xvfb-run where there is none).
#pragma once

#include <optional>
#include <string>

#include "analysis/frame_source.hpp"

namespace gdesp::analysis {

struct PictureOptions {
  int width = 1600, height = 900;  ///< pixels
  std::optional<double> azimuth;   ///< degrees clockwise from +y (north) to where the camera stands; default: chosen
  double elevation = 44.0;         ///< degrees above the horizontal
  double zoom = 1.0;
  double speed_max = 0.0;  ///< m/s, end of the colour scale; 0: 99th percentile of the water's speed
  double vertical_exaggeration = 1.0;
  std::string title;  ///< default: the scene's title, or the run's name
};

/// Draws one frame to a PNG, written aside and renamed. Needs a display. Throws Error(resource).
void draw_picture(const Frame& frame, const RunInfo& info, const PictureOptions& options, const std::string& path);

}  // namespace gdesp::analysis
