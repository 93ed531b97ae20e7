// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a step that concerns bodies: where they are for the water, free bodies in sub-steps with the grains, far lakes.
#include <algorithm>
#include <cmath>

#include "simulation/coupled_simulation.hpp"
#include "simulation/prescribed_motion.hpp"

namespace gdesp {
namespace {

dem::BodyMoment prescribed_moment(const Body& body, double t) {
  const MotionNow now = motion_at(body.motion, t);
  dem::BodyMoment moment;
  moment.centre = now.displacement;
  moment.velocity = now.velocity;
  return moment;
}

// Depths that sound travels while particles find their places beside a far lake's wall.
constexpr double settling_depths = 20.0;

sph::LoadsOf loads_of(TimeScheme scheme) {
  return scheme == TimeScheme::split ? sph::LoadsOf::momentum_pass : sph::LoadsOf::combined_pass;
}

}  // namespace

template <class Exec>
void CoupledSimulation<Exec>::start_bodies(const SimulationInput& input) {
  const auto any = [&](auto test) { return std::any_of(input.bodies.begin(), input.bodies.end(), test); };
  if (!any([](const Body& body) { return body.kind != BodyKind::prescribed; })) return;
  const sph::FluidParameters& p = input.fluid_parameters;
  loads_.assign(input.bodies.size(), {});
  last_loads_ = loads_;
  loaded_.assign(input.bodies.size() + 1, 0);
  for (std::size_t b = 0; b < input.bodies.size(); ++b) {
    const Body& body = input.bodies[b];
    loaded_[b + 1] = body.kind != BodyKind::prescribed ? 1 : 0;
    if (body.kind == BodyKind::far_lake)
      far_lakes_.push_back({b, FarLake(body.far_lake, p.reference_density, -p.gravity.z,
                                       settling_depths * body.far_lake.depth / p.sound_speed)});
  }
  if (!any([](const Body& body) { return body.kind == BodyKind::free; })) return;
  rigid_ = std::make_unique<dem::RigidBodies>(input.bodies, input.walls, input.contact, p.gravity, p.dp, p.dimensions);
  if (!input.fluid.position.empty()) rigid_->set_still_water(p.reference_density, p.level);
  rigid_->release(0.0);
}

template <class Exec>
const FarLake& CoupledSimulation<Exec>::far_lake_of(std::size_t b) const {
  return std::find_if(far_lakes_.begin(), far_lakes_.end(), [b](const LakeBehind& behind) { return behind.body == b; })
      ->lake;
}

/// Of body b at time t (s), as far as it is known: free bodies and far lakes from their own time on, with nothing acting.
template <class Exec>
dem::BodyMoment CoupledSimulation<Exec>::body_moment(std::size_t b, double t) const {
  const Body& body = input_.bodies[b];
  if (body.kind == BodyKind::prescribed) return prescribed_moment(body, t);
  if (body.kind == BodyKind::free) return rigid_->moment(b, t - rigid_time_);
  const FarLake& lake = far_lake_of(b);
  dem::BodyMoment moment;
  moment.centre.x = lake.displacement(t - rigid_time_);
  moment.velocity.x = lake.velocity();
  return moment;
}

template <class Exec>
void CoupledSimulation<Exec>::place_bodies(double t) {
  if (input_.bodies.empty()) return;
  for (std::size_t b = 0; b < input_.bodies.size(); ++b) {
    const Body& body = input_.bodies[b];
    sph::WallBodyState& state = body_states_[b];
    const bool free = body.kind == BodyKind::free;
    const dem::BodyMoment now = body_moment(b, t);
    state.centre_start = free ? body.centre : Vec3d{};
    state.centre = now.centre;
    state.velocity = static_cast<Vec3f>(now.velocity);
    if (free) {
      std::transform(std::begin(now.rotation), std::end(now.rotation), std::begin(state.rotation),
                     [](double r) { return static_cast<float>(r); });
      state.angular_velocity = static_cast<Vec3f>(now.spin);
    }
    state.present = removed_at(body.motion, t) ? 0 : 1;
  }
  fluid_.move_walls(body_states_);
}

template <class Exec>
void CoupledSimulation<Exec>::measure_loads(bool mean_with_last) {
  if (loaded_.empty()) return;
  const std::vector<sph::WallLoad> now = fluid_.body_loads(loaded_, loads_of(input_.time.scheme));
  for (std::size_t b = 0; b < now.size(); ++b) {
    const dem::BodyLoad load{now[b].force, now[b].torque};
    loads_[b] = load;
    if (mean_with_last && step_ > 0)
      loads_[b] = {0.5 * (load.force + last_loads_[b].force), 0.5 * (load.torque + last_loads_[b].torque)};
    last_loads_[b] = load;
  }
}

template <class Exec>
dem::BodyMotionState CoupledSimulation<Exec>::body_path(std::size_t b, double from, double dt) const {
  const Body& body = input_.bodies[b];
  dem::BodyMotionState path;
  path.present = removed_at(body.motion, from + dt) ? 0 : 1;
  if (body.kind != BodyKind::free) {
    path.centre_begin = body_moment(b, from).centre;
    path.centre_end = body_moment(b, from + dt).centre;
    return path;
  }
  const dem::BodyMoment begin = rigid_->moment(b), end = rigid_->moment(b, dt);
  path.centre_initial = body.centre;
  path.centre_begin = begin.centre;
  path.centre_end = end.centre;
  std::copy(std::begin(begin.rotation), std::end(begin.rotation), std::begin(path.rotation_begin));
  std::copy(std::begin(end.rotation), std::end(end.rotation), std::begin(path.rotation_end));
  return path;
}

template <class Exec>
std::vector<dem::BodyImpulse> CoupledSimulation<Exec>::grains_between_bodies(double from, double dt, int substeps) {
  if (!grains_) return {};
  std::vector<dem::BodyMotionState> paths;
  for (std::size_t b = 0; b < input_.bodies.size(); ++b) paths.push_back(body_path(b, from, dt));
  grains_->set_bodies(paths);
  grains_->advance(dt, substeps);
  grain_speed_ = grains_->largest_speed();
  return !loaded_.empty() ? grains_->take_body_impulses() : std::vector<dem::BodyImpulse>{};
}

template <class Exec>
void CoupledSimulation<Exec>::advance_solids(double dt) {
  if (!rigid_) {
    advance_far_lakes(dt, grains_between_bodies(time_, dt, grains_ ? substeps_for(dt) : 1));
    return;
  }
  const double contact = std::ceil(dt / rigid_->contact_time_step() - 1e-9);
  const int n = std::max({1, static_cast<int>(contact), grains_ ? substeps_for(dt) : 1});
  const double h = dt / n;
  rigid_->begin_step();
  for (std::size_t b = 0; b < loads_.size(); ++b) rigid_->set_fluid_load(b, loads_[b]);
  for (int k = 0; k < n; ++k) {
    const double now = time_ + k * h;
    rigid_->release(now + 1e-9 * h);
    const std::vector<dem::BodyImpulse> impulses = grains_between_bodies(now, h, 1);
    for (std::size_t b = 0; b < input_.bodies.size(); ++b) {
      const Body& body = input_.bodies[b];
      if (body.kind != BodyKind::free)
        rigid_->place_prescribed(b, body_moment(b, now + 0.5 * h), !removed_at(body.motion, now + h));
    }
    rigid_->substep(h, 1.0 / n, impulses);
  }
  advance_far_lakes(dt, {});
  rigid_->check(input_.lower, input_.upper, rigid_time_);
}

/// `grains`: impulses over dt by body where there are no free bodies; where there are, their contacts hold them too.
template <class Exec>
void CoupledSimulation<Exec>::advance_far_lakes(double dt, const std::vector<dem::BodyImpulse>& grains) {
  for (LakeBehind& behind : far_lakes_) {
    const std::size_t b = behind.body;
    double force = loads_[b].force.x;
    if (rigid_) force += rigid_->state(b).solid.force.x;
    if (b < grains.size()) force += grains[b].linear.x / dt;
    behind.lake.step(dt, force);
  }
  rigid_time_ = time_ + dt;
}

template <class Exec>
std::vector<FarLakeTable> CoupledSimulation<Exec>::far_lakes() {
  std::vector<FarLakeTable> tables;
  for (const LakeBehind& behind : far_lakes_) tables.push_back(behind.lake.table());
  return tables;
}

template <class Exec>
std::vector<BodyPose> CoupledSimulation<Exec>::bodies() {
  std::vector<BodyPose> poses;
  const std::vector<sph::WallLoad> loads = body_states_.empty() || fluid_.particles() == 0
                                               ? std::vector<sph::WallLoad>(body_states_.size())
                                               : fluid_.body_loads(prescribed_numbers(), loads_of(input_.time.scheme));
  for (std::size_t b = 0; b < body_states_.size(); ++b) {
    const sph::WallBodyState& state = body_states_[b];
    BodyPose pose;
    pose.centre = state.centre;
    pose.velocity = static_cast<Vec3d>(state.velocity);
    pose.angular_velocity = static_cast<Vec3d>(state.angular_velocity);
    std::copy(std::begin(state.rotation), std::end(state.rotation), std::begin(pose.rotation));
    pose.present = state.present != 0;
    pose.force = loads[b].force;
    pose.torque = loads[b].torque;
    if (input_.bodies[b].kind == BodyKind::far_lake) pose.force = loads_[b].force;
    if (input_.bodies[b].kind == BodyKind::free) {
      const dem::RigidState& body = rigid_->state(b);
      pose.velocity = body.velocity;
      pose.force = body.fluid.force + body.solid.force;
      pose.torque = body.fluid.torque + body.solid.torque;
    }
    poses.push_back(pose);
  }
  return poses;
}

template <class Exec>
std::vector<std::int32_t> CoupledSimulation<Exec>::prescribed_numbers() const {
  std::vector<std::int32_t> asked{0};
  for (const Body& body : input_.bodies) asked.push_back(body.kind == BodyKind::prescribed ? 1 : 0);
  return asked;
}

using Backend = exec::CompiledBackend;
template void CoupledSimulation<Backend>::start_bodies(const SimulationInput&);
template void CoupledSimulation<Backend>::place_bodies(double);
template void CoupledSimulation<Backend>::measure_loads(bool);
template dem::BodyMotionState CoupledSimulation<Backend>::body_path(std::size_t, double, double) const;
template std::vector<dem::BodyImpulse> CoupledSimulation<Backend>::grains_between_bodies(double, double, int);
template void CoupledSimulation<Backend>::advance_solids(double);
template void CoupledSimulation<Backend>::advance_far_lakes(double, const std::vector<dem::BodyImpulse>&);
template const FarLake& CoupledSimulation<Backend>::far_lake_of(std::size_t) const;
template dem::BodyMoment CoupledSimulation<Backend>::body_moment(std::size_t, double) const;
template std::vector<FarLakeTable> CoupledSimulation<Backend>::far_lakes();
template std::vector<BodyPose> CoupledSimulation<Backend>::bodies();
template std::vector<std::int32_t> CoupledSimulation<Backend>::prescribed_numbers() const;

}  // namespace gdesp
