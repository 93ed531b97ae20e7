// SPDX-License-Identifier: GPL-3.0-or-later
// @eq dem.linear.normal
//   F = k delta,  S_t = k_t
//   F: elastic repulsion along n on i [N]; delta: overlap [m]; k, k_t: normal and tangential stiffness [N/m].
//   Valid as a model: k is chosen so that delta stays below one per cent of the diameter.
//   Source: Cundall & Strack (1979), Geotechnique 29, 47, doi:10.1680/geot.1979.29.1.47.
// @eq dem.linear.damping
//   F_d = -2 beta sqrt(m* k) v_n,  beta = -ln e / sqrt(ln^2 e + pi^2); tangential: -2 beta sqrt(m* k_t) v_t
//   e: restitution coefficient, 0 < e <= 1; m*: effective mass [kg]; v_n = v_ij . n [m/s]. Exact: the half period
//   of the damped oscillator ends with speed e times the first. Source: Schafer, Dippel, Wolf (1996),
//   J. Phys. I France 6, 5, doi:10.1051/jp1:1996129, eqs 12-14.
// @eq dem.line.normal
//   F = (pi/4) E* L delta
//   Contact of parallel rods of length L = 1 m (discs of a plane problem), F [N]; E* as in dem.hertz.normal [Pa]. The
//   stiffness of a line contact hardly depends on the radii; tangential: times 4 G*/E* of Mindlin; damping as linear.
//   Source: Popov (2010), Contact Mechanics and Friction, chapter 5, doi:10.1007/978-3-642-10803-7.
#pragma once

#include <cmath>

#include "dem/contact_law.hpp"
#include "dem/hertz_mindlin.hpp"

namespace gdesp::dem {

struct LinearSpringDashpot {
  float stiffness = 0.0f;        ///< k, N/m
  float damping = 0.0f;          ///< 2 beta sqrt(k), so that the coefficient is damping sqrt(m*)
  float shear_stiffness = 0.0f;  ///< k_t, N/m
  float shear_damping = 0.0f;    ///< 2 beta sqrt(k_t)

  /// `delta` > 0 (m), R* (m, unused), `mass` m* (kg).
  template <class R>
  GDESP_HD ContactCoefficients<R> operator()(const R& delta, const R&, const R& mass) const {
    using real::sqrt;
    const R root = sqrt(mass);
    return {R(stiffness) * delta, R(stiffness), R(damping) * root, R(shear_stiffness), R(shear_damping) * root};
  }
  /// The tangential stiffness does not change while a contact opens.
  template <class R>
  GDESP_HD static R unloading(const R&, const R&, const R&) {
    return R(1.0f);
  }
  /// Energy of the elastic force, J: F delta / 2.
  GDESP_HD static float normal_energy(float elastic_force, float delta) { return 0.5f * elastic_force * delta; }
};

/// `ratio`: k_t / k.
inline LinearSpringDashpot make_linear_spring_dashpot(double stiffness, double ratio, double restitution) {
  const double beta = damping_ratio(restitution);
  return {static_cast<float>(stiffness), static_cast<float>(2.0 * beta * std::sqrt(stiffness)),
          static_cast<float>(ratio * stiffness), static_cast<float>(2.0 * beta * std::sqrt(ratio * stiffness))};
}

/// k of a line contact, N/m, for E* (Pa) and a length of one metre.
inline double line_contact_stiffness(double e_star) { return 0.78539816339744831 * e_star; }

}  // namespace gdesp::dem
