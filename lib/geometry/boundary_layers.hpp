// SPDX-License-Identifier: GPL-3.0-or-later
// Wall particles in three layers of spacing dp below every surface (support 2.6 dp of the Wendland kernel with
// h = 1.3 dp), each with its depth below the true surface and the surface's normal.
#pragma once

#include "geometry/fitted_layers.hpp"
#include "geometry/scene_parts.hpp"
#include "geometry/signed_distance.hpp"
#include "geometry/solid_columns.hpp"
#include "particles/particle_tables.hpp"

namespace gdesp::geometry {

/// Layers of a tank's closed faces at depths dp/2, 3dp/2, 5dp/2 outside its inner box, edges and corners included;
/// along a face the points are fitted
/// between its edges, as the fluid of a box is. Points inside other tanks of the scene are left out.
void add_tank_layers(const SceneParts& parts, const Lattice& lattice, BoundaryTable& out);

/// Band points inside terrain, sheets and closed walls, deeper than 0 and up to three layers. Points in the solid of a
/// tank are left to its own layers.
void add_band_layers(const std::vector<BandPoint>& band, const SceneParts& parts, const Lattice& lattice,
                     BoundaryTable& out);

/// The same, in even layers along the surface (fitted_layers.hpp); what stands in `out` already keeps them at a distance.
void add_fitted_layers(const std::vector<BandPoint>& band, const SceneParts& parts, LayerRequest request,
                       BoundaryTable& out);

/// Particles of a body (box: its own lattice, fitted to its faces; mesh: the common lattice), up to three layers deep.
/// `endless`: axes along which a box repeats with the domain; it has no faces there.
/// Throws Error(input) when a mesh body is thinner than dp everywhere.
void add_body_layers(const SolidPart& body, std::int32_t number, const Lattice& lattice, const bool (&endless)[3],
                     BoundaryTable& out);

/// The closed faces of a tank, normals into the tank.
TriangleMesh tank_faces(const WallPart& tank);

}  // namespace gdesp::geometry
