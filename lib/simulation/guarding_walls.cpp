// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulation/guarding_walls.hpp"

namespace gdesp {

BoundaryTable guarding_walls(const SimulationInput& input) {
  BoundaryTable walls = input.boundary;
  for (std::size_t w = 0; w < walls.body.size() && w < walls.normal.size(); ++w) {
    const std::int32_t number = walls.body[w];
    if (number > 0 && input.bodies[static_cast<std::size_t>(number - 1)].kind != BodyKind::prescribed)
      walls.normal[w] = {};
  }
  return walls;
}

}  // namespace gdesp
