// SPDX-License-Identifier: GPL-3.0-or-later
// Particles on the host, as files carry them and as a simulation is started and read: one vector per quantity,
// SI units, positions in case coordinates (scene coordinates minus the case's offset). Vectors that a producer
// has nothing to say for stay empty; a consumer takes the default named here.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/vec3.hpp"

namespace gdesp {

/// Fluid particles, of mass mass_share * reference_density * dp^dimensions.
struct FluidTable {
  std::vector<Vec3d> position;    ///< m
  std::vector<Vec3f> velocity;    ///< m/s; default 0
  std::vector<float> density;     ///< kg/m3, true (not superficial); default: hydrostatic, set by the solver
  std::vector<float> pressure;    ///< Pa; output only
  std::vector<float> porosity;    ///< fluid volume share; output only
  std::vector<float> mass_share;  ///< default 1; less for water that starts between grains
  std::vector<std::uint32_t> id;  ///< default 0..n-1
};

/// Boundary particles: the walls as the fluid sees them, in layers of spacing dp below the surface.
struct BoundaryTable {
  std::vector<Vec3d> position;     ///< m
  std::vector<Vec3f> normal;       ///< unit, from the wall into the fluid; 0 where unknown
  std::vector<float> depth;        ///< m below the wall surface, > 0
  std::vector<float> friction;     ///< 1: no slip, 0: free slip; default 0
  std::vector<std::int32_t> body;  ///< 0: at rest; k > 0: moves with bodies[k - 1]
  std::vector<Vec3f> velocity;     ///< m/s; output only
  std::vector<float> pressure;     ///< Pa; output only
};

/// Grains (discrete element method): spheres, or discs of unit length in two dimensions.
struct GrainTable {
  std::vector<Vec3d> position;          ///< m
  std::vector<float> diameter;          ///< m
  std::vector<float> density;           ///< kg/m3
  std::vector<Vec3f> velocity;          ///< m/s; default 0
  std::vector<Vec3f> angular_velocity;  ///< rad/s; default 0
  std::vector<std::int32_t> group;      ///< index into the scene's slides; default 0
  std::vector<std::uint32_t> id;        ///< default 0..n-1
  std::vector<float> porosity;          ///< of the mixture at the grain; output only
};

/// A surface of triangles. Outward normal by the right-hand rule (from solid to fluid).
struct TriangleTable {
  std::vector<Vec3d> vertex;                 ///< m
  std::vector<Vec3<std::int32_t>> triangle;  ///< vertex indices
  std::vector<std::int32_t> body;            ///< per triangle: 0 at rest, k > 0 moves with bodies[k - 1]
  std::vector<std::int32_t> smooth;          ///< per triangle: 1 has no friction, a plane of symmetry; empty: none is
};

/// Prescribed motion: displacement as a piecewise linear function of time, constant beyond its ends.
struct PrescribedMotion {
  std::vector<double> time;         ///< s, increasing
  std::vector<Vec3d> displacement;  ///< m
  double remove_at = -1.0;          ///< s; the body vanishes then; < 0: never
};

/// Water beyond a vertical wall that is free to move along x, as columns (simulation/far_lake.hpp).
struct FarLakeShape {
  double length = 0.0, depth = 0.0;  ///< m, at rest
  double width = 1.0;                ///< m; 1 in two dimensions
  int columns = 0;
  double side = 1.0;   ///< 1: the far lake lies towards larger x; -1: towards smaller
  double wall = 0.0;   ///< m, x of the wall's face at the start
  double level = 0.0;  ///< m, z of the water at rest
};

/// Its surface: one entry a column, from the wall on.
struct FarLakeTable {
  std::vector<double> x;         ///< m, middle of the column
  std::vector<double> level;     ///< m, z of the surface
  std::vector<double> velocity;  ///< m/s along x, mean
};

enum class BodyKind {
  prescribed,  ///< moves as its table says
  free,        ///< moves as forces say
  far_lake,    ///< moves along x with the columns of a far lake behind it
};

/// A rigid body: gate, piston, rigid slide, floating box. Its particles and triangles name it by number.
struct Body {
  std::string name;
  BodyKind kind = BodyKind::prescribed;
  PrescribedMotion motion;                          ///< prescribed only
  double mass = 0.0;                                ///< kg; free only (as what follows)
  Vec3d centre;                                     ///< m, centre of mass
  Vec3d velocity;                                   ///< m/s
  Vec3d angular_velocity;                           ///< rad/s
  double inertia[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};  ///< kg m2, about the centre, row by row
  double release_at = 0.0;                          ///< s; held in place before
  bool fixed[4] = {false, false, false, false};     ///< no motion along x, y, z; no rotation
  FarLakeShape far_lake;                            ///< kind far_lake only
};

}  // namespace gdesp
