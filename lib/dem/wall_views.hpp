// SPDX-License-Identifier: GPL-3.0-or-later
// Grains near walls as kernels see them.
#pragma once

#include "dem/contact_force.hpp"
#include "dem/grain_views.hpp"
#include "dem/wall_mesh.hpp"

namespace gdesp::dem {

/// A body at one moment, against where it was when the lists were made. World vectors w become body vectors R^T w.
struct BodyPose {
  float to_body[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< R^T now, row by row
  float turned[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};   ///< R^T(now) R(listed) - 1
  Vec3f shift;                                     ///< m, centre now - centre listed
  Vec3f velocity, spin;                            ///< m/s, rad/s
  std::int32_t present = 1;
};

/// Eight triangles near one grain. All is relative to the place of the grain when the lists were made, in the axes of
/// the body: with u the displacement since, height = n.u + h, depth inside edge k = m_k.u + inside[k], place along
/// edge k = t_k.u + along[k]. Rounding is that of the grain's surroundings, however large the triangle.
struct alignas(32) WallRow {
  Index triangle[8];
  std::int32_t body[8];
  float height[8];
  float inside[3][8];
  float along[3][8];
  std::int32_t moving;  ///< some triangle belongs to a body
};
/// Of the same triangles: m, grain - centre of the body, body axes. There are none when there are no bodies.
struct alignas(32) WallLever {
  float x[8], y[8], z[8];
};
inline constexpr float far_height = 1.0e30f;

/// What the eight lanes find: the vector from the wall to the grain's centre (body axes, m) and where on the triangle
/// the nearest point lies: 0 nothing in reach, 1 face, 2 + k edge k, 5 + k vertex k.
struct alignas(32) WallGap {
  float x[8], y[8], z[8], height[8];
  std::int32_t feature[8];
};

/// One contact of a grain with a wall, remembered.
struct WallContact {
  Vec3f n;           ///< unit, into the grain
  Vec3f tangential;  ///< N, history
  Vec3f rolling;     ///< N m, history
  std::int32_t body = 0;
};
inline constexpr int wall_contact_limit = 8;
struct WallHistory {
  WallContact contact[wall_contact_limit];
  std::int32_t count = 0;
};

/// The mesh as kernels see it.
struct WallMeshView {
  const TriangleFrame* frame;
  const TriangleCorners* corners;
  const EdgeSide* edge;
  const Vec3<std::int32_t>* vertex;
  const std::int32_t* smooth;
  const VertexRing* ring_of;
  const Vec3f* ring;
  const WallNode* node;
  const WallBody* body;
  Index bodies;
};

/// What the walls' sub-step reads and writes.
struct WallStepView {
  WallMeshView mesh;
  PositionUnit unit;
  GrainPlaces grains;
  const Index* slot;       ///< of each grain near walls
  const Index* row_begin;  ///< its rows; one more element than grains
  const WallRow* rows;
  const WallLever* levers;
  WallGap* gaps;
  const BodyPose* pose;  ///< by body number; 0 at rest
  WallHistory* history;
  WallForce* force;
  std::int64_t* impulse;  ///< 6 a body, in impulse units
  double impulse_unit;    ///< N s (and N m s)
  float inertia_factor;
  HalfSteps half;
};

}  // namespace gdesp::dem
