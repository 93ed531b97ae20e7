// SPDX-License-Identifier: GPL-3.0-or-later
// The water and its walls on one back end: state by slot, lists, and the passes and updates that the time schemes
// are made of (simulation/). Water and walls are two ClusterSets with cells two spacings wide.
#pragma once

#include <vector>

#include "neighbors/cluster_list.hpp"
#include "particles/particle_tables.hpp"
#include "sph/activity.hpp"
#include "sph/fluid_parameters.hpp"
#include "sph/fluid_views.hpp"
#include "sph/particle_shifting.hpp"
#include "sph/pressure_and_viscosity.hpp"

namespace gdesp::sph {

/// Largest values over the fluid, for the time step and the guard.
struct FluidExtremes {
  float speed2 = 0.0f;         ///< (m/s)^2
  float acceleration2 = 0.0f;  ///< (m/s2)^2, without gravity at rest counted
  float density_error = 0.0f;  ///< |rho/rho0 - 1|, true density; compression only where water cavitates
  int non_finite = 0;
};

/// Sums over the fluid, in double precision.
struct FluidSums {
  double mass = 0.0;              ///< kg
  Vec3d momentum;                 ///< kg m/s
  double kinetic_energy = 0.0;    ///< J
  double potential_energy = 0.0;  ///< J, m g . (origin - r)
  double elastic_energy = 0.0;    ///< J, of compression
  Index particles = 0;
};

/// The particle that is deepest behind the true surface of a wall, by the distance that the wall guard uses.
struct DeepestInWall {
  float depth = 0.0f;  ///< m; 0: none is
  std::uint32_t id = no_particle;
};

/// Where a body is now, for its wall particles: r = centre + R (r_start - centre_start).
struct WallBodyState {
  Vec3d centre_start, centre;                       ///< m, case coordinates
  float rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< R, row by row
  Vec3f velocity, angular_velocity;                 ///< m/s, rad/s
  Vec3f acceleration;                               ///< m/s2, of the centre
  int present = 1;                                  ///< 0: removed
};

/// What the water does to a body: force (N) and torque (N m) about its centre.
struct WallLoad {
  Vec3d force, torque;
};
/// The pass whose reaction a load is: the light one may know no-slip ghosts and tensile control.
enum class LoadsOf { momentum_pass, combined_pass };

template <class Exec>
class FluidSystem {
 public:
  FluidSystem(const Exec& exec, const Domain& domain, const FluidParameters& parameters, const FluidTable& fluid,
              const BoundaryTable& walls);

  // State, by slot.
  Index slots() const { return set_.slots(); }
  Index particles() const { return set_.particles(); }
  Index wall_particles() const { return wall_set_.particles(); }
  Index lost() const { return lost_; }
  std::size_t list_entries() const { return fluid_fluid_.entries(); }  ///< of water with water
  ClusterListView fluid_list() const { return fluid_fluid_.view(); }
  FluidPairLaw pair_law() const;  ///< coefficients of the pair terms
  const FluidParameters& parameters() const { return parameters_; }
  const ClusterSet<Exec>& set() const { return set_; }
  const ClusterSet<Exec>& wall_set() const { return wall_set_; }
  const float* records() const { return record_.data(); }
  float* mixture_records() { return record_.data(); }  ///< for the mixture pressure of coupled runs
  const float* wall_records() const { return wall_record_.data(); }
  const FixedPosition* positions() const { return position_.data(); }
  float* porosity() {
    porous_ = true;
    return porosity_.data();
  }  ///< per slot, to be written; coupled runs only
  const float* porosity() const { return porosity_.data(); }
  Vec3f* external_acceleration() { return external_.data(); }     ///< per slot, m/s2: the reaction of grains
  const float* mass_share() const { return mass_share_.data(); }  ///< null: 1
  const float* densities() const { return density_.data(); }      ///< per slot, D of the superficial density
  const float* rates() const { return rate_.data(); }             ///< ax ay az dD, 4 each, per cluster
  const std::uint32_t* ids() const { return id_.data(); }
  /// Allocates what coupling needs: porosity (1) and external acceleration (0) by slot.
  void enable_coupling();
  /// No grains in reach: porosity 1, no reaction.
  void reset_coupling();
  bool coupled() const { return coupled_; }
  bool walls_move() const { return walls_move_; }
  /// At the start, once porosity is known: superficial densities of water that fills pores at its true density, and
  /// masses where the table has more particles than the pores have room for. `first`: densities are still the true
  /// ones, and are kept; again, with a better porosity, before anything is sorted.
  void fill_pores(bool first);

  // Neighbours.
  /// Sorts both sets and builds the lists. The skin suits particles that move `move_per_step` metres a step, and serves
  /// for a first step of at most `next_move`.
  /// Where water may sleep, decides who is awake at time t (s); `movers` wake the water around them.
  void rebuild(double move_per_step, double t = 0.0, const Movers& movers = {}, double next_move = 0.0);
  /// Lets the next momentum or combined pass trim the lists, when that pays, to what the passes of this step need.
  /// Called in mid-step, records packed, by steps in which no particle moves more than `move` (m) in all.
  void trim_lists(double move);
  /// True when some particle may have moved more than half the skin since the last rebuild, or sleeping water has not
  /// been looked at for a while.
  bool lists_are_stale(double next_move) const;
  void note_move(double metres) { moved_ += metres, ++steps_since_rebuild_; }  ///< in the step that is done, at most

  // Activity (sph/activity.hpp; fluid_activity.cpp).
  /// Once the water has settled, unless it sleeps already.
  bool may_fall_asleep(double t) const {
    return parameters_.activity.sleep && !needs_spacing() && !sleeps_ && particles() > 0 &&
           t >= parameters_.activity.settle_time;
  }
  /// Between two steps, once accelerations are there: water that is still and whose forces balance falls asleep.
  void start_sleeping(double t, const Movers& movers);
  Index awake_clusters() const { return sleeps_ ? awake_.count() : set_.clusters(); }
  Index near_wall_clusters() const { return near_walls_.count(); }

  // Parts of a step (simulation/time_schemes).
  void half_drift(float dt_position, float dt_density);  ///< r += v dt_position, D += dD dt_density, pack
  void extrapolate_walls();
  void find_walls();    ///< for the wall guard of kick_drift
  void spacing_pass();  ///< for shifting and tensile control
  void momentum_pass();
  void continuity_pass();
  void combined_pass();
  void wall_continuity_pass();  ///< `dynamic` walls
  /// v += a dt, r += v dt_position, pack; with shifting, `fastest` (m/s) is the largest speed (sph.shifting).
  void kick_drift(float dt, float dt_position, float fastest);
  void verlet_predict(float dt);                              ///< paper A.3; records hold the predicted v and rho
  void verlet_correct(float dt);                              ///< paper A.1, A.2
  void evolve_dynamic_walls(float dt);                        ///< D of wall particles, `dynamic` walls
  void move_walls(const std::vector<WallBodyState>& bodies);  ///< index: body number - 1
  void pack();                                                ///< records from the state
  /// Loads on bodies 1, 2, ... at the records of the momentum pass; `asked[number]`: 1 for those wanted (sph.body-load).
  std::vector<WallLoad> body_loads(const std::vector<std::int32_t>& asked, LoadsOf pass);

  FluidExtremes extremes();
  FluidSums sums();
  /// As of the last find_walls(); none where walls have no normals.
  DeepestInWall deepest_in_wall();
  /// m/s. Densities change so that every pressure stays as it is.
  void set_sound_speed(double c);
  /// To the host, in the order of ids. `density_lag` (s): what a staggered scheme still owes the densities.
  FluidTable table(float density_lag) const;
  BoundaryTable wall_table() const;

  /// The members that a checkpoint keeps (exec/state_archive.hpp).
  template <class Archive>
  void archive(Archive& a) {
    a(activity_, awake_, near_walls_, sleeps_, steps_since_rebuild_);
    a(parameters_.sound_speed, coupled_, porous_, moved_, skin_, trimmed_, trim_skin_, lost_, walls_move_, set_,
      wall_set_, fluid_fluid_, fluid_wall_, wall_fluid_);
    a(position_, velocity_, density_, id_, mass_share_, porosity_, external_, record_, rate_);
    a(wall_position_, wall_start_, wall_velocity_, wall_body_, wall_density_, wall_friction_, wall_id_, wall_record_,
      wall_rate_, wall_bodies_, guarded_, wall_normal_, wall_depth_, wall_surface_, near_wall_);
    a(surface_at_rest_, near_wall_at_rest_);
    a(wall_ghost_, spacing_, near_surface_, own_pressure_);
  }

 private:
  void start_fluid(const FluidTable& fluid);
  void start_walls(const BoundaryTable& walls);
  void sort_fluid();
  void sort_walls();
  void pack_walls();
  void spread_surface();
  void lattice_share_pass(float* share);  ///< V0 times particles a volume: water, walls
  void pack_all();
  void update_activity(double t, const Movers& movers);
  void build_lists();
  const Index* awake_list() const { return sleeps_ ? awake_.list() : nullptr; }
  Index awake_slots() const { return exec::cluster_size * awake_clusters(); }
  template <bool M, bool C>
  void run_fluid_pass(const char* name);
  template <bool M, bool C, Viscosity K>
  void run_fluid_pass_kind(const char* name);
  FluidStateView state_view();
  RecordPacker packer();
  bool needs_spacing() const { return parameters_.shifting > 0.0 || parameters_.tensile_control; }

  Exec exec_;
  Domain domain_;
  FluidParameters parameters_;
  bool coupled_ = false;
  bool porous_ = false;                     ///< some porosity may differ from 1
  double moved_ = 0.0, skin_ = 0.0;         ///< m
  double trimmed_ = 0.0, trim_skin_ = 0.0;  ///< m, moved since lists were trimmed, and their skin then (0: whole)
  bool trims_next_ = false;                 ///< the next pass of momentum trims
  Index lost_ = 0;
  ClusterSet<Exec> set_, wall_set_;
  ClusterList<Exec> fluid_fluid_, fluid_wall_, wall_fluid_;
  Activity<Exec> activity_;
  ClusterSelection<Exec> awake_, near_walls_;  ///< clusters of the water; of the walls, near awake water
  bool sleeps_ = false;                        ///< some water may be asleep: awake_ holds
  std::int32_t steps_since_rebuild_ = 0;

  // Water, by slot.
  Array<FixedPosition, Exec> position_;
  Array<Vec3f, Exec> velocity_;
  Array<float, Exec> density_;  ///< D = rho/rho0 - 1 of the superficial density
  Array<std::uint32_t, Exec> id_;
  Array<float, Exec> mass_share_;  ///< mass / (rho0 dp^dimensions); none: 1
  Array<float, Exec> porosity_;    ///< coupled runs only
  Array<Vec3f, Exec> external_;    ///< coupled runs only
  Array<float, Exec> record_;      ///< x y z B vx vy vz A, 4 each, per cluster
  Array<float, Exec> rate_;        ///< ax ay az dD, 4 each, per cluster: m/s2 and 1/s

  // Walls, by slot.
  Array<FixedPosition, Exec> wall_position_, wall_start_;  ///< the latter where walls move
  Array<Vec3f, Exec> wall_velocity_;
  Array<std::int32_t, Exec> wall_body_;
  Array<float, Exec> wall_density_;
  Array<float, Exec> wall_friction_;  ///< 1: no slip, 0: free slip
  Array<std::uint32_t, Exec> wall_id_;
  Array<float, Exec> wall_record_;
  Array<float, Exec> wall_rate_;  ///< by slot: d D/dt of `dynamic` walls (1/s); what others hand back (sph.wall.volume)
  Array<Vec3f, Exec> wall_normal_;        ///< into the water; 0: unknown. Kept, as depths are, where walls move
  Array<float, Exec> wall_depth_;         ///< m below the surface
  Array<float, Exec> wall_surface_;       ///< nx ny nz depth (m), 4 each, per cluster
  Array<float, Exec> surface_at_rest_;    ///< the same without normals of bodies, where walls move
  Array<float, Exec> near_wall_;          ///< of the water: six rows of 4 per cluster (sph/wall_guard.hpp)
  Array<float, Exec> near_wall_at_rest_;  ///< the same of walls that do not move, where others do
  bool guarded_ = false;                  ///< some wall particle knows its normal
  bool no_slip_ = false;                  ///< some wall particle has friction, and water viscosity
  Array<float, Exec>
      wall_ghost_;  ///< vx vy vz of no-slip walls and, on the way, the water's reach (m), 4 each, per cluster
  Array<float, Exec> spacing_;       ///< of the water: -grad C and D (sph/particle_shifting.hpp), 4 each
  Array<float, Exec> near_surface_;  ///< q of sph.shifting, by slot
  Array<float, Exec> own_pressure_;  ///< A_i under tensile control, by slot
  Array<WallBodyState, Exec> wall_bodies_;
  Array<std::int32_t, Exec> body_asked_;  ///< scratch of body_loads
  Array<std::int64_t, Exec> body_sum_;
  Array<float, Exec> body_force_;

  Array<float, Exec> filling_;  ///< while pores are filled: true D, lattice share, by slot
  bool walls_move_ = false;
};

}  // namespace gdesp::sph
