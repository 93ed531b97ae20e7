// SPDX-License-Identifier: GPL-3.0-or-later
// Which grains and walls a grain can touch before it or a neighbour has moved by half a skin.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/packing_relaxation.hpp"

namespace gdesp::geometry {

class Vicinity {
 public:
  /// Partners are those whose gap, with the diameters enlarged by the factor `inflation`, is below the skin, a fifth of the largest diameter.
  Vicinity(const TriangleTree& walls, double largest_diameter, double inflation);

  /// Finds all partners anew.
  void renew(const PackingState& state);
  /// Whether a grain has moved so far since renew() that a partner may be missing.
  bool is_stale(const PackingState& state) const;

  std::vector<std::uint32_t> first, other;  ///< grains near grain i: other[first[i]] to other[first[i + 1] - 1]
  std::vector<std::uint32_t> first_wall;
  std::vector<std::int32_t> wall;  ///< triangles near grain i, likewise

 private:
  void find_pairs(const PackingState& state);
  void find_walls(const PackingState& state);

  const TriangleTree* walls_;
  double inflation_, skin_, reach_;  // reach_: m, between centres of the two largest grains
  std::vector<Vec3d> reference_;     // positions at renew()
};

}  // namespace gdesp::geometry
