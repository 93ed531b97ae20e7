// SPDX-License-Identifier: GPL-3.0-or-later
// Walls as grains meet them: triangles with what tells whether a grain touches a face, an edge or a vertex, and a
// tree of boxes to find the triangles near a point. Made once, on the host; each body has its own tree, in the
// coordinates of its start (it moves rigidly, so the tree stays valid).
#pragma once

#include <vector>

#include "exec/backend.hpp"
#include "particles/particle_tables.hpp"

namespace gdesp::dem {

using exec::Index;

/// Directions of one triangle: unit normal n and, for edge k from vertex k to vertex k + 1, the unit vector m_k in
/// its plane that points inside; edge direction t_k = m_k x n; length of edge k.
struct alignas(64) TriangleFrame {
  Vec3f n;
  float length_0;
  Vec3f m_0;
  float length_1;
  Vec3f m_1;
  float length_2;
  Vec3f m_2;
  std::int32_t body;
};
static_assert(sizeof(TriangleFrame) == 64);

/// What is beyond an edge: m of the neighbour at this edge, and n + n of the neighbour. open: no single neighbour.
struct EdgeSide {
  Vec3f neighbour_inside;
  Vec3f outward;
  std::int32_t open = 1;
};

/// Unit directions of the edges that leave a vertex: ring[begin .. end); outward: sum of the normals around it by angle.
struct VertexRing {
  Index begin = 0, end = 0;
  Vec3f outward;
  std::int32_t open = 0;  ///< on the rim of an open surface
};

/// A box of the tree; leaves hold triangles [first, first + count), inner nodes have children at first and first + 1.
struct WallNode {
  Vec3f lower, upper;  ///< m, body coordinates relative to the body's middle, widened for rounding
  Index first = 0, count = 0;
};

/// Triangle corners in double precision, for exact distances when lists are made.
struct TriangleCorners {
  Vec3d a, b, c;  ///< m, case coordinates at the start
};

struct WallBody {
  Index root = -1;     ///< node, or -1 without triangles
  Vec3d middle;        ///< m
  double reach = 0.0;  ///< m, from `middle` to the farthest corner
};

struct WallMesh {
  std::vector<TriangleFrame> frame;
  std::vector<TriangleCorners> corners;
  std::vector<EdgeSide> edge;              ///< 3 a triangle
  std::vector<Vec3<std::int32_t>> vertex;  ///< of a triangle
  std::vector<std::int32_t> smooth;        ///< 1: the triangle has no friction
  std::vector<VertexRing> ring_of;         ///< of a vertex
  std::vector<Vec3f> ring;
  std::vector<WallNode> node;
  std::vector<WallBody> body;  ///< 0: at rest; k: bodies[k - 1]
};

/// Two corners nearer than `weld` (m) are one vertex; triangles without area are left out. In two dimensions the
/// surface must be extruded along y: what faces y is left out, the rest becomes strips `half_width` (m) to each side.
/// Throws Error(input) when a triangle names a vertex that does not exist.
WallMesh make_wall_mesh(const TriangleTable& table, double weld, int dimensions, double half_width);

}  // namespace gdesp::dem
