// SPDX-License-Identifier: GPL-3.0-or-later
// Particles that fill a known shape: on a lattice of spacing dp, with a repeatable jitter where asked.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "core/vec3.hpp"

namespace gdesp::analysis_test {

/// Cell centres of [lower, upper] (two dimensions: y = 0) for which `inside` holds. jitter in dp, uniform +-.
inline std::vector<Vec3d> fill(const Vec3d& lower, const Vec3d& upper, double dp, int dimensions,
                               const std::function<bool(const Vec3d&)>& inside, double jitter = 0.0) {
  std::vector<Vec3d> result;
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> shift(-jitter * dp, jitter * dp);
  const int nx = static_cast<int>(std::round((upper.x - lower.x) / dp));
  const int ny = dimensions == 2 ? 1 : static_cast<int>(std::round((upper.y - lower.y) / dp));
  const int nz = static_cast<int>(std::round((upper.z - lower.z) / dp));
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        Vec3d p{lower.x + (i + 0.5) * dp, dimensions == 2 ? 0.0 : lower.y + (j + 0.5) * dp, lower.z + (k + 0.5) * dp};
        if (!inside(p)) continue;
        p += {shift(engine), dimensions == 2 ? 0.0 : shift(engine), shift(engine)};
        result.push_back(p);
      }
    }
  }
  return result;
}

/// Columns filled to a height eta(x, y) exactly: each column's particles are stretched so that their layers end
/// at eta (spacing dp (1 +- 1/n)), the way a smooth surface lies in a running simulation.
inline std::vector<Vec3d> fill_under(const std::function<double(double, double)>& eta, const Vec3d& lower,
                                     const Vec3d& upper, double dp, int dimensions) {
  std::vector<Vec3d> result;
  const int nx = static_cast<int>(std::round((upper.x - lower.x) / dp));
  const int ny = dimensions == 2 ? 1 : static_cast<int>(std::round((upper.y - lower.y) / dp));
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const double x = lower.x + (i + 0.5) * dp, y = dimensions == 2 ? 0.0 : lower.y + (j + 0.5) * dp;
      const double depth = eta(x, y) - lower.z;
      const int n = static_cast<int>(std::round(depth / dp));
      for (int k = 0; k < n; ++k) result.push_back({x, y, lower.z + depth * (k + 0.5) / n});
    }
  }
  return result;
}

}  // namespace gdesp::analysis_test
