// SPDX-License-Identifier: GPL-3.0-or-later
// What the guard of a run asks of the water: who is deepest inside a wall, and another sound speed.
#include "sph/fluid_system.hpp"
#include "sph/tait.hpp"
#include "sph/wall_guard.hpp"

namespace gdesp::sph {
namespace {

struct DepthInWall {
  const float* near_wall;
  const std::uint32_t* id;
  GDESP_HD DeepestInWall operator()(Index s) const {
    DeepestInWall none;
    if (id[s] == no_particle) return none;
    const float* w = near_wall + 24 * static_cast<std::int64_t>(s / exec::cluster_size) + s % exec::cluster_size;
    const float weight = w[0];
    const Vec3f normal{w[8], w[12], w[16]};
    // Between opposite walls the mean says nothing.
    if (!(weight > least_guard_weight) || norm(normal) < 0.8f * weight) return none;
    const float depth = -w[4] / weight;
    return depth > 0.0f ? DeepestInWall{depth, id[s]} : none;
  }
};

struct Deeper {
  GDESP_HD DeepestInWall operator()(const DeepestInWall& a, const DeepestInWall& b) const {
    return a.depth > b.depth || (a.depth == b.depth && a.id < b.id) ? a : b;
  }
};

// D for which the pressure stays what it was when c^2 becomes c^2 / share.
struct KeepPressure {
  const std::uint32_t* id;
  const float* porosity;  // null: 1
  float share;
  float* density;
  GDESP_HD void operator()(Index s) const {
    if (id && id[s] == no_particle) return;
    const float at_rest = porosity ? porosity[s] : 1.0f;
    const float ratio = (1.0f + density[s]) / at_rest;
    density[s] = at_rest * (1.0f + tait_density(share * tait_pressure(ratio - 1.0f))) - 1.0f;
  }
};

}  // namespace

template <class Exec>
DeepestInWall FluidSystem<Exec>::deepest_in_wall() {
  if (!guarded_) return {};
  return exec::reduce(exec_, "sph::deepest_in_wall", awake_slots(), DeepestInWall{},
                      chosen_slots(awake_list(), DepthInWall{near_wall_.data(), id_.data()}), Deeper{});
}

template <class Exec>
void FluidSystem<Exec>::set_sound_speed(double c) {
  if (c == parameters_.sound_speed) return;
  const double ratio = parameters_.sound_speed / c;
  const auto share = static_cast<float>(ratio * ratio);
  exec::parallel_for(exec_, "sph::keep_pressure", slots(),
                     KeepPressure{id_.data(), porous_ ? porosity_.data() : nullptr, share, density_.data()});
  exec::parallel_for(exec_, "sph::keep_pressure", wall_set_.slots(),
                     KeepPressure{wall_id_.data(), nullptr, share, wall_density_.data()});
  parameters_.sound_speed = c;
  pack_all();
}

template DeepestInWall FluidSystem<exec::CompiledBackend>::deepest_in_wall();
template void FluidSystem<exec::CompiledBackend>::set_sound_speed(double);

}  // namespace gdesp::sph
