// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem/settle_grains.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "dem/grain_system.hpp"

namespace gdesp::dem {
namespace {

constexpr double restitution = 0.5;     // of a scene by default
constexpr double step_share = 0.2;      // of the critical time
constexpr double rest_speed = 1.0e-3;   // sqrt(g d)
constexpr double longest = 10.0;        // sqrt(2 H / g)
constexpr double resting_share = 0.95;  // of the grains: the others may rattle in the gaps between those that bear

struct Extent {
  Vec3d lower, upper;
};  // m

/// Of points, `margin` (m) wider on every side.
Extent extent_of(const std::vector<Vec3d>& points, const std::vector<Vec3d>& more, double margin) {
  Extent e{points.front(), points.front()};
  for (const auto* list : {&points, &more}) {
    for (const Vec3d& p : *list) {
      for (int a = 0; a < 3; ++a) {
        e.lower[a] = std::min(e.lower[a], p[a] - margin);
        e.upper[a] = std::max(e.upper[a], p[a] + margin);
      }
    }
  }
  return e;
}

double mean_of(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

/// m/s, of the mass.
double speed_of(const GrainSums& sums) {
  return sums.mass > 0.0 ? std::sqrt(2.0 * sums.kinetic_energy / sums.mass) : 0.0;
}

/// m/s: what `share` of the grains stay below.
double speed_of_most(const GrainTable& grains, double share) {
  std::vector<double> speeds;
  for (const Vec3f& v : grains.velocity) speeds.push_back(std::sqrt(dot(v, v)));
  if (speeds.empty()) return 0.0;
  const auto place = speeds.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(speeds.size() - 1));
  std::nth_element(speeds.begin(), place, speeds.end());
  return *place;
}

}  // namespace

Settlement settle_grains(GrainTable& grains, const TriangleTable& walls, const SettlingConditions& conditions) {
  Settlement out;
  if (grains.position.empty()) return out;
  const double gravity = norm(conditions.gravity);
  if (!(gravity > 0.0)) throw Error(ErrorKind::input, "grains cannot settle without gravity: domain.gravity is zero");
  const double diameter = mean_of(grains.diameter);
  const Extent bed = extent_of(grains.position, {}, diameter),
               space = extent_of(grains.position, walls.vertex, 2.0 * diameter);
  ContactParameters contact = conditions.contact;
  contact.restitution = contact.wall_restitution = restitution;
  const bool periodic[3] = {false, false, false};
  GrainSystem<exec::OpenMP> system({}, make_domain(space.lower, space.upper, diameter, periodic, conditions.dimensions),
                                   grains, contact, walls, conditions.gravity);
  const double step = system.stable_time_step(step_share),
               height = std::abs(dot(bed.upper - bed.lower, conditions.gravity)) / gravity;
  const double last = longest * std::sqrt(2.0 * height / gravity), look = std::sqrt(diameter / gravity);
  const int substeps = std::max(1, static_cast<int>(std::ceil(look / step)));
  const double slow_speed = rest_speed * std::sqrt(gravity * diameter);
  for (bool slow = false; system.time() < last && !out.at_rest;) {
    system.advance(look, substeps);
    out.speed = speed_of(system.sums());
    const bool now = out.speed < slow_speed;
    out.at_rest = slow && now;
    slow = now;
  }
  out.time = system.time();
  out.lost = static_cast<std::size_t>(system.lost());
  GrainTable settled = system.table();
  out.at_rest = out.at_rest || speed_of_most(settled, resting_share) < slow_speed;
  if (conditions.dimensions == 2)
    for (Vec3d& r : settled.position) r.y = 0.0;
  settled.velocity.clear();
  settled.angular_velocity.clear();
  settled.id.clear();
  grains = std::move(settled);
  return out;
}

}  // namespace gdesp::dem
