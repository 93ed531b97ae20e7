// SPDX-License-Identifier: GPL-3.0-or-later
// The step sequence on one back end.
#pragma once

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

 private:
  double choose_step(double end);
  void make_room_for(double dt);
  void split_step(float dt);
  void verlet_step(float dt);
  void place_bodies(double t);

  Exec exec_;
  SimulationInput input_;             ///< parameters; the particle tables are emptied after the start
  Domain domain_;
  sph::FluidSystem<Exec> fluid_;
  std::vector<sph::WallBodyState> body_states_;
  sph::FluidExtremes extremes_;
  double time_ = 0.0, last_dt_ = 0.0;
  float density_lag_ = 0.0f;          ///< s; half a step that densities are behind (split)
  std::int64_t step_ = 0, rebuilds_ = 0;
  const char* limited_by_ = "sound";
};

}  // namespace gdesp
