// SPDX-License-Identifier: GPL-3.0-or-later
// Wall particles in even layers that follow the surface, instead of the stairs that the cubic lattice cuts into it: what slides
// along a slope feels stairs as friction.
//
// Layer k holds the depths k dp to (k + 1) dp. Each cell of the lattice has a volume in it, cut off by planes; going through the
// cells in order, a particle is born whenever their volumes have added up to another dp^dimensions: so every stretch of a layer has as many as it
// should, at any angle. A particle goes to the depth (k + 1/2) dp along the gradient of the distance to the surface, and then moves within that offset
// surface, driven by sum_j (1 - r/(2 dp))^2 r_ij/r over its neighbours of the layer and brought back to its depth after each step, until the layer is even.
// After Zhu, Zhang, Hu (2021), J. Hydrodyn. 33, 195, doi:10.1007/s42241-021-0031-y (relaxation bound to a surface), and Colagrossi, Bouscasse,
// Antuono, Marrone (2012), Comput. Phys. Commun. 183, 1641, doi:10.1016/j.cpc.2012.02.032 (packing). Volume of a cube below a plane: Scardovelli,
// Zaleski (2000), J. Comput. Phys. 164, 228, doi:10.1006/jcph.2000.6567.
#pragma once

#include <algorithm>
#include <vector>

#include "geometry/signed_distance.hpp"

namespace gdesp::geometry {

constexpr int boundary_layer_count = 3;
constexpr double fitted_band = 4.0;   ///< dp: half width of the band that fit_layers needs
constexpr double least_depth = 0.05;  ///< dp: a wall particle is never reported on or above the surface

/// m, below the surface: the particle of a band point, where its row stands (Lattice::place).
inline double placed_depth(const BandPoint& b, const Lattice& lattice) {
  return std::max(-b.distance - b.normal.z * lattice.shift(b.at.z), least_depth * lattice.dp);
}

struct LayerPoint {
  Vec3d position;  ///< m
  Vec3d normal;    ///< unit, into the fluid
  double depth;    ///< m
  std::int32_t material;
};

struct LayerRequest {
  const TriangleMesh* surface = nullptr;
  Lattice lattice;
  Box domain;                 ///< m: no particle lies outside
  std::vector<Vec3d> others;  ///< m: wall particles that stand already; these keep their distance
  std::vector<Vec3d> wet;     ///< m: water beside which walls stay on the lattice that it stands on,
  double wet_reach = 0.0;     ///< m: as far as this from it
};

/// Layers below the surface. `band`: signed distances on the lattice, half width fitted_band, in order. Where a wall is too thin or its edge
/// too sharp for a layer, its lattice points are particles. Deterministic for any number of threads.
std::vector<LayerPoint> fit_layers(const std::vector<BandPoint>& band, const LayerRequest& request);

/// Volume of the part of a unit cube about the origin with n . x <= level; n: unit.
double cube_below_plane(const Vec3d& n, double level);

}  // namespace gdesp::geometry
