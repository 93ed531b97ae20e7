// SPDX-License-Identifier: GPL-3.0-or-later
// The lattice of nodes through which grains and water are averaged over each other (coupling.averaging).
#pragma once

#include <algorithm>
#include <cmath>

#include "coupling/averaging_spline.hpp"
#include "neighbors/cluster_set.hpp"

namespace gdesp::coupling {

/// The lattice: every tile of the domain holds the same whole number of nodes along each axis.
struct NodeLattice {
  Domain domain;
  Vec3<std::int32_t> count;  ///< nodes a tile, along each axis; 1 along y in the plane

  NodeLattice() = default;
  /// `spacing`: m, wanted; the nearest that divides a tile is taken.
  NodeLattice(const Domain& domain, double spacing);
  AveragingSpline spline() const;
  double spacing(int axis) const { return domain.tile_size[axis] / count[axis]; }  ///< m, between nodes
  /// m, along the axes that the scene has.
  double widest_spacing() const;
  double narrowest_spacing() const;
  /// m, beyond which a node has no weight.
  double reach() const { return static_cast<double>(spline_reach) * widest_spacing(); }
  GDESP_HD Index nodes_of_tile() const { return count.x * count.y * count.z; }
};

inline NodeLattice::NodeLattice(const Domain& domain_, double spacing) : domain(domain_) {
  for (int axis = 0; axis < 3; ++axis) {
    count[axis] = std::max(2, static_cast<std::int32_t>(std::lround(domain.tile_size[axis] / spacing)));
  }
  if (domain.dimensions == 2) count.y = 1;
}

inline AveragingSpline NodeLattice::spline() const {
  AveragingSpline spline{{}, 1.0f, domain.dimensions == 2};
  double volume = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    spline.inverse_spacing[axis] = static_cast<float>(1.0 / spacing(axis));
    if (axis != 1 || !spline.plane) volume *= spacing(axis);
  }
  spline.inverse_volume = static_cast<float>(1.0 / volume);
  return spline;
}

inline double NodeLattice::widest_spacing() const {
  const double plane = std::max(spacing(0), spacing(2));
  return domain.dimensions == 2 ? plane : std::max(plane, spacing(1));
}

inline double NodeLattice::narrowest_spacing() const {
  const double plane = std::min(spacing(0), spacing(2));
  return domain.dimensions == 2 ? plane : std::min(plane, spacing(1));
}

}  // namespace gdesp::coupling
