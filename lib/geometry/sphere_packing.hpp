// SPDX-License-Identifier: GPL-3.0-or-later
// Grains in a solid at a stated porosity: positions are spread over the solid, then moved until no two grains and no
// grain and wall overlap (minimisation of the overlap energy with momentum, as in O'Hern et al. 2003,
// doi:10.1103/PhysRevE.68.011306). Random, without layers; the same for the same seed on any number of threads.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "geometry/columns.hpp"
#include "scene/scene.hpp"

namespace gdesp::geometry {

struct PackingRequest {
  /// Where grains may be, on columns of any grid (m).
  std::function<ColumnIntervals(const ColumnGrid&)> space;
  /// Per point, whether it lies there; for the last check.
  std::function<std::vector<bool>(const std::vector<Vec3d>&)> contains;
  TriangleMesh body;        ///< the closed body whose free part the space is
  TriangleMesh walls;       ///< every surface that bounds the space, its normals into the space
  Box box;                  ///< m, around the space
  double volume = 0.0;      ///< m3 (m2 in the plane), of the space; 0: space_volume() is asked
  std::string name;         ///< in messages
  double diameter = 0.0;    ///< m
  double deviation = 0.0;   ///< m, standard deviation of a normal distribution; cut at three
  double half_width = 0.0;  ///< m, of a uniform distribution (instead of a normal one)
  std::vector<DiameterClass> sieve;
  double porosity = 0.42;
  std::uint64_t seed = 1;
  int dimensions = 3;  ///< 2: discs in the plane y = 0
};

struct Packing {
  std::vector<Vec3d> position;   ///< m
  std::vector<float> diameter;   ///< m
  double volume = 0.0;           ///< m3 (m2), of the space
  double porosity = 0.0;         ///< reached, over the whole space
  double largest_overlap = 0.0;  ///< as a share of the smaller diameter; of grains with grains and walls
  int iterations = 0;
  std::size_t left_out = 0;  ///< grains that found no room
};

/// Throws Error(input) when not a single grain fits.
Packing pack_spheres(const PackingRequest& request);

/// As many spheres of the same diameters, spread over the space but not moved apart: what an estimate needs. Throws likewise.
Packing scatter_spheres(const PackingRequest& request);

/// m3 (m2): the part of the body's volume that is free, by columns; the body's own volume is known exactly.
double space_volume(const PackingRequest& request);
struct GrainSizes {
  double mean, smallest, largest;
};  ///< m
/// Of the distribution asked for: a sieve's mean is that of its first class.
GrainSizes grain_sizes(const PackingRequest& request);
/// The walls that grains feel: in the plane the faces towards y are none, they may be nearer than a disc's radius.
TriangleMesh bounding_walls(const PackingRequest& request);
/// Porosity and largest overlap of a packing as it is now.
void measure(const PackingRequest& request, Packing& packing);
/// m3, of a sphere; m2, of a disc.
double grain_volume(double diameter, int dimensions);

}  // namespace gdesp::geometry
