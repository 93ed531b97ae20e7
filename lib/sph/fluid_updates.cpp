// SPDX-License-Identifier: GPL-3.0-or-later
// The pointwise parts of a fluid step: move, accelerate, equation of state, records, extremes and sums.
#include <algorithm>

#include "sph/fluid_system.hpp"
#include "sph/particle_shifting.hpp"
#include "sph/wall_guard.hpp"

namespace gdesp::sph {
namespace {

struct HalfDrift {
  FluidStateView state;
  RecordPacker packer;
  float dt_position, dt_density;
  GDESP_HD void operator()(Index s) const {
    if (packer.id[s] != no_particle) {
      const Vec3f v = state.velocity[s];
      state.position[s] = packer.domain.moved(state.position[s], static_cast<Vec3d>(v * dt_position));
      state.density[s] = cavitated_floor(state.density[s] + state.rate_at(s, 3) * dt_density, packer.cavitates);
    }
    packer(s, state.position[s], state.velocity[s], state.density[s]);
  }
};

struct KickDrift {
  FluidStateView state;
  RecordPacker packer;
  float dt, dt_position;
  const float* near_wall;          // null: no guard
  const float* near_wall_at_rest;  // null: no wall moves
  float sound_speed, dp;
  const float* spacing;  // null: no shifting
  const float* near_surface;
  float shift_strength;  // k h, m
  float fastest;         // m/s
  GDESP_HD static NearWall wall_at(const float* near, Index s) {
    const float* w = near + 24 * static_cast<std::int64_t>(s / exec::cluster_size) + s % exec::cluster_size;
    return {w[0], w[4], w[8], w[12], w[16], w[20]};
  }
  GDESP_HD void operator()(Index s) const {
    if (packer.id[s] != no_particle) {
      Vec3f v = state.velocity[s] + state.acceleration(s) * dt;
      if (near_wall) v = guarded_velocity(v, wall_at(near_wall, s), dt, sound_speed, dp);
      if (near_wall_at_rest) v = guarded_velocity(v, wall_at(near_wall_at_rest, s), dt, sound_speed, dp);
      state.velocity[s] = v;
      Vec3f move = v * dt_position;
      if (spacing) {
        const float* w = spacing + 16 * static_cast<std::int64_t>(s / exec::cluster_size) + s % exec::cluster_size;
        move += shift_of({w[0], w[4], w[8]}, near_surface[s], fastest, shift_strength, dt);
      }
      state.position[s] = packer.domain.moved(state.position[s], static_cast<Vec3d>(move));
    }
    packer(s, state.position[s], state.velocity[s], state.density[s]);
  }
};

struct VerletPredict {
  FluidStateView state;
  RecordPacker packer;
  float dt;
  GDESP_HD void operator()(Index s) const {
    Vec3f predicted{};
    float D = 0.0f;
    if (packer.id[s] != no_particle) {
      const Vec3f half_kick = state.acceleration(s) * (0.5f * dt);
      const float half_rate = state.rate_at(s, 3) * (0.5f * dt);
      const Vec3f v = state.velocity[s] + half_kick;  // mid-step velocity: r = r + v dt + a dt^2 / 2
      state.velocity[s] = v;
      state.density[s] += half_rate;
      state.position[s] = packer.domain.moved(state.position[s], static_cast<Vec3d>(v * dt));
      predicted = v + half_kick;
      D = state.density[s] + half_rate;
    }
    packer(s, state.position[s], predicted, D);
  }
};

struct VerletCorrect {
  FluidStateView state;  // without external
  const Vec3f* external;
  const std::uint32_t* id;
  float dt;
  GDESP_HD void operator()(Index s) const {
    if (id[s] == no_particle) return;
    state.velocity[s] += state.acceleration(s) * (0.5f * dt);
    if (external) state.velocity[s] += external[s] * dt;  // whole here: momentum balances step by step
    state.density[s] += state.rate_at(s, 3) * (0.5f * dt);
  }
};

struct EvolveWalls {
  const std::uint32_t* count;
  const float* rate;
  float* density;
  float* record;
  bool paper_form;
  float dt;
  GDESP_HD void operator()(Index s) const {
    const Index c = s / exec::cluster_size;
    if (count[c] == 0) return;
    // A dynamic boundary particle never pulls: its density stays at or above the reference.
    const float D = real::max(density[s] + rate[s] * dt, 0.0f);
    density[s] = D;
    EvolvedWallReset{density, paper_form, record}(s);
  }
};

struct ExtremeOf {
  FluidStateView state;
  const std::uint32_t* id;
  const float* porosity;
  bool cavitates;
  GDESP_HD FluidExtremes operator()(Index s) const {
    FluidExtremes e;
    if (id[s] == no_particle) return e;
    const Vec3f v = state.velocity[s], a = state.acceleration(s);
    e.speed2 = dot(v, v);
    e.acceleration2 = dot(a, a);
    const float ratio = (1.0f + state.density[s]) / (porosity ? porosity[s] : 1.0f);
    // Water that opens is no error where it cavitates.
    e.density_error = cavitates ? real::max(ratio - 1.0f, 0.0f) : ::fabsf(ratio - 1.0f);
    const float sum = e.speed2 + e.acceleration2 + e.density_error;
    e.non_finite = (sum - sum == 0.0f) ? 0 : 1;
    return e;
  }
};
struct CombineExtremes {
  GDESP_HD FluidExtremes operator()(const FluidExtremes& a, const FluidExtremes& b) const {
    FluidExtremes e;
    e.speed2 = real::max(a.speed2, b.speed2);
    e.acceleration2 = real::max(a.acceleration2, b.acceleration2);
    e.density_error = real::max(a.density_error, b.density_error);
    e.non_finite = a.non_finite + b.non_finite;
    return e;
  }
};

struct SumOf {
  Domain domain;
  FluidStateView state;
  const std::uint32_t* id;
  const float* mass_share;  // null: 1
  const float* porosity;
  double particle_mass, c2;
  Vec3d gravity;
  bool cavitates;
  GDESP_HD FluidSums operator()(Index s) const {
    FluidSums sum;
    if (id[s] == no_particle) return sum;
    const double m = particle_mass * (mass_share ? static_cast<double>(mass_share[s]) : 1.0);
    const auto v = static_cast<Vec3d>(state.velocity[s]);
    sum.particles = 1;
    sum.mass = m;
    sum.momentum = v * m;
    sum.kinetic_energy = 0.5 * m * dot(v, v);
    sum.potential_energy = -m * dot(gravity, domain.metres(state.position[s]));
    // Tait: work of compression per mass, c^2 (x^6/42 + 1/(7 x) - 1/6), x = rho/rho0.
    const double ratio =
        (1.0 + static_cast<double>(state.density[s])) / (porosity ? static_cast<double>(porosity[s]) : 1.0);
    const double x = cavitates && ratio < 1.0 ? 1.0 : ratio;  // water that has opened holds no tension
    const double x2 = x * x;
    if (x > 1.0 || !cavitates)  // opened water bears no pressure
      sum.elastic_energy = m * c2 * (x2 * x2 * x2 / 42.0 + 1.0 / (7.0 * x) - 1.0 / 6.0);
    return sum;
  }
};
struct AddSums {
  GDESP_HD FluidSums operator()(const FluidSums& a, const FluidSums& b) const {
    FluidSums s;
    s.mass = a.mass + b.mass;
    s.momentum = a.momentum + b.momentum;
    s.kinetic_energy = a.kinetic_energy + b.kinetic_energy;
    s.potential_energy = a.potential_energy + b.potential_energy;
    s.elastic_energy = a.elastic_energy + b.elastic_energy;
    s.particles = a.particles + b.particles;
    return s;
  }
};

// Wall particles follow their bodies.
struct MoveWalls {
  Domain domain;
  const std::int32_t* body;
  const std::uint32_t* id;
  const FixedPosition* start;
  const WallBodyState* bodies;
  FixedPosition* position;
  Vec3f* velocity;
  GDESP_HD void operator()(Index s) const {
    if (id[s] == no_particle || body[s] == 0) return;
    const WallBodyState b = bodies[body[s] - 1];
    const Vec3d arm0 = domain.metres(start[s]) - b.centre_start;
    const Vec3d arm{b.rotation[0] * arm0.x + b.rotation[1] * arm0.y + b.rotation[2] * arm0.z,
                    b.rotation[3] * arm0.x + b.rotation[4] * arm0.y + b.rotation[5] * arm0.z,
                    b.rotation[6] * arm0.x + b.rotation[7] * arm0.y + b.rotation[8] * arm0.z};
    position[s] = domain.wrapped(domain.fixed(b.centre + arm));
    velocity[s] = b.velocity + cross(b.angular_velocity, static_cast<Vec3f>(arm));
  }
};

// Where each wall particle has its surface, as rows of four a cluster; normals turn with their body.
struct SpreadSurface {
  const Vec3f* normal;
  const float* depth;
  const std::int32_t* body;
  const WallBodyState* bodies;  // null: as at the start
  float* surface;
  float* at_rest;  // without normals of bodies; null: none moves
  GDESP_HD void operator()(Index s) const {
    const std::int64_t row = 16 * static_cast<std::int64_t>(s / exec::cluster_size) + s % exec::cluster_size;
    Vec3f n = normal[s];
    if (bodies && body[s] > 0) {
      const float* R = bodies[body[s] - 1].rotation;
      n = {R[0] * n.x + R[1] * n.y + R[2] * n.z, R[3] * n.x + R[4] * n.y + R[5] * n.z,
           R[6] * n.x + R[7] * n.y + R[8] * n.z};
    }
    write(surface + row, n, depth[s]);
    if (at_rest) write(at_rest + row, body[s] > 0 ? Vec3f{} : n, depth[s]);
  }
  GDESP_HD static void write(float* r, const Vec3f& n, float depth) {
    r[0] = n.x;
    r[4] = n.y;
    r[8] = n.z;
    r[12] = depth;
  }
};

struct PackWalls {
  Domain domain;
  const Vec3<std::int32_t>* cluster_tile;
  const std::uint32_t* id;
  const std::int32_t* body;
  const WallBodyState* bodies;  // null: none move
  const FixedPosition* position;
  const Vec3f* velocity;
  float* record;
  GDESP_HD void operator()(Index s) const {
    const Index c = s / exec::cluster_size;
    float* r = record + record_offset(c) + s % exec::cluster_size;
    const bool absent = id[s] == no_particle || (bodies && body[s] > 0 && !bodies[body[s] - 1].present);
    const Vec3f x = absent ? Vec3f{padding_coordinate, padding_coordinate, padding_coordinate}
                           : domain.relative_to_tile(position[s], cluster_tile[c]);
    const Vec3f v = absent ? Vec3f{} : velocity[s];
    r[0] = x.x;
    r[4] = x.y;
    r[8] = x.z;
    r[16] = v.x;
    r[20] = v.y;
    r[24] = v.z;
  }
};

}  // namespace

template <class Exec>
FluidStateView FluidSystem<Exec>::state_view() {
  return {position_.data(),
          velocity_.data(),
          density_.data(),
          rate_.data(),
          coupled_ ? external_.data() : nullptr,
          static_cast<Vec3f>(parameters_.gravity)};
}

template <class Exec>
RecordPacker FluidSystem<Exec>::packer() {
  return {domain_,
          parameters_.paper_form,
          set_.view().cluster_tile,
          id_.data(),
          porous_ ? porosity_.data() : nullptr,
          mass_share_.data(),
          parameters_.cavitates,
          record_.data(),
          false};
}

template <class Exec>
void FluidSystem<Exec>::half_drift(float dt_position, float dt_density) {
  exec::parallel_for(exec_, "sph::half_drift", awake_slots(),
                     chosen_slots(awake_list(), HalfDrift{state_view(), packer(), dt_position, dt_density}));
}

template <class Exec>
void FluidSystem<Exec>::pack() {
  exec::parallel_for(exec_, "sph::pack", awake_slots(),
                     chosen_slots(awake_list(), HalfDrift{state_view(), packer(), 0.0f, 0.0f}));
}

template <class Exec>
void FluidSystem<Exec>::pack_all() {
  exec::parallel_for(exec_, "sph::pack", slots(), HalfDrift{state_view(), packer(), 0.0f, 0.0f});
}

template <class Exec>
void FluidSystem<Exec>::kick_drift(float dt, float dt_position, float fastest) {
  RecordPacker packing = packer();
  packing.keeps_pressure = porous_ && !parameters_.tensile_control;  // of the mixture: for the density diffusion
  exec::parallel_for(
      exec_, "sph::kick_drift", awake_slots(),
      chosen_slots(awake_list(),
                   KickDrift{state_view(), packing, dt, dt_position, guarded_ ? near_wall_.data() : nullptr,
                             guarded_ && walls_move_ ? near_wall_at_rest_.data() : nullptr,
                             static_cast<float>(parameters_.sound_speed), static_cast<float>(parameters_.dp),
                             parameters_.shifting > 0.0 ? spacing_.data() : nullptr, near_surface_.data(),
                             static_cast<float>(parameters_.shifting * parameters_.h), fastest}));
}

template <class Exec>
void FluidSystem<Exec>::verlet_predict(float dt) {
  FluidStateView state = state_view();
  state.external = nullptr;
  exec::parallel_for(exec_, "sph::verlet_predict", awake_slots(),
                     chosen_slots(awake_list(), VerletPredict{state, packer(), dt}));
}

template <class Exec>
void FluidSystem<Exec>::verlet_correct(float dt) {
  FluidStateView state = state_view();
  state.external = nullptr;
  exec::parallel_for(
      exec_, "sph::verlet_correct", awake_slots(),
      chosen_slots(awake_list(), VerletCorrect{state, coupled_ ? external_.data() : nullptr, id_.data(), dt}));
}

template <class Exec>
void FluidSystem<Exec>::evolve_dynamic_walls(float dt) {
  if (wall_set_.clusters() == 0 || parameters_.extrapolated_walls) return;
  exec::parallel_for(
      exec_, "sph::evolve_walls", exec::cluster_size * near_walls_.count(),
      chosen_slots(near_walls_.list(), EvolveWalls{wall_fluid_.view().count, wall_rate_.data(), wall_density_.data(),
                                                   wall_record_.data(), parameters_.paper_form, dt}));
}

template <class Exec>
FluidExtremes FluidSystem<Exec>::extremes() {
  return exec::reduce(
      exec_, "sph::extremes", awake_slots(), FluidExtremes{},
      chosen_slots(awake_list(),
                   ExtremeOf{state_view(), id_.data(), porous_ ? porosity_.data() : nullptr, parameters_.cavitates}),
      CombineExtremes{});
}

template <class Exec>
FluidSums FluidSystem<Exec>::sums() {
  const double c = parameters_.sound_speed;
  const double mass = parameters_.reference_density * std::pow(parameters_.dp, parameters_.dimensions);
  return exec::reduce(
      exec_, "sph::sums", slots(), FluidSums{},
      SumOf{domain_, state_view(), id_.data(), mass_share_.data(), coupled_ ? porosity_.data() : nullptr, mass, c * c,
            parameters_.gravity, parameters_.cavitates},
      AddSums{});
}

template <class Exec>
void FluidSystem<Exec>::pack_walls() {
  exec::parallel_for(exec_, "sph::pack_walls", wall_set_.slots(),
                     PackWalls{domain_, wall_set_.view().cluster_tile, wall_id_.data(), wall_body_.data(),
                               wall_bodies_.empty() ? nullptr : wall_bodies_.data(), wall_position_.data(),
                               wall_velocity_.data(), wall_record_.data()});
}

template <class Exec>
void FluidSystem<Exec>::move_walls(const std::vector<WallBodyState>& bodies) {
  if (bodies.empty() || wall_set_.clusters() == 0) return;
  wall_bodies_.assign(bodies);
  exec::parallel_for(exec_, "sph::move_walls", wall_set_.slots(),
                     MoveWalls{domain_, wall_body_.data(), wall_id_.data(), wall_start_.data(), wall_bodies_.data(),
                               wall_position_.data(), wall_velocity_.data()});
  if (guarded_) spread_surface();
  pack_walls();
}

template <class Exec>
void FluidSystem<Exec>::spread_surface() {
  exec::parallel_for(exec_, "sph::wall_surface", wall_set_.slots(),
                     SpreadSurface{wall_normal_.data(), wall_depth_.data(), wall_body_.data(),
                                   wall_bodies_.size() > 0 ? wall_bodies_.data() : nullptr, wall_surface_.data(),
                                   walls_move_ ? surface_at_rest_.data() : nullptr});
}

template FluidStateView FluidSystem<exec::CompiledBackend>::state_view();
template RecordPacker FluidSystem<exec::CompiledBackend>::packer();
template void FluidSystem<exec::CompiledBackend>::half_drift(float, float);
template void FluidSystem<exec::CompiledBackend>::pack();
template void FluidSystem<exec::CompiledBackend>::pack_all();
template void FluidSystem<exec::CompiledBackend>::kick_drift(float, float, float);
template void FluidSystem<exec::CompiledBackend>::verlet_predict(float);
template void FluidSystem<exec::CompiledBackend>::verlet_correct(float);
template void FluidSystem<exec::CompiledBackend>::evolve_dynamic_walls(float);
template void FluidSystem<exec::CompiledBackend>::spread_surface();
template FluidExtremes FluidSystem<exec::CompiledBackend>::extremes();
template FluidSums FluidSystem<exec::CompiledBackend>::sums();
template void FluidSystem<exec::CompiledBackend>::pack_walls();
template void FluidSystem<exec::CompiledBackend>::move_walls(const std::vector<WallBodyState>&);

}  // namespace gdesp::sph
