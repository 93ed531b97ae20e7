// SPDX-License-Identifier: GPL-3.0-or-later
// A granular slide: its space, its packing, its table.
#pragma once

#include "geometry/case_builder.hpp"

namespace gdesp::geometry {

/// Packs slide `index` of the layout (counts_only: spreads its grains) and appends them. Warnings go to `notes`. Throws Error(usage)
/// when the slide is to settle and `how` has no settler.
SlideReport add_granular_slide(const Layout& layout, std::size_t index, const BuildOptions& how, GrainTable& grains,
                               Notes& notes);

/// Volume (m3, m2 in 2D) of a body outside the solids at rest, its own volume times the free share seen by 800 columns along its side.
double free_volume(const Layout& layout, const SolidPart& body);

}  // namespace gdesp::geometry
