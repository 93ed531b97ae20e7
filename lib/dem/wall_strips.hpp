// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "particles/particle_tables.hpp"

namespace gdesp::dem {

/// The walls of a plane problem (x-z): each triangle of a surface extruded along y gives the segment that it shows in
/// the plane; equal segments count once (`weld`, m); each becomes a rectangle from -half_width to half_width (m)
/// along y. Triangles that face y are left out.
TriangleTable make_wall_strips(const TriangleTable& table, double weld, double half_width);

}  // namespace gdesp::dem
