// SPDX-License-Identifier: GPL-3.0-or-later
// How many particles a volume a kernel sum on one of them means.
#pragma once

#include "sph/wendland_c2.hpp"

namespace gdesp::sph {

/// sum_j V0 W_ij, j = i too, on a cubic lattice with `share` of the particles that one of spacing dp has (V0 = dp^dimensions).
/// More than `share` where the lattice is thin: the particle itself, at the peak of the kernel, counts for more than its
/// room; by 0.5 % at 1, 5 % at 0.4, 32 % at 0.2 in two dimensions (h = 1.5 dp), and 0.3, 2.4 and 8 % in three.
inline double lattice_count(double h_over_dp, int dimensions, double share) {
  const double spacing = std::pow(share, -1.0 / dimensions);
  const int reach = static_cast<int>(2.0 * h_over_dp / spacing) + 1;
  const int reach_y = dimensions == 2 ? 0 : reach;
  double count = 0.0;
  for (int x = -reach; x <= reach; ++x)
    for (int y = -reach_y; y <= reach_y; ++y)
      for (int z = -reach; z <= reach; ++z) {
        const double r = spacing * std::sqrt(static_cast<double>(x * x + y * y + z * z));
        count += wendland_shape(std::max(0.0, 1.0 - r / (2.0 * h_over_dp)));
      }
  return count * wendland_normalisation(h_over_dp, dimensions);
}

/// The inverse of lattice_count, for kernels: linear between 32 points.
class ShareOfCount {
 public:
  ShareOfCount(double h_over_dp, int dimensions) {
    count_[0] = static_cast<float>(wendland_normalisation(h_over_dp, dimensions));
    for (int k = 1; k <= last; ++k)
      count_[k] = static_cast<float>(lattice_count(h_over_dp, dimensions, static_cast<double>(k) / last));
  }
  /// Above a full lattice in proportion; 0 where nothing but the particle itself is counted.
  GDESP_HD float operator()(float count) const {
    if (count >= count_[last]) return count / count_[last];
    int k = 0;
    while (k + 1 < last && count_[k + 1] <= count) ++k;
    const float between = (count - count_[k]) / (count_[k + 1] - count_[k]);
    return (static_cast<float>(k) + (between > 0.0f ? between : 0.0f)) / static_cast<float>(last);
  }

 private:
  static constexpr int last = 32;
  float count_[last + 1];
};

}  // namespace gdesp::sph
