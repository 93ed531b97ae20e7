// SPDX-License-Identifier: GPL-3.0-or-later
// The grains on one back end: state by slot, lists of contacts, sub-steps. Spheres, or in two dimensions discs of unit
// length that move in the plane x-z. Results do not depend on the number of threads.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "dem/body_path.hpp"
#include "dem/contact_parameters.hpp"
#include "dem/contact_rows.hpp"
#include "dem/wall_contacts.hpp"
#include "exec/batch.hpp"
#include "particles/particle_tables.hpp"

namespace gdesp::dem {

/// Sums over the grains, in double precision, and extremes. Velocities are those of time n.
struct GrainSums {
  Index particles = 0;
  double mass = 0.0;              ///< kg
  Vec3d momentum;                 ///< kg m/s, of the half-step velocities (conserved to round-off)
  double kinetic_energy = 0.0;    ///< J, with rotation
  double potential_energy = 0.0;  ///< J, m g . (lower corner of the domain - r)
  double elastic_energy = 0.0;    ///< J, in grain-grain contacts, normal and tangential
  Index contacts = 0;             ///< touching pairs of grains
  Index wall_contacts = 0;
  float largest_speed = 0.0f;    ///< m/s
  float largest_overlap = 0.0f;  ///< overlap / diameter, over all sub-steps since the last call
};

template <class Exec>
class GrainSystem {
 public:
  /// `walls` in case coordinates, bodies at their start. Throws Error(input) for values that cannot be used: a
  /// diameter or density that is not positive, grains too large for the domain's blocks, contact parameters.
  GrainSystem(const Exec& exec, const Domain& domain, const GrainTable& grains, const ContactParameters& contact,
              const TriangleTable& walls, const Vec3d& gravity);

  /// s: `share` of the Rayleigh time (hertz) or of a quarter of the contact time (linear; line contacts of discs), and
  /// never more than a grain needs to move a tenth of a radius.
  double stable_time_step(double share) const;
  /// Release time (s) of each group of grains; held before. Groups without one are free from the start.
  void set_release_times(const std::vector<double>& by_group);
  /// The bodies over the interval of the next advance(); index: body number - 1.
  void set_bodies(const std::vector<BodyMotionState>& bodies);
  /// Advances by dt (s) in equal sub-steps. Throws Error(numerical) when a grain's speed leaves any sensible range.
  void advance(double dt, int substeps);
  double time() const { return time_; }  ///< s
  void set_time(double time) { time_ = time; }

  // State by slot, valid until the next advance().
  const ClusterSet<Exec>& set() const { return set_; }
  Index slots() const { return set_.slots(); }
  Index particles() const { return set_.particles(); }
  Index lost() const { return lost_; }  ///< grains that left the domain, so far
  GrainPlaces places() const { return {position_.data(), now_.data()}; }
  const FixedPosition* listed_positions() const { return position_.data(); }  ///< up to half a skin behind
  const GrainRecord* records() const { return now_.data(); }
  const std::uint32_t* ids() const { return id_.data(); }
  const std::int32_t* groups() const { return group_.data(); }
  double largest_radius() const { return largest_radius_; }  ///< m

  const Vec3f* velocities() const { return velocity_.data(); }  ///< m/s, at the half step behind now

  /// Sorts now: the order of slots changes, and set() finds grains where they are. advance() sorts only while no fluid
  /// is set, so slots stay what they are over a coupled step; call this before the lists of the coupling are made.
  void sort_grains();
  /// True when some grain may have left its cell in set() by more than a hundredth of a diameter: sort before lists
  /// are made from set().
  bool sorting_is_due() const;
  double largest_speed() const { return std::sqrt(static_cast<double>(speed2_)); }  ///< m/s, at the last sub-step
  long sorts() const { return sorts_; }                                             ///< changes with the order of slots

  // Coupling. The arrays are the caller's, by slot, all of them or none (dry grains), and must live until the next
  // set_fluid() or sort_grains() (which forgets them); drag_impulse is the system's own.
  void set_fluid(const FluidOnGrains& fluid);
  const Vec3d* drag_impulse() const { return drag_impulse_.data(); }  ///< N s, given by the fluid since the last clear
  void clear_drag_impulse();
  /// s: time for which the last advance() applied constant forces (half steps lag behind: not exactly its dt).
  double kicked() const { return kicked_; }

  /// What grains gave to bodies 1, 2, ... since the last call.
  std::vector<BodyImpulse> take_body_impulses();
  GrainSums sums();
  /// To the host, in the order of ids.
  GrainTable table() const;
  double skin() const { return skin_; }        ///< m, of the lists in use
  long rebuilds() const { return rebuilds_; }  ///< of the contact lists
  long substeps() const { return substeps_; }
  Index near_walls() const { return walls_.grains(); }

  /// Saves or loads the complete state, with the history of contacts (exec/state_archive.hpp): a system made of the same
  /// parameters and loaded from it goes on bit for bit. Loading throws Error(input) when the bytes are not such a state.
  template <class Archive>
  void archive(Archive& a);

 private:
  // Sorting and listing.
  void list_now();
  void rebuild(const std::vector<BodyMoment>& moments, bool sorted_anew);
  void sort();
  void list(const std::vector<BodyMoment>& moments);
  void follow_records();
  void apply_release();
  double moved_since_sorting() const;
  bool stale(const std::vector<BodyMoment>& moments) const;
  float largest_move2() const { return static_cast<float>(0.25 * skin_ * skin_); }  ///< m2, half the skin's square
  // Bodies; number 0 are the walls at rest.
  void choose_skin(double moved);
  double largest_body_move(const std::vector<BodyMoment>& moments) const;
  WallReach wall_reach();
  std::vector<BodyMoment> moments(double share, double duration) const;
  BodyMotionState body_state(std::size_t number) const;
  // Sub-steps and sums.
  int foreseen_substeps(double dt, int first, int substeps);
  template <class Law>
  void run(const ContactLaws<Law>& pair, const ContactLaws<Law>& wall, const HalfSteps& half, int in_batch);
  int take_measures(int given, double h);
  template <class Law>
  GrainSums sums_with(const ContactLaws<Law>& pair);
  void restore_lists(const std::vector<RowRange>& range, const std::vector<ContactRow>& rows,
                     const std::vector<RollingRow>& rolling, const std::vector<WallHistory>& wall_history);

  Exec exec_;
  Domain domain_;
  ContactLawSet laws_;
  ContactParameters contact_;
  Vec3d gravity_;
  double largest_radius_ = 0.0, smallest_radius_ = 0.0, mean_diameter_ = 0.0;
  double critical_time_ = 0.0, skin_ = 0.0;
  double time_ = 0.0, half_before_ = 0.0, kicked_ = 0.0;
  float moved2_ = 0.0f, speed2_ = 0.0f, overlap_ = 0.0f;
  double drift_ = 0.0;     // m: no grain moved farther since it was sorted
  double odometer_ = 0.0;  // m: no grain and body together moved farther since the start
  bool listed_ = false, must_rebuild_ = true;
  long rebuilds_ = 0, sorts_ = 0, substeps_ = 0, listed_at_ = 0;
  Index lost_ = 0;

  ClusterSet<Exec> set_;
  ContactRows<Exec> contacts_;
  WallContacts<Exec> walls_;
  std::vector<BodyMotionState> bodies_;
  std::vector<ListedPose> listed_poses_;
  std::vector<double> release_time_;
  std::vector<std::int32_t> held_group_;  ///< 1: still held

  Index slots_ = 0;                      ///< of the arrays below (input order before the first sort)
  Array<FixedPosition, Exec> position_;  ///< when the lists were made
  Array<std::uint32_t, Exec> id_;
  Array<std::int32_t, Exec> group_;
  Array<GrainRecord, Exec> now_, next_;  ///< next_ is room for what sorting and listing need
  Array<Vec3f, Exec> velocity_, spin_;   ///< at half steps
  Array<float, Exec> quiet_until_;       ///< odometer reading up to which a grain is far from walls
  FluidOnGrains fluid_;                  ///< pointers of the caller, and drag_impulse_
  Array<Vec3d, Exec> drag_impulse_;
  Array<exec::Largest, Exec> measure_;  ///< two a sub-step of a batch: of the walls, of the grains
  exec::Batch<Exec> batch_;             ///< sub-steps between two looks at their measures
  Array<std::int32_t, Exec> held_;
};

}  // namespace gdesp::dem
