// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/smoothing.hpp"

#include <algorithm>

namespace gdesp::analysis {
namespace {

constexpr int intervals = 400;  // of the table over z = 0 .. 2h

// w(z): the weight (h = 1) integrated over the horizontal line (d = 2) or plane (d = 3) at height z; midpoint rule.
double marginal(double z, int dimensions) {
  const double reach = std::sqrt(std::max(0.0, 4.0 - z * z));
  const int steps = 400;
  const double dr = reach / steps;
  double sum = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double r = (k + 0.5) * dr;
    sum += wendland_shape(r * r + z * z) * (dimensions == 2 ? 2.0 : 2.0 * std::numbers::pi * r);
  }
  return wendland_normalisation(1.0, dimensions) * sum * dr;
}

}  // namespace

LayerResponse::LayerResponse(int dimensions) : table_(intervals + 1, 0.0) {
  const double dz = 2.0 / intervals;
  for (int k = 0; k < intervals; ++k) table_[k + 1] = table_[k] + dz * marginal((k + 0.5) * dz, dimensions);
  const double scale = 0.5 / table_.back();  // the quadrature's own error
  for (double& value : table_) value *= scale;
}

double LayerResponse::integral(double z) const {
  const double u = std::clamp(z / 2.0, 0.0, 1.0) * intervals;
  const int k = std::min(static_cast<int>(u), intervals - 1);
  return table_[k] + (u - k) * (table_[k + 1] - table_[k]);
}

double LayerResponse::thickness_from_ratio(double ratio) const {
  if (ratio >= 4.0) return ratio;  // middle(T) = 1 from T = 4h on
  double low = 1e-6, high = 4.0;
  if (ratio <= low / middle(low)) return 0.0;
  for (int k = 0; k < 40; ++k) {
    const double t = 0.5 * (low + high);
    (t / middle(t) < ratio ? low : high) = t;
  }
  return 0.5 * (low + high);
}

const LayerResponse& layer_response(int dimensions) {
  static const LayerResponse two(2), three(3);
  return dimensions == 2 ? two : three;
}

}  // namespace gdesp::analysis
