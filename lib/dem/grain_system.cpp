// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem/grain_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "dem/grain_motion.hpp"
#include "dem/grain_step.hpp"
#include "dem/grain_tables.hpp"
#include "dem/time_step_limits.hpp"
#include "exec/permute.hpp"

namespace gdesp::dem {
namespace {

constexpr int largest_batch = 32;  // sub-steps given before their measures are looked at

GDESP_HD inline GrainRecord padding_record() {
  GrainRecord record{};
  record.radius = no_radius;
  record.mass = 1.0f;
  record.wall = -1;
  return record;
}

// Both buffers, so that padding and the dummy behind the last slot are in each.
struct GatherRecords {
  const Index* source;
  const GrainRecord* from;
  Index slots;
  GrainRecord* now;
  GDESP_HD void operator()(Index slot) const {
    now[slot] = slot == slots || source[slot] < 0 ? padding_record() : from[source[slot]];
  }
};
struct CopyRecords {
  const GrainRecord* from;
  GrainRecord* to;
  GDESP_HD void operator()(Index slot) const { to[slot] = from[slot]; }
};

// Grains are listed where they are.
struct FollowRecords {
  GrainPlaces grains;
  FixedPosition* listed;
  GDESP_HD void operator()(Index i) const {
    if (grains.record[i].radius > 0.0f) listed[i] = grains[i];
  }
};
// After sorting: positions inside the periods.
struct WrapGrains {
  Domain domain;
  const GrainRecord* record;
  FixedPosition* position;
  GDESP_HD void operator()(Index i) const {
    if (record[i].radius > 0.0f) position[i] = domain.wrapped(position[i]);
  }
};

struct Release {
  const std::int32_t* group;
  const std::int32_t* held;  // by group; groups beyond are free
  Index groups;
  GrainRecord* now;
  GDESP_HD void operator()(Index i) const {
    GrainRecord& r = now[i];
    if (r.radius < 0.0f) return;
    const std::int32_t g = group[i];
    const bool free = g < 0 || g >= groups || !held[g];
    if (free && r.mobility == 0.0f) r.mobility = just_released;
    if (!free) r.mobility = 0.0f;
    if (!free) r.vx = r.vy = r.vz = r.sx = r.sy = r.sz = 0.0f;
  }
};

// Of the mean diameter.
constexpr double first_skin = 0.07, smallest_skin = 0.03, largest_skin = 0.5;

template <class Exec, class T>
void shrink_discard(const Exec&, Array<T, Exec>& array, Index size) {
  array.resize_discard(static_cast<std::size_t>(size));
}

}  // namespace

template <class Exec>
GrainSystem<Exec>::GrainSystem(const Exec& exec, const Domain& domain, const GrainTable& grains,
                               const ContactParameters& contact, const TriangleTable& walls, const Vec3d& gravity)
    : exec_(exec), domain_(domain), laws_(make_contact_laws(contact, domain.dimensions)), contact_(contact),
      gravity_(gravity), contacts_(exec, contact.rolling_friction > 0.0), position_(exec), id_(exec), group_(exec),
      now_(exec), next_(exec), velocity_(exec), spin_(exec), quiet_until_(exec), drag_impulse_(exec), measure_(exec),
      batch_(exec), held_(exec) {
  const GrainStart state = make_grain_start(domain, grains);
  largest_radius_ = state.largest_radius;
  smallest_radius_ = state.smallest_radius;
  mean_diameter_ = 2.0 * state.mean_radius;
  skin_ = (contact.skin > 0.0 ? contact.skin : first_skin) * mean_diameter_;
  critical_time_ = critical_time(state, contact, laws_);
  // Cells as wide as the commonest reach; separations must stay below half a tile.
  const double reach = 2.0 * largest_radius_ + std::max(skin_, largest_skin * mean_diameter_);
  check_reach(domain, reach);
  set_ = ClusterSet<Exec>(exec, domain, std::max(2.0 * state.mean_radius + skin_, 1.0e-3 * domain.tile_size.x), 1);
  walls_ =
      WallContacts<Exec>(exec, domain, make_wall_mesh(walls, 1.0e-5 * smallest_radius_, domain.dimensions, 8.0 * reach),
                         std::max(state.mass, 1.0e-30) * std::ldexp(1.0, -50));
  slots_ = static_cast<Index>(state.record.size());
  position_.assign(state.position);
  id_.assign(state.id);
  group_.assign(state.group);
  now_.assign(state.record);
  velocity_.assign(state.velocity);
  spin_.assign(state.spin);
  quiet_until_.assign(std::vector<float>(state.record.size(), 0.0f));
  speed2_ = state.speed2;
  measure_.resize_discard(2 * largest_batch);
  list_now();
}

template <class Exec>
double GrainSystem<Exec>::stable_time_step(double share) const {
  const double contact = share * critical_time_;
  const double speed = std::sqrt(static_cast<double>(speed2_));
  return speed > 0.0 ? std::min(contact, 0.1 * smallest_radius_ / speed) : contact;
}

template <class Exec>
void GrainSystem<Exec>::set_release_times(const std::vector<double>& by_group) {
  release_time_ = by_group;
  held_group_.assign(by_group.size(), 0);
  for (std::size_t g = 0; g < by_group.size(); ++g) held_group_[g] = by_group[g] > time_ ? 1 : 0;
  apply_release();
}

template <class Exec>
void GrainSystem<Exec>::apply_release() {
  held_.assign(held_group_);
  exec::parallel_for(exec_, "dem::release", slots_,
                     Release{group_.data(), held_.data(), static_cast<Index>(held_group_.size()), now_.data()});
  must_rebuild_ = true;
}

template <class Exec>
void GrainSystem<Exec>::set_bodies(const std::vector<BodyMotionState>& bodies) {
  bodies_ = bodies;
}

template <class Exec>
std::vector<BodyMoment> GrainSystem<Exec>::moments(double share, double duration) const {
  std::vector<BodyMoment> all(static_cast<std::size_t>(walls_.bodies()));
  for (std::size_t b = 1; b < all.size() && b <= bodies_.size(); ++b) all[b] = body_at(bodies_[b - 1], share, duration);
  return all;
}

template <class Exec>
BodyMotionState GrainSystem<Exec>::body_state(std::size_t number) const {
  return number >= 1 && number <= bodies_.size() ? bodies_[number - 1] : BodyMotionState{};
}

template <class Exec>
double GrainSystem<Exec>::largest_body_move(const std::vector<BodyMoment>& moments) const {
  double largest = 0.0;
  for (std::size_t b = 1; b < moments.size() && b < listed_poses_.size(); ++b) {
    const BodyMotionState state = body_state(b);
    // A body that vanishes or comes back changes everything.
    if (listed_poses_[b].present != state.present) return std::numeric_limits<double>::infinity();
    const double reach = walls_.body_reach(static_cast<int>(b), state.centre_initial);
    if (state.present) largest = std::max(largest, moved_since(listed_poses_[b], moments[b], reach));
  }
  return largest;
}

template <class Exec>
bool GrainSystem<Exec>::stale(const std::vector<BodyMoment>& moments) const {
  return must_rebuild_ || moved2_ > largest_move2() || largest_body_move(moments) > 0.5 * skin_;
}

template <class Exec>
WallReach GrainSystem<Exec>::wall_reach() {
  return {static_cast<float>(skin_), odometer_, 3.0 * largest_radius_, quiet_until_.data()};
}

template <class Exec>
void GrainSystem<Exec>::follow_records() {
  exec::parallel_for(exec_, "dem::positions", slots_, FollowRecords{places(), position_.data()});
}

template <class Exec>
void GrainSystem<Exec>::sort() {
  set_.build(position_, id_, slots_, next_);
  lost_ += set_.lost();
  slots_ = set_.slots();
  const Index* source = set_.source();
  shrink_discard(exec_, next_, slots_ + 1);
  exec::parallel_for(exec_, "dem::sort", slots_ + 1, GatherRecords{source, now_.data(), slots_, next_.data()});
  now_.swap(next_);
  exec::permute(exec_, position_, next_, source, slots_, FixedPosition{});
  exec::permute(exec_, id_, next_, source, slots_, no_particle);
  exec::permute(exec_, group_, next_, source, slots_, std::int32_t{0});
  exec::permute(exec_, velocity_, next_, source, slots_, Vec3f{});
  exec::permute(exec_, spin_, next_, source, slots_, Vec3f{});
  exec::permute(exec_, quiet_until_, next_, source, slots_, 0.0f);
  exec::parallel_for(exec_, "dem::sort", slots_, WrapGrains{domain_, now_.data(), position_.data()});
  drift_ = 0.0;
  ++sorts_;
  set_fluid({});
}

template <class Exec>
void GrainSystem<Exec>::list(const std::vector<BodyMoment>& moments) {
  listed_poses_.clear();
  for (std::size_t b = 0; b < moments.size(); ++b) listed_poses_.push_back(listed_pose(body_state(b), moments[b]));
}

// Listing costs about four sub-steps; a skin of s diameters lengthens a sub-step by about 0.6 s of itself. With grains
// that move `rate` metres a sub-step lists last s/(2 rate): the sum is least at s = sqrt(13 rate d).
template <class Exec>
void GrainSystem<Exec>::choose_skin(double moved) {
  const long steps = substeps_ - listed_at_;
  listed_at_ = substeps_;
  if (contact_.skin > 0.0 || steps == 0) return;
  const double best = std::sqrt(13.0 * moved / static_cast<double>(steps) * mean_diameter_);
  skin_ = std::clamp(std::sqrt(best * skin_), smallest_skin * mean_diameter_, largest_skin * mean_diameter_);
}

template <class Exec>
void GrainSystem<Exec>::rebuild(const std::vector<BodyMoment>& moments, bool sorted_anew) {
  follow_records();
  const double moved = std::sqrt(static_cast<double>(moved2_)), body_move = largest_body_move(moments);
  drift_ += moved;
  odometer_ += moved + body_move;
  if (!(odometer_ < 1.0e2 * largest_radius_) || must_rebuild_) {  // readings are in single precision: start anew
    odometer_ = 0.0;
    quiet_until_.fill_bytes(0);
  }
  choose_skin(moved);
  if (sorted_anew) sort();
  list(moments);
  contacts_.build(set_, sorted_anew ? set_.source() : nullptr, now_.data(), position_.data(),
                  {static_cast<float>(largest_radius_), static_cast<float>(skin_), static_cast<float>(drift_)},
                  !listed_, next_);
  if (!walls_.empty()) { walls_.build(set_, position_, now_.data(), listed_poses_, wall_reach(), !listed_, next_); }
  shrink_discard(exec_, next_, slots_ + 1);
  exec::parallel_for(exec_, "dem::sort", slots_ + 1, CopyRecords{now_.data(), next_.data()});
  listed_ = true;
  must_rebuild_ = false;
  moved2_ = 0.0f;
  ++rebuilds_;
}

template <class Exec>
double GrainSystem<Exec>::moved_since_sorting() const {
  return drift_ + std::sqrt(static_cast<double>(moved2_));
}

template <class Exec>
bool GrainSystem<Exec>::sorting_is_due() const {
  return moved_since_sorting() > 0.02 * largest_radius_;
}

template <class Exec>
void GrainSystem<Exec>::sort_grains() {
  // With the bodies where they were listed: they have not moved since the last sub-step.
  rebuild(moments(1.0, 0.0), true);
}

template <class Exec>
void GrainSystem<Exec>::set_fluid(const FluidOnGrains& fluid) {
  fluid_ = fluid;
  if (!fluid.drag_coefficient) return;
  if (drag_impulse_.size() != static_cast<std::size_t>(slots_)) {
    shrink_discard(exec_, drag_impulse_, slots_);
    clear_drag_impulse();
  }
  fluid_.drag_impulse = drag_impulse_.data();
}

template <class Exec>
void GrainSystem<Exec>::clear_drag_impulse() {
  drag_impulse_.fill_bytes(0);
}

// Sub-steps are given in batches and their measures read once a batch. The gate of a sub-step is the measure of the one
// before: when that used the skin up, the rest of the batch is left out, as if each had been waited for.
template <class Exec>
template <class Law>
void GrainSystem<Exec>::run(const ContactLaws<Law>& pair, const ContactLaws<Law>& wall, const HalfSteps& half,
                            int in_batch) {
  const float inertia = inertia_factor(domain_.dimensions);
  exec::Largest* measure = measure_.data() + 2 * in_batch;
  exec::Gate gate;
  if (in_batch > 0) gate = {measure - 1, largest_move2()};
  if (walls_.grains() > 0) { walls_.step(wall, {places(), half, inertia}, in_batch, gate, measure); }
  GrainStepView view{contacts_.view(),
                     position_unit(domain_),
                     places(),
                     next_.data(),
                     velocity_.data(),
                     spin_.data(),
                     walls_.forces(),
                     fluid_,
                     static_cast<Vec3f>(gravity_),
                     inertia,
                     domain_.dimensions == 2,
                     half};
  run_grain_step(exec_, pair, view, slots_, gate, measure + 1);
  now_.swap(next_);
}

// How many sub-steps from `first` on the bodies allow with the lists at hand, one at least; sets their poses.
template <class Exec>
int GrainSystem<Exec>::foreseen_substeps(double dt, int first, int substeps) {
  const int most = std::min(substeps - first, largest_batch);
  std::vector<BodyPose> poses;
  int count = 0;
  for (; count < most; ++count) {
    const std::vector<BodyMoment> moment = moments(static_cast<double>(first + count) / substeps, dt);
    if (count > 0 && largest_body_move(moment) > 0.5 * skin_) break;
    for (std::size_t b = 0; b < moment.size(); ++b)
      poses.push_back(pose_since(listed_poses_[b], body_state(b), moment[b]));
  }
  walls_.set_poses(poses);
  return count;
}

// Looks at what a batch found; returns how many of its sub-steps were taken.
template <class Exec>
int GrainSystem<Exec>::take_measures(int given, double h) {
  const std::vector<exec::Largest> measure = measure_.to_host();
  int taken = 0;
  while (taken < given) {
    const exec::Largest& grains = measure[static_cast<std::size_t>(2 * taken + 1)];
    if (walls_.grains() > 0)
      overlap_ = std::max(overlap_, measure[static_cast<std::size_t>(2 * taken)].value[measure_overlap]);
    moved2_ = grains.value[measure_displacement2];
    speed2_ = grains.value[measure_speed2];
    overlap_ = std::max(overlap_, grains.value[measure_overlap]);
    if (grains.value[measure_broken] > 0.0f) {
      throw Error(ErrorKind::numerical,
                  "grains: a speed of more than 1e6 m/s, or not a number, at t = " + std::to_string(time_) +
                      " s, sub-step " + std::to_string(substeps_ + taken) + " of " + std::to_string(h) +
                      " s; a smaller grain time step or softer initial packing is needed");
    }
    ++taken;
    if (moved2_ > largest_move2()) break;
  }
  if ((given - taken) % 2 != 0) now_.swap(next_);  // those left out have swapped, and written nothing
  return taken;
}

template <class Exec>
void GrainSystem<Exec>::advance(double dt, int substeps) {
  for (std::size_t g = 0; g < held_group_.size(); ++g) {
    if (held_group_[g] && release_time_[g] <= time_ + 1.0e-9 * dt) {
      held_group_[g] = 0;
      apply_release();
    }
  }
  const double h = dt / substeps;
  kicked_ = half_before_ + (substeps - 0.5) * h;
  for (int k = 0; k < substeps;) {
    const std::vector<BodyMoment> now = moments(static_cast<double>(k) / substeps, dt);
    if (stale(now)) rebuild(now, !fluid_.drag_coefficient);  // sorting costs a tenth of listing
    const int batch = foreseen_substeps(dt, k, substeps);
    batch_.give([&] {
      double half_before = half_before_;
      for (int b = 0; b < batch; ++b, half_before = 0.5 * h) {
        const HalfSteps half{static_cast<float>(half_before), static_cast<float>(0.5 * h)};
        if (laws_.kind == ContactLawKind::hertz) {
          run(laws_.hertz, laws_.hertz_wall, half, b);
        } else {
          run(laws_.linear, laws_.linear_wall, half, b);
        }
      }
    });
    const int taken = take_measures(batch, h);
    half_before_ = 0.5 * h;
    substeps_ += taken;
    k += taken;
  }
  time_ += dt;
}

template <class Exec>
std::vector<BodyImpulse> GrainSystem<Exec>::take_body_impulses() {
  return walls_.take_impulses();
}

template <class Exec>
void GrainSystem<Exec>::list_now() {
  rebuild(moments(0.0, 0.0), true);
}

template class GrainSystem<exec::CompiledBackend>;

}  // namespace gdesp::dem
