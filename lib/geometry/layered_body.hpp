// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies given as a layer over a surface: polygon + thickness on the terrain, or between two surfaces.
#pragma once

#include "geometry/scene_parts.hpp"
#include "geometry/terrain_loader.hpp"

namespace gdesp::geometry {

/// A layer at grid nodes: lower surface (m) and thickness (m; 0 or NaN: none). `grid.z` is not used.
struct Layer {
  Heightfield grid;
  std::vector<double> bottom, thickness;
};

/// Closed, outward mesh of a layer; its volume is the sum of thickness times cell area, exactly. A ring of nodes
/// without thickness is added around the grid. Throws Error(input) naming `what` when it is empty everywhere.
TriangleMesh layer_mesh(const Layer& layer, const std::string& what);

/// Body of a shape that is layered (polygon + thickness, or surface_below + surface_above); lowers `terrain` where
/// the body lies in it (negative thickness: metres below the terrain; or a sliding surface below the terrain).
TriangleMesh layered_body(const Shape& shape, const std::string& name, const Scene& scene, TerrainSheet& terrain,
                          Notes& notes);

}  // namespace gdesp::geometry
