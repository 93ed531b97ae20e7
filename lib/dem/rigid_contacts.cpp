// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts of free bodies: which points are near which surfaces, and the forces of those that touch. The lists only leave
// out what cannot touch before they are made anew, so results do not depend on when that is.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "dem/rigid_bodies.hpp"

namespace gdesp::dem {
namespace {

// Of the spacing of points: the deepest contact that is seen, and how far lists reach beyond it.
constexpr double deepest = 2.0, list_skin = 1.0;
// Of the undamped period of the stiffest motion over 2 pi.
constexpr double step_share = 0.1;

}  // namespace

Vec3d RigidBodies::start_centre(std::int32_t number) const {
  if (number == 0 || !is_free_kind(static_cast<std::size_t>(number - 1))) return {};
  return bodies_[static_cast<std::size_t>(number - 1)].centre;
}

Vec3d RigidBodies::to_start(std::int32_t number, const BodyMoment& m, const Vec3d& world) const {
  if (number == 0) return world;
  const Vec3d a = world - m.centre;
  const double* r = m.rotation;
  return start_centre(number) + Vec3d{r[0] * a.x + r[3] * a.y + r[6] * a.z, r[1] * a.x + r[4] * a.y + r[7] * a.z,
                                      r[2] * a.x + r[5] * a.y + r[8] * a.z};
}

Vec3d RigidBodies::point_now(std::int32_t body, std::int32_t point, const BodyMoment& m) const {
  const auto b = static_cast<std::size_t>(body - 1);
  return m.centre + multiply(m.rotation, point_[b][static_cast<std::size_t>(point)].place - bodies_[b].centre);
}

ListedPose RigidBodies::pose_of(std::int32_t number) const {
  BodyMotionState state;
  state.centre_initial = start_centre(number);
  state.present = is_there(number) ? 1 : 0;
  return listed_pose(state, moment_of(number));
}

bool RigidBodies::lists_are_stale() const {
  double largest = 0.0;
  for (std::size_t n = 1; n < listed_.size(); ++n) {
    const auto number = static_cast<std::int32_t>(n);
    if ((listed_[n].present != 0) != is_there(number)) return true;
    largest = std::max(largest, moved_since(listed_[n], moment_of(number), reach_[n]));
  }
  return 2.0 * largest > list_skin * spacing_;
}

void RigidBodies::list() {
  std::vector<PointMemory> before;
  before.swap(memory_);
  triangle_.clear();
  listed_.clear();
  for (std::size_t n = 0; n <= count(); ++n) listed_.push_back(pose_of(static_cast<std::int32_t>(n)));
  for (std::size_t b = 0; b < count(); ++b) {
    if (!is_free_kind(b)) continue;
    for (std::size_t other = 0; other <= count(); ++other) {
      if (other != b + 1) list_pair(static_cast<std::int32_t>(b + 1), static_cast<std::int32_t>(other));
    }
  }
  const auto key = [](const PointMemory& p) { return std::tie(p.body, p.other, p.point); };
  std::size_t old = 0;
  for (PointMemory& p : memory_) {
    while (old < before.size() && key(before[old]) < key(p)) ++old;
    if (old == before.size() || key(before[old]) != key(p)) continue;
    p.touching = before[old].touching;
    p.first_depth = before[old].first_depth;
    p.depth = before[old].depth;
    p.tangential = before[old].tangential;
  }
}

void RigidBodies::list_pair(std::int32_t body, std::int32_t other) {
  const WallBody& surface = mesh_.body[static_cast<std::size_t>(other)];
  if (surface.root < 0 || !is_there(other)) return;
  const double reach = (deepest + list_skin) * spacing_;
  const BodyMoment own = moment_of(body), others = moment_of(other);
  if (norm(to_start(other, others, own.centre) - surface.middle) >
      reach_[static_cast<std::size_t>(body)] + surface.reach + reach)
    return;
  const auto points = static_cast<std::int32_t>(point_[static_cast<std::size_t>(body - 1)].size());
  for (std::int32_t k = 0; k < points; ++k) {
    const auto first = static_cast<std::int32_t>(triangle_.size());
    triangles_near(mesh_, other, to_start(other, others, point_now(body, k, own)), reach, triangle_);
    const auto found = static_cast<std::int32_t>(triangle_.size()) - first;
    if (found > 0) memory_.push_back({body, other, k, first, found, 0, 0.0, 0.0, {}});
  }
}

NearestPlace RigidBodies::place_of(const PointMemory& p, const Vec3d& point, const BodyMoment& other) const {
  NearestPlace place = nearest_place(mesh_, to_start(p.other, other, point), triangle_.data() + p.first, p.count);
  if (place.triangle < 0 || place.distance < -deepest * spacing_) return {};
  if (p.other != 0) place.n = multiply(other.rotation, place.n);
  return place;
}

void RigidBodies::note_first_depths() {
  for (PointMemory& p : memory_) {
    const NearestPlace place = place_of(p, point_now(p.body, p.point, moment_of(p.body)), moment_of(p.other));
    p.first_depth = place.triangle >= 0 ? std::max(0.0, -place.distance) : 0.0;
  }
}

double RigidBodies::pore_force(const PointMemory& p, const Vec3d& place) const {
  if (moves(p.other)) return 0.0;
  const double head = std::max(0.0, water_level_ - place.z);
  return -gravity_.z * water_density_ * head *
         point_[static_cast<std::size_t>(p.body - 1)][static_cast<std::size_t>(p.point)].area;
}

std::vector<RigidBodies::Found> RigidBodies::find_touches() {
  std::vector<BodyMoment> moment;
  for (std::size_t n = 0; n <= count(); ++n) moment.push_back(moment_of(static_cast<std::int32_t>(n)));
  std::vector<Found> found;
  std::vector<int> touching(count() + 1, 0);
  for (std::size_t k = 0; k < memory_.size(); ++k) {
    PointMemory& p = memory_[k];
    if (!moves(p.body) && !moves(p.other)) continue;
    const BodyMoment &own = moment[static_cast<std::size_t>(p.body)],
                     &other = moment[static_cast<std::size_t>(p.other)];
    const Vec3d place = point_now(p.body, p.point, own);
    const NearestPlace near = place_of(p, place, other);
    const double depth = near.triangle >= 0 ? std::max(0.0, -near.distance) : 0.0;
    p.first_depth = std::min(p.first_depth, depth);
    p.depth = depth - p.first_depth;
    if (!(p.depth > 0.0)) {
      p.touching = 0;
      p.tangential = {};
      continue;
    }
    p.touching = 1;
    ++touching[static_cast<std::size_t>(p.body)];
    const Vec3d velocity =
        own.velocity + cross(own.spin, place - own.centre) - other.velocity - cross(other.spin, place - other.centre);
    found.push_back({k, {near.n, p.depth, velocity, 0.0, pore_force(p, place)}, place});
  }
  largest_depth_ = 0.0;
  for (Found& f : found) {
    const PointMemory& p = memory_[f.memory];
    double inverse = 0.0;
    for (const std::int32_t n : {p.body, p.other}) {
      if (moves(n)) inverse += 1.0 / bodies_[static_cast<std::size_t>(n - 1)].mass;
    }
    f.touch.mass = 1.0 / (inverse * touching[static_cast<std::size_t>(p.body)]);
    largest_depth_ = std::max(largest_depth_, f.touch.depth);
  }
  return found;
}

void RigidBodies::add_force(const Found& found, double h, std::vector<BodyLoad>& loads) {
  PointMemory& p = memory_[found.memory];
  const Vec3d force = rigid_contact_force(law_, found.touch, h, p.tangential);
  const auto own = static_cast<std::size_t>(p.body - 1);
  loads[own].force += force;
  loads[own].torque += cross(found.place - state_[own].centre, force);
  if (p.other == 0) return;
  const auto other = static_cast<std::size_t>(p.other - 1);
  const Vec3d centre = is_free_kind(other) ? state_[other].centre : other_[other].centre;
  loads[other].force -= force;
  loads[other].torque -= cross(found.place - centre, force);
}

double RigidBodies::contact_time_step() {
  if (lists_are_stale()) list();
  std::vector<int> near(count() + 1, 0);
  for (const PointMemory& p : memory_) {
    ++near[static_cast<std::size_t>(p.body)];
    ++near[static_cast<std::size_t>(p.other)];
  }
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < count(); ++b) {
    if (!state_[b].free || near[b + 1] == 0) continue;
    least = std::min(least, step_share * std::sqrt(bodies_[b].mass / (law_.stiffness * near[b + 1])));
  }
  return least;
}

double RigidBodies::normal_energy() const {
  double sum = 0.0;
  for (const PointMemory& p : memory_) {
    if (p.touching) sum += 0.5 * law_.stiffness * p.depth * p.depth;
  }
  return sum;
}

}  // namespace gdesp::dem
