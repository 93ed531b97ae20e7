// SPDX-License-Identifier: GPL-3.0-or-later
// The weight with which the analysis turns particles into a continuous fluid fraction.
//
// Wendland C2, support 2h (H. Wendland 1995, Adv. Comput. Math. 4, 389-396, doi 10.1007/BF02123482):
//   W(r, h) = a_d / h^d (1 - q/2)^4 (2q + 1),  q = r / h in [0, 2],  a_2 = 7 / (4 pi),  a_3 = 21 / (16 pi)
// with h = 1.3 dp, whatever the solver used: two programs' frames are measured with one and the same ruler.
#pragma once

#include <cmath>
#include <vector>

#include "core/wendland.hpp"

namespace gdesp::analysis {

inline constexpr double smoothing_ratio = 1.3;  ///< h / dp of every measurement in this folder

/// W without its factor a_d / h^d; q2 = (r / h)^2.
inline double wendland_shape(double q2) {
  if (q2 >= 4.0) return 0.0;
  const double q = std::sqrt(q2);
  const double u = 1.0 - 0.5 * q;
  return u * u * u * u * (2.0 * q + 1.0);
}

/// What a horizontal layer of fluid of thickness T reads on the vertical axis, in units of h: the weight summed
/// over a plane gives the marginal w(z); then
///   edge(T)   = int_0^T w dz         the fraction at the layer's own surface (1/2 for T >= 2h: the half space)
///   middle(T) = int_-T/2^T/2 w dz    the fraction at its middle
/// From them a thin sheet and deep water get the threshold that puts the level where the water ends.
class LayerResponse {
 public:
  explicit LayerResponse(int dimensions);
  double edge(double thickness_over_h) const { return integral(thickness_over_h); }
  double middle(double thickness_over_h) const { return 2.0 * integral(0.5 * thickness_over_h); }
  /// The thickness T with T / middle(T) = ratio (both in units of h); 0 when the ratio is below the thinnest sheet's.
  double thickness_from_ratio(double ratio) const;

 private:
  double integral(double z) const;  ///< int_0^z w dz, z in units of h
  std::vector<double> table_;
};

const LayerResponse& layer_response(int dimensions);

}  // namespace gdesp::analysis
