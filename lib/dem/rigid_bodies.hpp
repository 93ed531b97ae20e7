// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid bodies that move freely: their state, contacts with walls, prescribed bodies and each other, and the parts of a
// step (dem/rigid_motion.hpp). They are few, so they live on the host; what water and grains do to them comes as sums.
// Body number b is bodies[b - 1]; number 0 are the walls at rest.
#pragma once

#include <vector>

#include "dem/body_motion.hpp"
#include "dem/body_path.hpp"
#include "dem/contact_parameters.hpp"
#include "dem/rigid_contact_law.hpp"
#include "dem/rigid_motion.hpp"
#include "dem/rigid_surface.hpp"

namespace gdesp::dem {

/// Force (N) and torque (N m) about the centre, world axes.
struct BodyLoad {
  Vec3d force, torque;
};

struct RigidState {
  Vec3d centre, velocity;  ///< m, m/s
  Vec3d angular_momentum;  ///< kg m2/s, about the centre, world axes
  Quaternion orientation;  ///< from principal to world axes
  BodyLoad fluid, solid;   ///< of the last step: of water; of walls, bodies and grains
  std::int32_t free = 0;   ///< 1: moves; 0: still held, or prescribed
  std::int32_t reserved = 0;
};

/// Sums over the free bodies.
struct RigidSums {
  double kinetic_energy = 0.0, potential_energy = 0.0, elastic_energy = 0.0;  ///< J; potential: -m g . r
  Vec3d momentum, angular_momentum;                                           ///< kg m/s; kg m2/s about the origin
};

class RigidBodies {
 public:
  /// `spacing`: of contact points, m. Throws Error(input) for a free body without mass, inertia or surface.
  RigidBodies(const std::vector<Body>& bodies, const TriangleTable& walls, const ContactParameters& contact,
              const Vec3d& gravity, double spacing, int dimensions);
  /// The still water (kg/m3, m) whose pressure friction feels between a body and the ground. Default: none.
  void set_still_water(double density, double level) {
    water_density_ = density;
    water_level_ = level;
  }

  std::size_t count() const { return state_.size(); }
  bool is_free_kind(std::size_t b) const { return bodies_[b].kind == BodyKind::free; }
  const RigidState& state(std::size_t b) const { return state_[b]; }
  double mass(std::size_t b) const { return bodies_[b].mass; }
  /// m/s: no point of a free body moves faster.
  double largest_speed() const;
  /// Where free body b is; `ahead` (s): where it will be when nothing acts, and with what velocity it goes there.
  BodyMoment moment(std::size_t b, double ahead = 0.0) const;
  /// Sets a body with prescribed motion for the contacts to come. `present` false: removed.
  void place_prescribed(std::size_t b, const BodyMoment& moment, bool present);
  /// Lets go of bodies whose time has come (s).
  void release(double time);

  /// Steps of this length (s) resolve the contacts that may act now; infinite when nothing is near.
  double contact_time_step();
  /// Sets the loads of the last step to zero; substep() adds to them, `share` of the step each.
  void begin_step();
  void set_fluid_load(std::size_t b, const BodyLoad& load) { state_[b].fluid = load; }
  /// One step h (s). `grains`: impulses over h by body number, empty when there are none.
  void substep(double h, double share, const std::vector<BodyImpulse>& grains);
  RigidSums sums() const;
  /// The deepest contact point now, m.
  double largest_depth() const { return largest_depth_; }
  /// Throws Error(numerical) when a body has no finite state or its centre has left [lower, upper].
  void check(const Vec3d& lower, const Vec3d& upper, double time) const;

  template <class Archive>
  void archive(Archive& a) {
    a(state_, other_, present_, memory_, listed_, triangle_, largest_depth_);
  }

 private:
  struct PointMemory {  ///< a point near another body
    std::int32_t body, other, point;
    std::int32_t first, count;  ///< its triangles
    std::int32_t touching;
    double first_depth;  ///< m, from where the depth counts
    double depth;        ///< m, of the last step
    Vec3d tangential;    ///< N
  };
  struct Found {  ///< a touch of this moment
    std::size_t memory;
    PointTouch touch;
    Vec3d place;  ///< m, where the two meet
  };

  BodyMoment moment_of(std::int32_t number) const;
  bool moves(std::int32_t number) const { return number > 0 && state_[static_cast<std::size_t>(number - 1)].free; }
  bool is_there(std::int32_t number) const { return number == 0 || present_[static_cast<std::size_t>(number - 1)]; }
  Vec3d start_centre(std::int32_t number) const;
  Vec3d to_start(std::int32_t number, const BodyMoment& m, const Vec3d& world) const;
  Vec3d point_now(std::int32_t body, std::int32_t point, const BodyMoment& m) const;
  ListedPose pose_of(std::int32_t number) const;
  bool lists_are_stale() const;
  void list();
  void list_pair(std::int32_t body, std::int32_t other);
  NearestPlace place_of(const PointMemory& p, const Vec3d& point, const BodyMoment& other) const;
  void note_first_depths();
  double normal_energy() const;
  double pore_force(const PointMemory& p, const Vec3d& place) const;
  std::vector<Found> find_touches();
  void add_force(const Found& found, double h, std::vector<BodyLoad>& loads);
  void kick(std::size_t b, double h, const BodyLoad& solid);
  void drift(double h);
  void constrain(std::size_t b);

  std::vector<Body> bodies_;
  std::vector<Vec3d> inertia_;                    ///< principal moments
  std::vector<Quaternion> principal_;             ///< principal axes at the start
  std::vector<double> reach_;                     ///< m, farthest corner from the centre
  std::vector<std::vector<SurfacePoint>> point_;  ///< contact points
  WallMesh mesh_;
  RigidContactLaw law_;
  Vec3d gravity_;
  double spacing_ = 0.0, water_density_ = 0.0, water_level_ = 0.0;
  int dimensions_ = 3;
  std::vector<RigidState> state_;
  std::vector<BodyMoment> other_;  ///< of prescribed bodies
  std::vector<std::int32_t> present_;
  std::vector<PointMemory> memory_;  ///< by body, other, point
  std::vector<ListedPose> listed_;   ///< by body number, when the lists were made
  std::vector<Index> triangle_;
  double largest_depth_ = 0.0;
};

}  // namespace gdesp::dem
