// SPDX-License-Identifier: GPL-3.0-or-later
// A surface of triangles in double precision, and the few operations on it that need no library.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec3.hpp"
#include "scene/scene.hpp"

namespace gdesp::geometry {

using Triangle = Vec3<std::int32_t>;

/// Vertices (m) and triangles (indices). Outward normal by the right-hand rule.
struct TriangleMesh {
  std::vector<Vec3d> vertex;
  std::vector<Triangle> triangle;
  bool empty() const { return triangle.empty(); }
};

/// Mass, centre and inertia of a closed mesh.
struct MassProperties {
  double volume = 0.0;                          ///< m3
  Vec3d centre;                                 ///< m
  std::array<double, 9> inertia_per_density{};  ///< m5, about the centre, row by row
};

/// Axis-aligned bounds; lower > upper when there are no vertices.
Box bounds(const TriangleMesh& mesh);
Box empty_box();
void extend(Box& box, const Vec3d& point);
void include(Box& box, const Box& other);
bool is_empty(const Box& box);
Vec3d extent(const Box& box);

/// Volume (m3) enclosed by a closed mesh, positive when the normals point outward.
double signed_volume(const TriangleMesh& mesh);
/// Surface area (m2).
double surface_area(const TriangleMesh& mesh);
/// Volume, centre, inertia of a closed outward mesh by exact integration over its tetrahedra to the origin
/// (Tonon 2004, doi:10.3844/jmssp.2005.8.11: explicit tetrahedron inertia).
MassProperties mass_properties(const TriangleMesh& mesh);

/// Closed box of twelve triangles, normals outward.
TriangleMesh box_mesh(const Box& box);
/// v -> v * scale + shift.
void transform(TriangleMesh& mesh, const Vec3d& scale, const Vec3d& shift);
void append(TriangleMesh& mesh, const TriangleMesh& other);
/// Keeps only triangles whose bounds meet `box`; drops vertices no longer used.
TriangleMesh crop(const TriangleMesh& mesh, const Box& box);
/// Swaps two corners of every triangle.
void flip(TriangleMesh& mesh);
/// Number of edges that belong to one triangle only (0 for a closed mesh).
std::size_t border_edges(const TriangleMesh& mesh);

}  // namespace gdesp::geometry
