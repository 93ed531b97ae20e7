// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "particles/particle_tables.hpp"

namespace gdesp {

/// Displacement (m) and velocity (m/s) of a prescribed motion at time t (s): linear between its rows, constant beyond.
struct MotionNow {
  Vec3d displacement, velocity;
};

inline MotionNow motion_at(const PrescribedMotion& motion, double t) {
  MotionNow now;
  const auto& time = motion.time;
  if (time.empty()) return now;
  if (t < time.front()) {
    now.displacement = motion.displacement.front();
    return now;
  }
  if (t >= time.back()) {
    now.displacement = motion.displacement.back();
    return now;
  }
  const auto next = static_cast<std::size_t>(std::upper_bound(time.begin(), time.end(), t) - time.begin());
  const double width = time[next] - time[next - 1];
  const Vec3d change = motion.displacement[next] - motion.displacement[next - 1];
  now.velocity = change * (1.0 / width);
  now.displacement = motion.displacement[next - 1] + now.velocity * (t - time[next - 1]);
  return now;
}

/// True when the body is no longer there at time t.
inline bool removed_at(const PrescribedMotion& motion, double t) {
  return motion.remove_at >= 0.0 && t >= motion.remove_at;
}

}  // namespace gdesp
