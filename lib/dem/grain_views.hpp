// SPDX-License-Identifier: GPL-3.0-or-later
// Grains as kernels see them. What neighbours read of a grain is one record of 64 bytes. Positions in records are the
// fraction bits of FixedPosition (units of a tile / 2^32): their difference as 32-bit integers is the exact separation
// by the nearest image, across tile borders and periods, for grains less than half a tile apart.
#pragma once

#include "neighbors/cluster_set.hpp"

namespace gdesp::dem {

/// One grain at time n. Padding slots have radius = no_radius and touch nothing.
struct alignas(64) GrainRecord {
  std::int32_t x, y, z;          ///< fraction bits of the position
  float radius;                  ///< m
  float vx, vy, vz;              ///< m/s at time n (predicted from the half step, second order)
  float mass;                    ///< kg
  float sx, sy, sz;              ///< m/s: radius times angular velocity at time n
  float mobility;                ///< 1: moves; just_released: moves from now on; 0: held
  float rest_x, rest_y, rest_z;  ///< part of a unit that the position still owes
  std::int32_t wall;             ///< number among the grains near walls, or -1
};
static_assert(sizeof(GrainRecord) == 64);
inline constexpr int record_floats = 16;
inline constexpr float just_released = 0.5f;
inline constexpr float no_radius = -1.0e30f;

/// Eight contacts or near neighbours of one grain. Empty lanes name the dummy record behind the last slot.
struct alignas(64) ContactRow {
  Index neighbour[8];         ///< slots
  float fx[8], fy[8], fz[8];  ///< N, elastic tangential force on the grain (history)
};
struct alignas(32) RollingRow {
  float mx[8], my[8], mz[8];  ///< N m, elastic rolling torque on the grain (history)
};

/// Rows of a grain: the first is rows[slot], the others are rows[overflow ...].
struct RowRange {
  std::uint16_t count = 0;  ///< candidates
  std::uint16_t held = 0;   ///< 1: the grain is held, its histories stand still
  Index overflow = 0;
};

/// Force and torque on one grain near a wall.
struct WallForce {
  Vec3f force, torque;  ///< N, N m
};

/// What the fluid asks of the grains, by slot; null pointers in a dry run.
struct FluidOnGrains {
  const float* drag_coefficient = nullptr;    ///< kg/s
  const float* fluid_mass = nullptr;          ///< kg, of the water that shares the drag
  const float* added_mass = nullptr;          ///< kg
  const Vec3f* other_force = nullptr;         ///< N
  const Vec3f* fluid_acceleration = nullptr;  ///< m/s2, of that water, but for drag
  Vec3f* fluid_velocity = nullptr;            ///< m/s, of that water; goes on with the sub-steps
  Vec3d* drag_impulse = nullptr;              ///< N s, given by the fluid, summed over sub-steps
};

/// Metres per unit of a position, by axis, and its inverse.
struct PositionUnit {
  Vec3f metres, inverse;
};
inline PositionUnit position_unit(const Domain& domain) {
  PositionUnit unit;
  for (int axis = 0; axis < 3; ++axis) {
    unit.metres[axis] = static_cast<float>(domain.tile_size[axis] / Domain::one_tile);
    unit.inverse[axis] = static_cast<float>(Domain::one_tile / domain.tile_size[axis]);
  }
  return unit;
}

/// a - b of fraction bits, without overflow.
GDESP_HD inline std::int32_t fraction_difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}
/// a + d of fraction bits, wrapping around the tile.
GDESP_HD inline std::int32_t fraction_sum(std::int32_t a, std::int32_t d) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(d));
}
/// Where a grain is: in the record are the fraction bits of now, the rest by the short way round from where it was listed.
struct GrainPlaces {
  const FixedPosition* listed;  ///< when lists were made last
  const GrainRecord* record;
  GDESP_HD FixedPosition operator[](Index i) const {
    const FixedPosition& p = listed[i];
    const GrainRecord& r = record[i];
    return {p.x + fraction_difference(r.x, bits(p.x)), p.y + fraction_difference(r.y, bits(p.y)),
            p.z + fraction_difference(r.z, bits(p.z))};
  }
  /// The fraction bits where grain i was listed.
  GDESP_HD Vec3<std::int32_t> listed_bits(Index i) const {
    const FixedPosition& p = listed[i];
    return {bits(p.x), bits(p.y), bits(p.z)};
  }
  GDESP_HD static std::int32_t bits(std::int64_t p) { return static_cast<std::int32_t>(Domain::fraction_of(p)); }
};
/// m, r_a - r_b.
GDESP_HD inline Vec3f separation(const PositionUnit& unit, const GrainRecord& a, const GrainRecord& b) {
  return {static_cast<float>(fraction_difference(a.x, b.x)) * unit.metres.x,
          static_cast<float>(fraction_difference(a.y, b.y)) * unit.metres.y,
          static_cast<float>(fraction_difference(a.z, b.z)) * unit.metres.z};
}

}  // namespace gdesp::dem
