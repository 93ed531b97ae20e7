// SPDX-License-Identifier: GPL-3.0-or-later
// Moving spheres apart until none overlap: the inner loop of sphere_packing.
#pragma once

#include <functional>
#include <vector>

#include "geometry/triangle_tree.hpp"

namespace gdesp::geometry {

/// Overlaps below this share of the diameter count as none.
constexpr double packing_overlap = 1e-3;
constexpr std::size_t worth_threads = 4000;  ///< grains; fewer are moved by one thread

struct PackingState {
  std::vector<Vec3d> position;  ///< m
  std::vector<float> diameter;  ///< m
  int dimensions = 3;           ///< 2: y stays 0
};

/// Moves grains until the largest overlap is below packing_overlap; where there is no room for all, the tightest grains are
/// taken out. Returns the number of iterations. Deterministic for any number of threads.
int relax_overlaps(PackingState& state, const TriangleTree& walls, double largest_diameter);

/// Takes out grains whose centre is not in the space or that cut a wall by more than packing_overlap.
void drop_misplaced(PackingState& state, const TriangleTree& walls,
                    const std::function<std::vector<bool>(const std::vector<Vec3d>&)>& contains,
                    double largest_diameter);

/// The largest overlap of two grains, or of a grain and a wall, as a share of the (smaller) diameter.
double largest_overlap(const PackingState& state, const TriangleTree& walls, double largest_diameter);

}  // namespace gdesp::geometry
