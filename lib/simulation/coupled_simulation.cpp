// SPDX-License-Identifier: GPL-3.0-or-later
#include "simulation/coupled_simulation.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "simulation/guarding_walls.hpp"
#include "simulation/time_step_limits.hpp"

namespace gdesp {
namespace {

Domain domain_of(const SimulationInput& input) {
  return make_domain(input.lower, input.upper, input.fluid_parameters.dp, input.periodic,
                     input.fluid_parameters.dimensions);
}

}  // namespace

template <class Exec>
CoupledSimulation<Exec>::CoupledSimulation(const Exec& exec, const SimulationInput& input)
    : exec_(exec), input_(input), domain_(domain_of(input)),
      fluid_(exec, domain_, input.fluid_parameters, input.fluid, guarding_walls(input)),
      body_states_(input.bodies.size()) {
  input_.fluid = {};
  input_.boundary = {};
  input_.grains = {};
  if (input_.time.cfl <= 0.0)
    input_.time.cfl = input_.time.scheme == TimeScheme::split ? split_default_cfl : verlet_default_cfl;
  start_bodies(input);
  place_bodies(0.0);
  if (!input.grains.position.empty()) start_grains(input);
  fluid_.extrapolate_walls();
  if (fluid_.may_fall_asleep(0.0)) {
    fluid_.momentum_pass();
    fluid_.start_sleeping(0.0, movers());
  }
  extremes_ = fluid_.extremes();
}

template <class Exec>
double CoupledSimulation<Exec>::choose_step(double end) {
  const sph::FluidParameters& p = fluid_.parameters();
  const double left = end - time_;
  if (grains_) grain_dt_ = grains_->stable_time_step(input_.time.grain_step_share);  // fast grains take shorter steps
  double dt = input_.time.fixed_step;
  limited_by_ = "fixed";
  if (dt <= 0.0) {
    const double largest_speed =
        std::max(std::sqrt(static_cast<double>(extremes_.speed2)), rigid_ ? rigid_->largest_speed() : 0.0);
    const double artificial = p.viscosity == sph::Viscosity::artificial
                                  ? p.artificial_viscosity * p.h * p.sound_speed / (2.0 * (p.dimensions + 2))
                                  : 0.0;
    const FluidStepLimit limit =
        fluid_step_limit(input_.time.cfl, p.h, p.sound_speed, largest_speed,
                         std::sqrt(static_cast<double>(extremes_.acceleration2)), p.kinematic_viscosity + artificial);
    dt = limit.dt;
    limited_by_ = limit.bound;
  }
  if (grains_ && fluid_.particles() == 0) {
    dt = 50.0 * grain_dt_;
    limited_by_ = "grains";
  } else if (grains_ && !input_.time.multirate && grain_dt_ < dt) {
    dt = grain_dt_;
    limited_by_ = "grains";
  }
  dt *= step_factor_;
  acoustic_step_ = fluid_.particles() > 0 ? step_factor_ * input_.time.cfl * p.h / p.sound_speed : 0.0;
  // End exactly at `end`, without a sliver of a step before it.
  if (left <= dt * (1.0 + 1e-9)) {
    limited_by_ = "output";
    return left;
  }
  if (left < 2.0 * dt) {
    limited_by_ = "output";
    return 0.5 * left;
  }
  return dt;
}

template <class Exec>
void CoupledSimulation<Exec>::make_room_for(double dt) {
  double speed =
      std::sqrt(static_cast<double>(extremes_.speed2)) + dt * (std::sqrt(static_cast<double>(extremes_.acceleration2)));
  for (const auto& body : body_states_) speed = std::max(speed, static_cast<double>(norm(body.velocity)));
  if (rigid_) speed = std::max(speed, rigid_->largest_speed() + dt * norm(input_.fluid_parameters.gravity));
  // Shifting adds at most 0.4 of the path of the fastest (sph.shifting).
  const double move = (input_.fluid_parameters.shifting > 0.0 ? 1.6 : 1.2) * speed * dt;
  if (fluid_.may_fall_asleep(time_)) fluid_.start_sleeping(time_, movers());
  const bool stale = fluid_.lists_are_stale(move);
  if (stale) {
    fluid_.rebuild(std::sqrt(static_cast<double>(extremes_.speed2)) * dt, time_, movers(), move);
    ++rebuilds_;
  }
  largest_move_ = move;
  // Both against nodes at rest.
  if (coupling_) refresh_coupling(std::max(move, 1.2 * grain_speed_ * dt), stale);
}

template <class Exec>
void CoupledSimulation<Exec>::fluid_split_step(float dt) {
  place_bodies(time_ + 0.5 * static_cast<double>(dt));
  fluid_.half_drift(0.5f * dt, density_lag_ + 0.5f * dt);
  fluid_.trim_lists(largest_move_);
  porosity_now(0.5 * static_cast<double>(dt));
  gather_forces();
  if (input_.fluid_parameters.extrapolated_walls) {
    fluid_.extrapolate_walls();  // of the mixture pressure
  } else {
    fluid_.wall_continuity_pass();
    fluid_.evolve_dynamic_walls(dt);
  }
  fluid_.spacing_pass();
  fluid_.momentum_pass();
  measure_loads(false);
  fluid_.find_walls();
  couple_grains(static_cast<double>(dt));
  fluid_.kick_drift(dt, 0.5f * dt, ::sqrtf(extremes_.speed2));
  place_bodies(time_ + static_cast<double>(dt));
  fluid_.continuity_pass();
  density_lag_ = 0.5f * dt;
}

template <class Exec>
void CoupledSimulation<Exec>::fluid_verlet_step(float dt) {
  place_bodies(time_ + static_cast<double>(dt));
  fluid_.verlet_predict(dt);
  fluid_.trim_lists(2.0 * largest_move_);  // the whole step lies behind
  porosity_now(0.5 * static_cast<double>(dt));
  gather_forces();
  if (input_.fluid_parameters.extrapolated_walls) {
    fluid_.extrapolate_walls();  // of the mixture pressure
  } else {
    fluid_.wall_continuity_pass();
    fluid_.evolve_dynamic_walls(dt);
  }
  fluid_.combined_pass();
  measure_loads(true);
  couple_grains(static_cast<double>(dt));
  fluid_.verlet_correct(dt);
}

// What particles have moved in a step that is done, at most: half a step at the old velocity and half at the new one
// (split), the whole step at the velocity in its middle (verlet). make_room_for() had to guess the new one.
template <class Exec>
void CoupledSimulation<Exec>::note_move(double dt, double old_speed) {
  const double speed = std::sqrt(static_cast<double>(extremes_.speed2));
  const double kick = dt * std::sqrt(static_cast<double>(extremes_.acceleration2));
  const double moved = input_.time.scheme == TimeScheme::split ? 0.5 * dt * (old_speed + speed) : dt * (speed + kick);
  fluid_.note_move(input_.bodies.empty() ? moved : std::max(moved, largest_move_));
}

template <class Exec>
void CoupledSimulation<Exec>::step(double end) {
  const double dt = choose_step(end), old_speed = std::sqrt(static_cast<double>(extremes_.speed2));
  if (fluid_.particles() == 0) {
    advance_solids(dt);
    place_bodies(time_ + dt);
  } else {
    make_room_for(dt);
    if (input_.time.scheme == TimeScheme::split) {
      fluid_split_step(static_cast<float>(dt));
    } else {
      fluid_verlet_step(static_cast<float>(dt));
    }
  }
  extremes_ = fluid_.extremes();
  if (extremes_.non_finite > 0) {
    throw Error(ErrorKind::numerical, "water: " + std::to_string(extremes_.non_finite) +
                                          " particles have no finite state at t = " + std::to_string(time_ + dt) +
                                          " s, step " + std::to_string(step_ + 1));
  }
  note_move(dt, old_speed);
  time_ = (limited_by_ == std::string("output") && end - time_ <= dt) ? end : time_ + dt;
  last_dt_ = dt;
  ++step_;
}

template <class Exec>
StepState CoupledSimulation<Exec>::step_state() const {
  const double speed = std::sqrt(static_cast<double>(extremes_.speed2));
  return {last_dt_, acoustic_step_, speed / sound_speed(), static_cast<double>(extremes_.density_error)};
}

template <class Exec>
void CoupledSimulation<Exec>::set_caution(double step_factor, double sound_speed) {
  step_factor_ = step_factor;
  fluid_.set_sound_speed(sound_speed);
  input_.fluid_parameters.sound_speed = sound_speed;
}

template <class Exec>
Diagnostics CoupledSimulation<Exec>::diagnostics() {
  Diagnostics d;
  const sph::FluidSums sums = fluid_.sums();
  d.time = time_;
  d.step = step_;
  d.time_step = last_dt_;
  d.limited_by = limited_by_;
  d.fluid_mass = sums.mass;
  d.fluid_kinetic = sums.kinetic_energy;
  d.fluid_potential = sums.potential_energy;
  d.fluid_elastic = sums.elastic_energy;
  d.fluid_momentum = sums.momentum;
  d.largest_speed = std::sqrt(static_cast<double>(extremes_.speed2));
  d.mach = d.largest_speed / sound_speed();
  d.largest_density_error = extremes_.density_error;
  d.fluid_particles = sums.particles;
  d.wall_particles = fluid_.wall_particles();
  d.lost_fluid = fluid_.lost();
  d.rebuilds = rebuilds_;
  if (step_ > 0 && input_.time.scheme == TimeScheme::split) {
    const sph::DeepestInWall deepest = fluid_.deepest_in_wall();
    d.deepest_in_wall = static_cast<double>(deepest.depth) / input_.fluid_parameters.dp;
    d.deepest_in_wall_id = deepest.id;
  }
  if (fluid_.set().clusters() > 0)
    d.awake_share = static_cast<double>(fluid_.awake_clusters()) / fluid_.set().clusters();
  if (rigid_) {
    const dem::RigidSums bodies = rigid_->sums();
    d.free_bodies = std::count_if(input_.bodies.begin(), input_.bodies.end(),
                                  [](const Body& body) { return body.kind == BodyKind::free; });
    d.body_momentum = bodies.momentum;
    d.body_kinetic = bodies.kinetic_energy;
    d.body_potential = bodies.potential_energy;
    d.body_elastic = bodies.elastic_energy;
    d.largest_body_speed = rigid_->largest_speed();
  }
  for (const LakeBehind& behind : far_lakes_) {
    const FarLakeSums lake = behind.lake.sums();
    d.far_lake_mass += lake.mass;
    d.far_lake_momentum += lake.momentum;
    d.far_lake_kinetic += lake.kinetic;
    d.far_lake_potential += lake.potential;
    d.far_lake_highest = std::max(d.far_lake_highest, lake.highest);
  }
  d.far_lakes = static_cast<std::int64_t>(far_lakes_.size());
  if (grains_) {
    const dem::GrainSums grains = grains_->sums();
    d.grains = grains.particles;
    d.grain_mass = grains.mass;
    d.grain_momentum = grains.momentum;
    d.grain_kinetic = grains.kinetic_energy;
    d.grain_potential = grains.potential_energy;
    d.grain_elastic = grains.elastic_energy;
    d.largest_grain_speed = grains.largest_speed;
    d.largest_overlap = grains.largest_overlap;
    d.lost_grains = grains_->lost();
    d.grain_substeps = grains_->substeps();
  }
  return d;
}

template <class Exec>
GrainTable CoupledSimulation<Exec>::grains() {
  return grains_ ? grains_->table() : GrainTable{};
}

template class CoupledSimulation<exec::CompiledBackend>;

template <class Exec>
std::unique_ptr<Simulation> make_simulation_on(const Exec& exec, const SimulationInput& input) {
  return std::make_unique<CoupledSimulation<Exec>>(exec, input);
}
template std::unique_ptr<Simulation> make_simulation_on(const exec::CompiledBackend&, const SimulationInput&);

}  // namespace gdesp
