// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a step that concerns bodies: where they are for the water, and free bodies in sub-steps with the grains.
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

sph::LoadsOf loads_of(TimeScheme scheme) {
  return scheme == TimeScheme::split ? sph::LoadsOf::momentum_pass : sph::LoadsOf::combined_pass;
}

}  // namespace

template <class Exec>
void CoupledSimulation<Exec>::start_bodies(const SimulationInput& input) {
  const auto is_free = [](const Body& body) { return body.kind == BodyKind::free; };
  if (std::none_of(input.bodies.begin(), input.bodies.end(), is_free)) return;
  const sph::FluidParameters& p = input.fluid_parameters;
  rigid_ = std::make_unique<dem::RigidBodies>(input.bodies, input.walls, input.contact, p.gravity, p.dp, p.dimensions);
  if (!input.fluid.position.empty()) rigid_->set_still_water(p.reference_density, p.level);
  rigid_->release(0.0);
  loads_.assign(input.bodies.size(), {});
  last_loads_ = loads_;
  free_.assign(input.bodies.size() + 1, 0);
  for (std::size_t b = 0; b < input.bodies.size(); ++b) free_[b + 1] = is_free(input.bodies[b]) ? 1 : 0;
}

template <class Exec>
void CoupledSimulation<Exec>::place_bodies(double t) {
  if (input_.bodies.empty()) return;
  for (std::size_t b = 0; b < input_.bodies.size(); ++b) {
    const Body& body = input_.bodies[b];
    sph::WallBodyState& state = body_states_[b];
    const bool free = body.kind == BodyKind::free;
    const dem::BodyMoment now = free ? rigid_->moment(b, t - rigid_time_) : prescribed_moment(body, t);
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
  if (!rigid_) return;
  const std::vector<sph::WallLoad> now = fluid_.body_loads(free_, loads_of(input_.time.scheme));
  for (std::size_t b = 0; b < now.size(); ++b) {
    const dem::BodyLoad load{now[b].force, now[b].torque};
    loads_[b] = load;
    if (mean_with_last) loads_[b] = {0.5 * (load.force + last_loads_[b].force), 0.5 * (load.torque + last_loads_[b].torque)};
    last_loads_[b] = load;
  }
}

template <class Exec>
dem::BodyMotionState CoupledSimulation<Exec>::body_path(std::size_t b, double from, double dt) const {
  const Body& body = input_.bodies[b];
  dem::BodyMotionState path;
  path.present = !removed_at(body.motion, from + dt);
  if (body.kind == BodyKind::prescribed) {
    path.centre_begin = motion_at(body.motion, from).displacement;
    path.centre_end = motion_at(body.motion, from + dt).displacement;
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
  return rigid_ ? grains_->take_body_impulses() : std::vector<dem::BodyImpulse>{};
}

template <class Exec>
void CoupledSimulation<Exec>::advance_solids(double dt) {
  if (!rigid_) {
    grains_between_bodies(time_, dt, grains_ ? substeps_for(dt) : 1);
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
      if (body.kind == BodyKind::prescribed) rigid_->place_prescribed(b, prescribed_moment(body, now + 0.5 * h), !removed_at(body.motion, now + h));
    }
    rigid_->substep(h, 1.0 / n, impulses);
  }
  rigid_time_ = time_ + dt;
  rigid_->check(input_.lower, input_.upper, rigid_time_);
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
template std::vector<BodyPose> CoupledSimulation<Backend>::bodies();
template std::vector<std::int32_t> CoupledSimulation<Backend>::prescribed_numbers() const;

}  // namespace gdesp
