// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/front.hpp"

#include <algorithm>
#include <cmath>

namespace gdesp::analysis {

std::optional<double> leading_edge(std::span<const Vec3d> position, const Vec3d& direction, double phi,
                                   double common_size, std::span<const double> volume, std::span<const float> size) {
  const std::size_t n = position.size();
  if (n == 0) return std::nullopt;
  struct Slice {
    double start, end, volume;
  };
  std::vector<Slice> slice(n);
  double total = 0.0, tip = -1e300;
#pragma omp parallel for schedule(static) reduction(+ : total) reduction(max : tip)
  for (std::size_t i = 0; i < n; ++i) {
    const double s = dot(position[i], direction);
    const double half = 0.5 * (size.empty() ? common_size : size[i]);
    slice[i] = {s - half, s + half, volume.empty() ? 1.0 : volume[i]};
    total += slice[i].volume;
    tip = std::max(tip, s + half);
  }
  const double wanted = phi * total;
  if (wanted <= 0.0) return tip;
  // The volume beyond x falls monotonically from total to 0: bisect over the slices' ends.
  double low = tip, high = tip;
  for (const Slice& s : slice) low = std::min(low, s.start);
  for (int k = 0; k < 60; ++k) {
    const double x = 0.5 * (low + high);
    double beyond = 0.0;
#pragma omp parallel for schedule(static) reduction(+ : beyond)
    for (std::size_t i = 0; i < n; ++i) {
      beyond += slice[i].volume * std::clamp((slice[i].end - x) / (slice[i].end - slice[i].start), 0.0, 1.0);
    }
    (beyond > wanted ? low : high) = x;
    if (high - low < 1e-9 * std::max(1.0, std::abs(high))) break;
  }
  return 0.5 * (low + high);
}

std::optional<double> first_departure(std::span<const double> time, std::span<const double> value, double threshold) {
  std::size_t k = 0;
  while (k < value.size() && !std::isfinite(value[k])) ++k;
  if (k == value.size()) return std::nullopt;
  const double start = value[k];
  double last_time = time[k], last = 0.0;
  for (++k; k < value.size(); ++k) {
    if (!std::isfinite(value[k])) continue;
    const double departure = std::abs(value[k] - start);
    if (departure > threshold) return last_time + (threshold - last) / (departure - last) * (time[k] - last_time);
    last_time = time[k];
    last = departure;
  }
  return std::nullopt;
}

}  // namespace gdesp::analysis
