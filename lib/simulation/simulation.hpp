// SPDX-License-Identifier: GPL-3.0-or-later
// A running simulation, whatever its back end.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "simulation/simulation_input.hpp"

namespace gdesp {

/// What a simulation says about itself at one time. SI units.
struct Diagnostics {
  double time = 0.0;
  std::int64_t step = 0;
  double time_step = 0.0;
  std::string limited_by;  ///< what bound the time step: sound, force, viscosity, fixed, output
  double fluid_mass = 0.0, fluid_kinetic = 0.0, fluid_potential = 0.0, fluid_elastic = 0.0;
  Vec3d fluid_momentum;
  double grain_mass = 0.0, grain_kinetic = 0.0, grain_potential = 0.0, grain_elastic = 0.0;
  Vec3d grain_momentum;
  double body_kinetic = 0.0, body_potential = 0.0, body_elastic = 0.0;  ///< of free bodies and their contacts
  Vec3d body_momentum;
  double far_lake_mass = 0.0, far_lake_kinetic = 0.0, far_lake_potential = 0.0;  ///< potential: from its bed
  double far_lake_momentum = 0.0;                                                ///< along x
  double far_lake_highest = 0.0;  ///< largest rise of a column over its depth at rest
  std::int64_t far_lakes = 0;
  double largest_body_speed = 0.0;  ///< m/s, of any point of a free body
  std::int64_t free_bodies = 0;
  double largest_speed = 0.0;                      ///< m/s, water
  double largest_grain_speed = 0.0;                ///< m/s
  double mach = 0.0;                               ///< largest speed of water / sound speed
  double largest_density_error = 0.0;              ///< |rho/rho0 - 1|
  double largest_overlap = 0.0;                    ///< overlap / diameter
  double deepest_in_wall = 0.0;                    ///< water behind the true surface of a wall, over dp
  std::uint32_t deepest_in_wall_id = 0xffffffffu;  ///< of that particle
  std::int64_t fluid_particles = 0, wall_particles = 0, grains = 0;
  std::int64_t lost_fluid = 0, lost_grains = 0;
  std::int64_t rebuilds = 0, grain_substeps = 0;
  double awake_share = 1.0;  ///< of the water (clusters that the passes run over)
};

/// State of a rigid body for output.
struct BodyPose {
  Vec3d centre, velocity, angular_velocity;
  double rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  bool present = true;
  Vec3d force, torque;  ///< N, N m about the centre: free bodies, of all but gravity; others, of the water
};

/// What every step leaves behind at no cost. SI units.
struct StepState {
  double time_step = 0.0;      ///< s, of the step just taken
  double acoustic_step = 0.0;  ///< s, what the sound speed alone would have allowed; 0 without water
  double mach = 0.0;
  double largest_density_error = 0.0;
};

class Simulation {
 public:
  virtual ~Simulation() = default;

  virtual double time() const = 0;
  virtual std::int64_t step_count() const = 0;
  /// One step of the fluid (with all sub-steps of grains), not past `end` (s).
  virtual void step(double end) = 0;
  virtual Diagnostics diagnostics() = 0;
  virtual FluidTable fluid() = 0;
  virtual BoundaryTable boundary() = 0;
  virtual GrainTable grains() = 0;
  virtual std::vector<BodyPose> bodies() = 0;
  virtual std::vector<FarLakeTable> far_lakes() = 0;
  /// s, and what bound it: of the step just taken.
  virtual double last_time_step() const = 0;
  virtual std::string limited_by() const = 0;
  virtual StepState step_state() const = 0;
  virtual double sound_speed() const = 0;  ///< m/s
  /// For a run in trouble: steps of water and grains are `step_factor` (0 to 1) of what they would be, and the sound
  /// speed is `sound_speed` (m/s), pressures staying as they are. 1 and sound_speed() change nothing, to the last bit.
  virtual void set_caution(double step_factor, double sound_speed) = 0;
  /// The complete state as bytes. A simulation made from the same input on the same kind of device and loaded with it
  /// goes on bit for bit as the saved one. load() throws Error(input) when the bytes are not such a state.
  virtual void save(std::ostream& out) = 0;
  virtual void load(std::istream& in) = 0;

  void advance_to(double end) {
    while (time() < end) step(end);
  }
};

/// Device: "cpu", "cuda", "cuda:N" or "auto" (a GPU when there is one). Throws Error(resource).
std::unique_ptr<Simulation> make_simulation(const SimulationInput& input, const std::string& device);
/// The device "auto" would take: "cpu" or "cuda:0".
std::string resolve_device(const std::string& device);

}  // namespace gdesp
