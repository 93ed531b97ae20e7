// SPDX-License-Identifier: GPL-3.0-or-later
// A picture of a case before it is run.
#pragma once

#include <string>

#include "io/case.hpp"

namespace gdesp::geometry {

/// Draws the case. *.png: plan view (ground, water depth, grains) and a vertical section through the water's and the slide's
/// middle, by gnuplot. *.vtp: all particles with a `kind` (0 fluid, 1 wall, 2 grain, 3 body) for ParaView. Throws Error(resource)
/// when gnuplot is missing or fails.
void write_preview(const Case& c, const std::string& path);

}  // namespace gdesp::geometry
