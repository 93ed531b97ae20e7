// SPDX-License-Identifier: GPL-3.0-or-later
// The step sequence on one back end.
#pragma once

#include "coupling/grain_fluid_coupling.hpp"
#include "dem/grain_system.hpp"
#include "dem/rigid_bodies.hpp"
#include "simulation/far_lake.hpp"
#include "simulation/simulation.hpp"
#include "sph/fluid_system.hpp"

namespace gdesp {

template <class Exec>
class CoupledSimulation final : public Simulation {
 public:
  CoupledSimulation(const Exec& exec, const SimulationInput& input);

  double time() const override { return time_; }
  std::int64_t step_count() const override { return step_; }
  void step(double end) override;
  Diagnostics diagnostics() override;
  FluidTable fluid() override { return fluid_.table(density_lag_); }
  BoundaryTable boundary() override { return fluid_.wall_table(); }
  GrainTable grains() override;
  std::vector<BodyPose> bodies() override;
  std::vector<FarLakeTable> far_lakes() override;
  double last_time_step() const override { return last_dt_; }
  std::string limited_by() const override { return limited_by_; }
  StepState step_state() const override;
  double sound_speed() const override { return fluid_.parameters().sound_speed; }
  void set_caution(double step_factor, double sound_speed) override;
  void save(std::ostream& out) override;  // checkpoint.cpp
  void load(std::istream& in) override;

 private:
  template <class Archive>
  void archive(Archive& a);
  double choose_step(double end);
  void make_room_for(double dt);
  void note_move(double dt, double old_speed);
  void fluid_split_step(float dt);
  void fluid_verlet_step(float dt);
  // Bodies (rigid_step.cpp).
  void start_bodies(const SimulationInput& input);
  void place_bodies(double t);
  dem::BodyMoment body_moment(std::size_t b, double t) const;
  void measure_loads(bool mean_with_last);
  dem::BodyMotionState body_path(std::size_t b, double from, double dt) const;
  std::vector<dem::BodyImpulse> grains_between_bodies(double from, double dt, int substeps);
  void advance_solids(double dt);
  void advance_far_lakes(double dt, const std::vector<dem::BodyImpulse>& grains);
  const FarLake& far_lake_of(std::size_t b) const;
  std::vector<std::int32_t> prescribed_numbers() const;
  // Grains and coupling (coupled_grains.cpp).
  void start_grains(const SimulationInput& input);
  bool grains_in_water() const { return coupling_ && coupling_->in_contact(); }
  sph::Movers movers() const;
  void refresh_coupling(double fluid_move, bool fluid_sorted);
  void porosity_now(double ahead);
  void gather_forces();
  void couple_grains(double dt);
  int substeps_for(double dt) const;

  Exec exec_;
  SimulationInput input_;  ///< parameters; the particle tables are emptied after the start
  Domain domain_;
  sph::FluidSystem<Exec> fluid_;
  std::unique_ptr<dem::GrainSystem<Exec>> grains_;
  std::unique_ptr<coupling::GrainFluidCoupling<Exec>> coupling_;
  double coupling_moved_ = 0.0, coupling_skin_ = 0.0, grain_dt_ = 0.0, grain_speed_ = 0.0;
  long coupled_rebuild_ = -1;  ///< of the grains, when the coupling's lists were made
  bool water_reset_ = true;    ///< porosity 1 and no reaction are in place
  std::vector<sph::WallBodyState> body_states_;
  std::unique_ptr<dem::RigidBodies> rigid_;  ///< null: no free bodies
  double rigid_time_ = 0.0;                  ///< s, of their state and of the far lakes'
  struct LakeBehind {
    std::size_t body;
    FarLake lake;
  };
  std::vector<LakeBehind> far_lakes_;              ///< each behind one of the bodies
  std::vector<dem::BodyLoad> loads_, last_loads_;  ///< of the water: for the step under way; at the last pass
  std::vector<std::int32_t> loaded_;               ///< by body number: moves under the load of the water
  sph::FluidExtremes extremes_;
  double time_ = 0.0, last_dt_ = 0.0;
  double largest_move_ = 0.0;  ///< m, bound on what a particle moves in this step
  float density_lag_ = 0.0f;   ///< s; half a step that densities are behind (split)
  std::int64_t step_ = 0, rebuilds_ = 0;
  double step_factor_ = 1.0, acoustic_step_ = 0.0;
  const char* limited_by_ = "sound";
};

}  // namespace gdesp
