// SPDX-License-Identifier: GPL-3.0-or-later
// The surfaces of rigid bodies as contacts see them: points on one surface, nearest places of another. On the host.
#pragma once

#include <vector>

#include "dem/wall_mesh.hpp"

namespace gdesp::dem {

struct SurfacePoint {
  Vec3d place;        ///< m, case coordinates at the start
  double area = 0.0;  ///< m2 (two dimensions: m) of the surface that it stands for
};

/// Points on the surface of body `number`, at its vertices and about `spacing` (m) apart between them, each once. In two
/// dimensions those of its outline in the plane y = 0.
std::vector<SurfacePoint> surface_points(const TriangleTable& walls, std::int32_t number, double spacing,
                                         int dimensions);

/// The place of a surface nearest to a point.
struct NearestPlace {
  Index triangle = -1;    ///< -1: none
  double distance = 0.0;  ///< m, negative behind the surface
  Vec3d n;                ///< unit, out of the surface, towards the point when it is in front
};

/// Triangles of `body` within `reach` (m) of `point` (both in the coordinates of the start), sorted, added to `found`.
void triangles_near(const WallMesh& mesh, std::int32_t body, const Vec3d& point, double reach,
                    std::vector<Index>& found);

/// The nearest of some triangles. Of equally near ones the first.
NearestPlace nearest_place(const WallMesh& mesh, const Vec3d& point, const Index* triangle, Index count);

}  // namespace gdesp::dem
