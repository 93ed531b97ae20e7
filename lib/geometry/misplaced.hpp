// SPDX-License-Identifier: GPL-3.0-or-later
// What lies where it cannot be meant: another coordinate system, another unit, a slip of the pen. Messages in the scene's own coordinates.
#pragma once

#include "geometry/case_builder.hpp"

namespace gdesp::geometry {

/// "x 1911388 m to 1918588 m, y ..." of a box in case coordinates; `heights`: z too.
std::string span_text(const Box& box, const Vec3d& offset, bool heights = false);

/// Warns of gauges, sections and regions that lie outside the domain.
void warn_of_measures_outside(const Layout& layout, Notes& notes);

/// Names the gauges inside the domain that no particle of the water at the start (places in case coordinates, m) stands under: on
/// dry ground, or where the water is too shallow for this spacing.
void name_dry_gauges(const Layout& layout, const std::vector<Vec3d>& water, Notes& notes);

/// Throws Error(input) when a slide lies outside the terrain in plan, saying where both are: before anything is made of the scene.
void refuse_slides_elsewhere(const Layout& layout);

/// Throws Error(input) when a slide reaches out of the domain along an axis along which that repeats: it would lie in itself.
void refuse_slides_beyond_a_period(const Layout& layout);

/// A slide has `free` of its volume `whole` (m3, m2 in the plane) outside terrain, walls and bodies. Throws Error(input) when that
/// is nothing; warns when a fiftieth or more is missing.
void check_room(const Layout& layout, std::size_t slide, double free, double whole, Notes& notes);

/// ", ..." to be added to what is said of water that nothing holds: that the level stands above nearly all of the ground; empty otherwise.
std::string level_hint(const FillSpace& space, double level);

}  // namespace gdesp::geometry
