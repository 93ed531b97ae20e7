// SPDX-License-Identifier: GPL-3.0-or-later
// Grains in a solid at a stated porosity: positions are spread over the solid, then moved until no two grains and no
// grain and wall overlap (minimisation of the overlap energy with momentum, as in O'Hern et al. 2003,
// doi:10.1103/PhysRevE.68.011306). Random, without layers; the same for the same seed on any number of threads.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "geometry/columns.hpp"
#include "scene/scene.hpp"

namespace gdesp::geometry {

struct PackingRequest {
  /// Where grains may be, on columns of any grid (m).
  std::function<ColumnIntervals(const ColumnGrid&)> space;
  /// Per point, whether it lies there; for the last check.
  std::function<std::vector<bool>(const std::vector<Vec3d>&)> contains;
  TriangleMesh body;               ///< the closed body whose free part the space is
  TriangleMesh walls;              ///< every surface that bounds the space, its normals into the space
  Box box;                         ///< m, around the space
  double diameter = 0.0;           ///< m
  double deviation = 0.0;          ///< m, standard deviation; cut at three
  std::vector<DiameterClass> sieve;
  double porosity = 0.42;
  std::uint64_t seed = 1;
  int dimensions = 3;              ///< 2: discs in the plane y = 0
};

struct Packing {
  std::vector<Vec3d> position;     ///< m
  std::vector<float> diameter;     ///< m
  double volume = 0.0;             ///< m3 (m2), of the space
  double porosity = 0.0;           ///< reached, over the whole space
  double largest_overlap = 0.0;    ///< as a share of the smaller diameter; of grains with grains and walls
  int iterations = 0;
  std::size_t left_out = 0;        ///< grains that found no room
};

/// Throws Error(input) when not a single grain fits.
Packing pack_spheres(const PackingRequest& request);

/// As many spheres of the same diameters, spread over the space but not moved apart: what an estimate needs. Throws likewise.
Packing scatter_spheres(const PackingRequest& request);

}  // namespace gdesp::geometry
