// SPDX-License-Identifier: GPL-3.0-or-later
// @eq sph.surface-rows
//   sum_j V0 (P_k + P_j) grad W_kj = -rho g,   P = -rho g z,   z_k = (s_k - k - 1/2) dp,   k = 0, 1, ...: rows of water from the surface down
//   On the cubic lattice the sum of sph.momentum is exact for the linear pressure P [Pa] of still water, but in the first two
//   rows, which miss the particles above the surface: there it errs by -7 and +7 % of g (h = 1.5 dp, in space). The shifts
//   s_k [dp], solved for here, take that away; they alternate and fall threefold from row to row (-0.055, 0.018, -0.006 ...).
//   With the wall particles in the same rows nothing is left that moves water at the start, whatever the shape of the bed.
//   rho: density [kg/m3]; g: gravity [m/s2]; V0 = dp^dimensions. Source: own construction; sum: Monaghan (2005), doi:10.1088/0034-4885/68/8/R01;
//   kernel: sph.kernel.wendland-c2.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace gdesp {

/// Rows of an endless lattice below its surface; dp = rho = g = 1.
class SurfaceRows {
 public:
  static constexpr int count = 8;  ///< of shifted rows; the eighth moves by 0.0001

  SurfaceRows(double smoothing_ratio, int dimensions)
      : support_(2.0 * smoothing_ratio), reach_(static_cast<int>(std::ceil(support_)) + 1) {
    for (int i = -reach_; i <= reach_; ++i) {
      for (int j = dimensions == 2 ? 0 : -reach_; j <= (dimensions == 2 ? 0 : reach_); ++j) ++shell_[i * i + j * j];
    }
    for (int k = -reach_; k <= reach_; ++k) moment_ += slope(k) * k * k;
  }

  /// What row k accelerates with, upwards; gravity included.
  double acceleration(const std::vector<double>& shift, int k) const {
    const double z = height(shift, k);
    double sum = 0.0;
    for (int j = std::max(0, k - reach_); j <= k + reach_; ++j) {
      const double other = height(shift, j);
      sum += (-z - other) * slope(z - other) * (z - other);
    }
    return sum / moment_ - 1.0;
  }

 private:
  double height(const std::vector<double>& shift, int k) const {
    return (k < count ? shift[static_cast<std::size_t>(k)] : 0.0) - k - 0.5;
  }

  /// Sum of -(dW/dr)/r over a row dz above or below, up to a factor.
  double slope(double dz) const {
    double sum = 0.0;
    for (const auto& [square, points] : shell_) {
      const double t = std::max(0.0, 1.0 - std::sqrt(square + dz * dz) / support_);
      sum += points * t * t * t;
    }
    return sum;
  }

  double support_;
  int reach_;
  std::map<int, int> shell_;  // squared distances along a row, and how many points lie there
  double moment_ = 0.0;
};

/// s_k of the first rows, upwards; those below are not shifted. smoothing_ratio: h/dp, 1.3 to 2. Empty when none are found.
inline std::vector<double> surface_row_shifts(double smoothing_ratio, int dimensions) {
  constexpr double pace = 0.04, balanced = 1e-7;  // pace: of the way to rest, small enough for the stiffest rows
  constexpr int most_steps = 5000;
  const SurfaceRows rows(smoothing_ratio, dimensions);
  std::vector<double> shift(SurfaceRows::count, 0.0), next(shift);
  for (int step = 0; step < most_steps; ++step) {
    double largest = 0.0;
    for (int k = 0; k < SurfaceRows::count; ++k) {
      const double a = rows.acceleration(shift, k);
      largest = std::max(largest, std::abs(a));
      next[static_cast<std::size_t>(k)] = shift[static_cast<std::size_t>(k)] + pace * a;
    }
    if (largest < balanced) return shift;
    shift.swap(next);
  }
  return {};
}

}  // namespace gdesp
