// SPDX-License-Identifier: GPL-3.0-or-later
// Who is awake (sph/activity.hpp): what the fluid system does about it.
#include "sph/fluid_system.hpp"

namespace gdesp::sph {
namespace {

// Sleeping water that asks to be looked at: steps after which who is awake is decided anew, at the latest. Sound goes 0.5 h
// a step, so it gets no further than a block and a half in between.
constexpr std::int32_t steps_between_looks = 16;

// Particles of sleeping clusters stand still.
struct Rest {
  const Index* awake;
  Vec3f* velocity;
  float* rate;
  float* record;
  GDESP_HD void operator()(Index s) const {
    const Index c = s / exec::cluster_size, k = s % exec::cluster_size;
    if (awake[c]) return;
    velocity[s] = {};
    rate[16 * static_cast<std::int64_t>(c) + 12 + k] = 0.0f;
    float* r = record + record_offset(c) + k;
    r[16] = r[20] = r[24] = 0.0f;
  }
};

struct Accelerations {
  FluidStateView state;
  const std::uint32_t* id;
  Vec3f* acceleration;
  GDESP_HD void operator()(Index s) const { acceleration[s] = id[s] == no_particle ? Vec3f{} : state.acceleration(s); }
};

}  // namespace

template <class Exec>
bool FluidSystem<Exec>::lists_are_stale(double next_move) const {
  const bool look = sleeps_ && steps_since_rebuild_ >= steps_between_looks && awake_.count() < set_.clusters();
  return look || 2.0 * (moved_ + next_move) > skin_;
}

template <class Exec>
void FluidSystem<Exec>::update_activity(double t, const Movers& movers) {
  activity_.begin();
  activity_.add_water(position_.data(), velocity_.data(), id_.data(), slots());
  if (sleeps_) {
    activity_.add_movers(movers);
    if (walls_move_)
      activity_.add_movers({wall_position_.data(), wall_velocity_.data(), wall_id_.data(), wall_set_.slots()});
  }
  activity_.judge(t, false);
  activity_.decide(t);
  if (sleeps_) {
    awake_.choose(activity_.grid(), activity_.awake(), position_.data(), id_.data(), set_.clusters());
    exec::parallel_for(exec_, "activity::rest", slots(),
                       Rest{awake_.flag(), velocity_.data(), rate_.data(), record_.data()});
  }
  near_walls_.choose(activity_.grid(), parameters_.activity.near_walls ? activity_.near() : nullptr,
                     wall_position_.data(), wall_id_.data(), wall_set_.clusters());
}

template <class Exec>
void FluidSystem<Exec>::start_sleeping(double t, const Movers& movers) {
  sleeps_ = true;
  activity_.set_sleeping();
  Array<Vec3f, Exec> acceleration(exec_);
  acceleration.resize_discard(static_cast<std::size_t>(slots()));
  exec::parallel_for(exec_, "activity::accelerations", slots(),
                     Accelerations{state_view(), id_.data(), acceleration.data()});
  activity_.begin();
  activity_.add_accelerations(position_.data(), acceleration.data(), id_.data(), slots());
  activity_.judge(t, true);
  update_activity(t, movers);
  build_lists();
}

using Backend = exec::CompiledBackend;
template bool FluidSystem<Backend>::lists_are_stale(double) const;
template void FluidSystem<Backend>::update_activity(double, const Movers&);
template void FluidSystem<Backend>::start_sleeping(double, const Movers&);

}  // namespace gdesp::sph
