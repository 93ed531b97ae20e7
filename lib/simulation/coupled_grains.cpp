// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a step that concerns grains: sub-steps, and the coupling with the water.
#include <algorithm>
#include <cmath>

#include "coupling/averaging_length.hpp"
#include "simulation/coupled_simulation.hpp"

namespace gdesp {

template <class Exec>
void CoupledSimulation<Exec>::start_grains(const SimulationInput& input) {
  grains_ = std::make_unique<dem::GrainSystem<Exec>>(exec_, domain_, input.grains, input.contact, input.walls,
                                                     input.fluid_parameters.gravity);
  grains_->set_release_times(input.release_time);
  grain_dt_ = grains_->stable_time_step(input.time.grain_step_share);
  if (!input.coupling.enabled || fluid_.particles() == 0) return;
  fluid_.enable_coupling();
  const sph::FluidParameters& p = input.fluid_parameters;
  coupling::CouplingLaw law;
  law.drag = input.coupling.drag;
  law.smoothing_length = input.coupling.smoothing_length > 0.0
                             ? input.coupling.smoothing_length
                             : coupling::default_averaging_length(p.h, 2.0 * grains_->largest_radius(), p.dimensions);
  law.added_mass = input.coupling.added_mass;
  law.fluid_density = p.reference_density;
  law.dynamic_viscosity = p.reference_density * p.kinematic_viscosity;
  law.gravity = p.gravity;
  law.dp = p.dp;
  law.dimensions = p.dimensions;
  for (double d : input.coupling.real_diameter) law.real_diameter.push_back(static_cast<float>(d));
  coupling_ = std::make_unique<coupling::GrainFluidCoupling<Exec>>(exec_, domain_, law);
  coupling_skin_ = 0.12 * law.smoothing_length;
  refresh_coupling(0.0, true);
  if (coupling_->in_contact() && input.fluid.mass_share.empty()) { coupling_->start_porosity(*grains_, fluid_); }
}

template <class Exec>
sph::Movers CoupledSimulation<Exec>::movers() const {
  if (!grains_ || !coupling_) return {};
  return {grains_->listed_positions(), grains_->velocities(), grains_->ids(), grains_->slots(), true};
}

template <class Exec>
void CoupledSimulation<Exec>::refresh_coupling(double move, bool fluid_sorted) {
  // Dry grains are sorted as they please; grains in the water keep their slots between two rebuilds here.
  const bool grains_sorted = !grains_in_water() && coupled_rebuild_ != grains_->rebuilds();
  if (fluid_sorted || grains_sorted || coupling_moved_ + move > coupling_skin_) {
    if (grains_->sorting_is_due()) grains_->sort_grains();
    coupling_->rebuild(*grains_, fluid_, coupling_skin_);
    coupled_rebuild_ = grains_->rebuilds();
    coupling_moved_ = 0.0;
  }
  coupling_moved_ += move;
}

template <class Exec>
void CoupledSimulation<Exec>::porosity_now(double ahead) {
  if (!grains_in_water()) return;
  coupling_->place(*grains_, ahead);
  coupling_->update_porosity(*grains_, fluid_);
  fluid_.pack();
}

template <class Exec>
void CoupledSimulation<Exec>::gather_forces() {
  if (!grains_in_water()) return;
  water_reset_ = false;
  coupling_->gather_forces(*grains_, fluid_);
}

template <class Exec>
void CoupledSimulation<Exec>::couple_grains(double dt) {
  if (!grains_ && loaded_.empty()) return;
  if (!grains_in_water()) {
    if (coupling_ && !water_reset_) {
      fluid_.reset_coupling();
      grains_->set_fluid({});
      water_reset_ = true;
    }
    advance_solids(dt);
    return;
  }
  advance_solids(dt);
  coupling_->react(*grains_, fluid_, static_cast<float>(dt));
}

template <class Exec>
int CoupledSimulation<Exec>::substeps_for(double dt) const {
  return std::max(1, static_cast<int>(std::ceil(dt / (step_factor_ * grain_dt_) - 1e-9)));
}

using Backend = exec::CompiledBackend;
template void CoupledSimulation<Backend>::start_grains(const SimulationInput&);
template sph::Movers CoupledSimulation<Backend>::movers() const;
template void CoupledSimulation<Backend>::refresh_coupling(double, bool);
template void CoupledSimulation<Backend>::porosity_now(double);
template void CoupledSimulation<Backend>::gather_forces();
template void CoupledSimulation<Backend>::couple_grains(double);
template int CoupledSimulation<Backend>::substeps_for(double) const;

}  // namespace gdesp
