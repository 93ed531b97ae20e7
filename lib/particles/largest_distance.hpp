// SPDX-License-Identifier: GPL-3.0-or-later
// How far two sets of the same things lie apart: for comparisons of runs and of devices.
#pragma once

#include <cmath>
#include <vector>

#include "core/vec3.hpp"

namespace gdesp {

inline double distance_between(float a, float b) { return std::fabs(static_cast<double>(a - b)); }
template <class T>
double distance_between(const Vec3<T>& a, const Vec3<T>& b) {
  return static_cast<double>(norm(a - b));
}

/// The largest distance between what has the same place in both lists (of numbers or vectors, in their unit); infinite when one is
/// longer, NaN when one of the distances is.
template <class T>
double largest_distance(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() != b.size()) return INFINITY;
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double distance = distance_between(a[k], b[k]);
    if (std::isnan(distance)) return NAN;
    if (distance > largest) largest = distance;
  }
  return largest;
}

}  // namespace gdesp
