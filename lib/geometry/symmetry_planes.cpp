// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/symmetry_planes.hpp"

#include <algorithm>
#include <cmath>

namespace gdesp::geometry {
namespace {

/// A face of a box: where along which axis, and the box grown by the tolerance.
struct Face {
  int axis;
  double place;  // m
  Box box;

  bool holds(const Vec3d& p, double tolerance) const {
    if (std::abs(p[axis] - place) > tolerance) return false;
    for (int a = 0; a < 3; ++a) {
      if (p[a] < box.lower[a] - tolerance || p[a] > box.upper[a] + tolerance) return false;
    }
    return true;
  }
};

std::vector<Face> symmetry_faces(const SceneParts& parts) {
  std::vector<Face> faces;
  for (const WallPart& wall : parts.walls) {
    for (int f = 0; f < 6; ++f) {
      if (!is_symmetry(wall, tank_face[f])) continue;
      faces.push_back({f / 2, (f % 2 ? wall.tank.upper : wall.tank.lower)[f / 2], wall.tank});
    }
  }
  return faces;
}

}  // namespace

bool is_symmetry(const WallPart& tank, const char* face) {
  return std::find(tank.symmetry.begin(), tank.symmetry.end(), face) != tank.symmetry.end();
}

void mark_symmetry_planes(const SceneParts& parts, double tolerance, TriangleTable& walls) {
  const std::vector<Face> faces = symmetry_faces(parts);
  if (faces.empty()) return;
  walls.smooth.assign(walls.triangle.size(), 0);
  for (std::size_t t = 0; t < walls.triangle.size(); ++t) {
    if (walls.body[t] != 0) continue;
    for (const Face& face : faces) {
      bool all = true;
      for (int k = 0; k < 3; ++k)
        all = all && face.holds(walls.vertex[static_cast<std::size_t>(walls.triangle[t][k])], tolerance);
      if (all) walls.smooth[t] = 1;
    }
  }
}

}  // namespace gdesp::geometry
