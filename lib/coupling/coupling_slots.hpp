// SPDX-License-Identifier: GPL-3.0-or-later
// What the coupling makes of each grain and each particle of water, one by one; and where sums stand in memory.
#pragma once

#include "coupling/buoyancy.hpp"
#include "coupling/drag.hpp"
#include "coupling/grain_fluid_coupling.hpp"
#include "sph/cavitation.hpp"
#include "sph/tait.hpp"

namespace gdesp::coupling {

// Rows of a record of grains (four floats each), as the passes leave them.
enum GrainRow { row_x = 0, row_y = 4, row_z = 8, row_volume = 12, row_force = 16, row_offset = 28 };
// Rows of the water's own: volume (m3), pressure (Pa), 1/(room that walls leave).
constexpr Index water_rows = 12, water_pressure = 4, water_boost = 8;
// Sums at a grain, by slot: two groups of four, and the gradients of the first along x, y, z.
constexpr int sums_of_grain = 20;
enum GrainSum {
  sum_water = 0,
  sum_pressure = 1,
  sum_wall = 2,
  sum_solid = 3,
  sum_boosted = 4,
  sum_velocity = 5,
  sum_gradient = 8  // + 4 axis + one of the first four
};

GDESP_HD inline float grain_volume(float R, bool discs) {
  return discs ? 3.14159265f * R * R : 4.18879020f * R * R * R;
}

struct PackGrains {
  Domain domain;
  const Vec3<std::int32_t>* cluster_tile;
  dem::GrainPlaces grains;
  const std::uint32_t* id;
  bool discs;
  float* record;
  Vec3f* velocity_before;
  const Vec3f* velocity;
  float ahead;  // s
  GDESP_HD void operator()(Index s) const {
    const Index c = s / exec::cluster_size;
    float* r = record + record_offset(c) + s % exec::cluster_size;
    const bool real_grain = id[s] != no_particle;
    const Vec3f x = real_grain ? domain.relative_to_tile(grains[s], cluster_tile[c])
                               : Vec3f{padding_coordinate, padding_coordinate, padding_coordinate};
    const dem::GrainRecord& own = grains.record[s];
    const float R = real_grain ? own.radius : 0.0f;
    const bool moves = real_grain && own.mobility > 0.0f;
    const float dt = moves ? ahead : 0.0f;
    r[0] = x.x + own.vx * dt;
    r[4] = x.y + own.vy * dt;
    r[8] = x.z + own.vz * dt;
    r[row_volume] = grain_volume(R, discs);
    r[16] = r[20] = r[24] = r[row_offset] = 0.0f;
    velocity_before[s] = velocity[s];
  }
};

// The water's own rows, whatever form its records have.
struct PackWater {
  const std::uint32_t* id;
  const float* density;
  const float* porosity;
  const float* mass_share;
  bool cavitates;
  float V0, stiffness;
  float* water;
  GDESP_HD void operator()(Index s) const {
    float* r = water + water_rows * static_cast<std::int64_t>(s / exec::cluster_size) + s % exec::cluster_size;
    const bool real_particle = id[s] != no_particle;
    const float ratio = 1.0f + density[s], eps = porosity[s];
    r[0] = real_particle ? V0 * mass_share[s] / sph::cavitated_density(ratio, eps, cavitates) : 0.0f;
    r[4] =
        real_particle ? stiffness * sph::cavitated_pressure(sph::tait_pressure(ratio / eps - 1.0f), cavitates) : 0.0f;
  }
};

// V to V w/n, for the porosity of the water, and beside it V w, for that which drag sees.
struct Deposit {
  const float* sums;
  float* record;
  float wall_factor;
  bool all;  // whatever touches water, before it is known how much room the water takes
  GDESP_HD void operator()(Index s) const {
    const float* q = sums + sums_of_grain * static_cast<std::int64_t>(s);
    float* r = record + record_offset(s / exec::cluster_size) + s % exec::cluster_size;
    const float n = q[sum_water], room = open_share(wall_factor * q[sum_wall]);
    r[row_volume] = all ? (n > 0.02f ? r[row_volume] : 0.0f) : deposited_volume(r[row_volume], n, room);
    r[row_offset] = r[row_volume] * n;
  }
};

GDESP_HD inline float porosity_of(const float* read) { return real::max(1.0f - read[sum_solid], least_porosity); }

// How far the porosity of the water is from what it read of the nodes.
struct PorosityOff {
  const std::uint32_t* id;
  const float* read;  // four a slot
  const float* porosity;
  GDESP_HD float operator()(Index s) const {
    const float off = porosity_of(read + 4 * static_cast<std::int64_t>(s)) - porosity[s];
    return id[s] == no_particle ? 0.0f : real::max(off, -off);
  }
};
struct Larger {
  GDESP_HD float operator()(float a, float b) const { return real::max(a, b); }
};

// Porosity of the water, and the room that walls leave it, from what it read of the nodes.
struct RoomOfWater {
  const float* read;  // four a slot
  const float* density;
  float wall_factor;
  float* water;
  float* porosity;
  bool starting;
  GDESP_HD void operator()(Index s) const {
    const float* q = read + 4 * static_cast<std::int64_t>(s);
    water[water_rows * static_cast<std::int64_t>(s / exec::cluster_size) + s % exec::cluster_size + water_boost] =
        1.0f / open_share(wall_factor * q[sum_wall]);
    const float found = porosity_of(q);
    // Opened water takes its room from the porosity before: half of the way, so that the two settle.
    const bool opened = starting || 1.0f + density[s] < 0.98f * porosity[s];
    porosity[s] = opened ? 0.5f * (found + porosity[s]) : found;
  }
};

// Every fourth of three.
GDESP_HD inline Vec3f vector_at(const float* q) { return {q[0], q[4], q[8]}; }

struct ForcesOnGrains {
  const dem::GrainRecord* grain;
  const std::uint32_t* id;
  const std::int32_t* group;
  float* record;
  const float* sums;
  const float* real_diameter;  // per group; null: their own
  Drag law;
  bool discs;
  float density, viscosity, added_mass_factor, wall_factor;
  Vec3f gravity;
  float* porosity;
  float* drag_coefficient;
  float* fluid_mass;
  float* added_mass;
  Vec3f* fluid_velocity;
  Vec3f* fluid_acceleration;
  Vec3f* other_force;

  GDESP_HD void operator()(Index s) const {
    const float* q = sums + sums_of_grain * static_cast<std::int64_t>(s);
    float* r = record + record_offset(s / exec::cluster_size) + s % exec::cluster_size;
    r[row_volume] = r[row_offset] = 0.0f;
    drag_coefficient[s] = fluid_mass[s] = added_mass[s] = 0.0f;
    porosity[s] = 1.0f;
    fluid_velocity[s] = fluid_acceleration[s] = other_force[s] = {};
    const float n = q[sum_water], room = open_share(wall_factor * q[sum_wall]), N = n / room, wet = immersion(N);
    if (id[s] == no_particle || wet <= 0.0f) return;
    const float inverse = 1.0f / q[sum_boosted];
    const float eps = real::min(real::max(1.0f - q[sum_solid] / open_share(q[sum_wall]), porosity_floor), 1.0f);
    const Vec3f u = Vec3f{q[sum_velocity], q[sum_velocity + 1], q[sum_velocity + 2]} * inverse;
    const float R = grain[s].radius, V = grain_volume(R, discs);
    // Pressures were read as at the origin of the tile.
    const float head = dot(gravity * density, vector_at(r + row_x));
    const Vec3f water_gradient = vector_at(q + sum_gradient + sum_water);
    const Buoyancy push = buoyancy(V,
                                   {n, q[sum_pressure] + n * head, water_gradient,
                                    vector_at(q + sum_gradient + sum_pressure) + water_gradient * head, room,
                                    vector_at(q + sum_gradient + sum_wall) * wall_factor},
                                   gravity * density);
    const float given = real_diameter ? real_diameter[group[s]] : 0.0f;
    const Vec3f v{grain[s].vx, grain[s].vy, grain[s].vz};
    const DragState state{eps, norm(u - v), given > 0.0f ? given : 2.0f * R, density, viscosity};
    const float K = law == Drag::ergun_wen_yu ? ergun_wen_yu_drag(state) : di_felice_drag(state);
    // Fluid that belongs to the grain: less of it where the room around is only partly wet.
    fluid_mass[s] = density * V * eps * real::min(N, 1.0f) / real::max(1.0f - eps, 1.0e-3f);
    // Faded out towards a packed bed: buoyancy and added mass together react with (1 - eps)(1 + C_m) of the water's own
    // pressure acceleration, which explicit coupling bears only below one.
    const float dilute = real::min(real::max((eps - 0.6f) / 0.3f, 0.0f), 1.0f);
    const float m_added = wet * dilute * added_mass_factor * density * V;
    r[row_volume] = push.slope;
    r[row_offset] = push.offset;
    porosity[s] = eps;
    fluid_velocity[s] = u;
    drag_coefficient[s] = wet * K * V;
    added_mass[s] = m_added;
    fluid_acceleration[s] = push.gradient * (-1.0f / density) + gravity;
    other_force[s] = push.force + m_added * fluid_acceleration[s];
  }
};

// What each grain took besides pressure, over N, into its record.
struct PackReaction {
  const std::uint32_t* id;
  const Vec3f* velocity;
  const Vec3f* velocity_before;
  const Vec3f* fluid_acceleration;
  const float* added_mass;
  const Vec3d* drag_impulse;
  const float* sums;
  float inverse_dt, kick_share;  // 1/s; time of constant forces over dt
  float* record;
  GDESP_HD void operator()(Index s) const {
    float* r = record + record_offset(s / exec::cluster_size) + s % exec::cluster_size;
    if (id[s] == no_particle || r[row_volume] <= 0.0f) return;  // dry
    const float N = sums[sums_of_grain * static_cast<std::int64_t>(s) + sum_boosted];
    const Vec3f change = velocity[s] - velocity_before[s];
    const Vec3f F = fluid_acceleration[s] * (added_mass[s] * kick_share) +
                    static_cast<Vec3f>(drag_impulse[s] * static_cast<double>(inverse_dt)) -
                    change * (added_mass[s] * inverse_dt);
    r[row_force] = F.x / N;
    r[row_force + 4] = F.y / N;
    r[row_force + 8] = F.z / N;
    r[row_volume] *= kick_share;
    r[row_offset] *= kick_share;
  }
};

struct UnpackReaction {
  const float* reaction;  // four a slot
  const float* water;
  const float* mass_share;
  float inverse_mass;  // 1 / (rho0 V0)
  Vec3f* external;
  GDESP_HD void operator()(Index s) const {
    const float* f = reaction + 4 * static_cast<std::int64_t>(s);
    const float volume = water[water_rows * static_cast<std::int64_t>(s / exec::cluster_size) + s % exec::cluster_size];
    external[s] = Vec3f{f[0], f[1], f[2]} * (inverse_mass * volume / mass_share[s]);
  }
};

}  // namespace gdesp::coupling
