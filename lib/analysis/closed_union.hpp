// SPDX-License-Identifier: GPL-3.0-or-later
// What a set of particles looks like from outside: their balls' union, closed, as a signed distance on voxels.
//
// Every particle is a ball of radius R. D(x) is the signed distance to the surface of their union, negative within:
// outside the least distance to a particle less R (exact), within the least distance to a point where the surface crosses
// an edge between two voxels. Moved inwards by s < R,
//   F(x) = mean of D over the 3 x 3 x 3 voxels around x, + s
// this is a closing (J. Serra 1982, Image Analysis and Mathematical Morphology, Academic Press): particles up to 2R
// apart are joined, and the surface F = 0 lies about R - s outside the outermost particles.
//
// Computed in tiles of 8 x 8 x 8 voxels, all of them in parallel: tiles wholly within the union are known after one
// look at the balls that reach them; distances are computed in the others and in their neighbours only.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.hpp"

namespace gdesp::analysis {

struct ClosingOptions {
  double voxel = 0.0;       ///< m
  double radius = 0.0;      ///< R, m
  double inwards = 0.0;     ///< s, m
  double half_width = 3.0;  ///< of the band around F = 0 in which F is known, voxels
};

/// F on 8 x 8 x 8 voxels, m, cut off at +-half_width voxels. Voxel (i, j, k) has its centre at voxel * (i, j, k) and
/// its value at 64 (i - first.x) + 8 (j - first.y) + k - first.z.
struct VoxelTile {
  Vec3<std::int32_t> first;  ///< multiples of 8
  std::array<float, 512> value;
};

/// The tiles that hold a value inside the band; the same for any number of threads. `position`: m. Throws
/// Error(numerical) on a position that is not finite or further than 2^22 voxels from the origin.
std::vector<VoxelTile> closed_union(std::span<const Vec3d> position, const ClosingOptions& options);

}  // namespace gdesp::analysis
