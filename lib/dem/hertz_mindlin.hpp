// SPDX-License-Identifier: GPL-3.0-or-later
// @eq dem.hertz.normal
//   F = (4/3) E* sqrt(R*) delta^(3/2)
//   F: elastic repulsion along n on i, -n on j [N]; delta: overlap [m]; R* = R_i R_j/(R_i + R_j) [m];
//   E* = E/(2 (1 - nu^2)) of two bodies of one material, 1/E* = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2 in general [Pa].
//   Valid for delta << R*, smooth surfaces. Source: Hertz (1882), J. Reine Angew. Math. 92, 156,
//   doi:10.1515/crll.1882.92.156; Johnson (1985), Contact Mechanics, eq. 4.23, doi:10.1017/CBO9781139171731.
//   Coded with the contact radius a = sqrt(R* delta): F = (4/3) E* a delta, S_n = dF/d(delta) = 2 E* a.
// @eq dem.hertz.damping
//   F_d = -2 sqrt(5/6) beta sqrt(S_n m*) v_n,  beta = -ln e / sqrt(ln^2 e + pi^2)
//   e: restitution coefficient, 0 < e <= 1; m* = m_i m_j/(m_i + m_j) [kg]; v_n = v_ij . n [m/s], > 0 apart.
//   Source: form of Tsuji, Tanaka, Ishida (1992), Powder Technol. 71, 239, doi:10.1016/0032-5910(92)88030-L (damping
//   as delta^(1/4)); the exact relation of its coefficient to e: Antypov & Elliott (2011), EPL 94, 50004,
//   doi:10.1209/0295-5075/94/50004. Exact when the contact ends at delta = 0, so the force may pull at its end.
// @eq dem.mindlin.tangential
//   S_t = 8 G* a,  G* = G/(2 (2 - nu)) of two bodies of one material; tangential damping 2 sqrt(5/6) beta sqrt(S_t m*)
//   S_t: tangential stiffness without slip [N/m]; G = E/(2 (1 + nu)) [Pa].
//   Source: Mindlin (1949), J. Appl. Mech. 16, 259, doi:10.1115/1.4009973; history: dem.friction.coulomb.
#pragma once

#include <cmath>

#include "dem/contact_law.hpp"

namespace gdesp::dem {

/// beta of dem.hertz.damping and dem.linear.damping; 0 at e = 1.
inline double damping_ratio(double restitution) {
  const double logarithm = std::log(restitution);
  return -logarithm / std::sqrt(logarithm * logarithm + 9.869604401089358);
}

/// E*, Pa. An infinite modulus is a rigid partner.
inline double effective_modulus(double e_1, double nu_1, double e_2, double nu_2) {
  return 1.0 / ((1.0 - nu_1 * nu_1) / e_1 + (1.0 - nu_2 * nu_2) / e_2);
}

/// G*, Pa: 1/G* = 2 (2 - nu_1)(1 + nu_1)/E_1 + the same of 2.
inline double effective_shear_modulus(double e_1, double nu_1, double e_2, double nu_2) {
  return 1.0 / (2.0 * (2.0 - nu_1) * (1.0 + nu_1) / e_1 + 2.0 * (2.0 - nu_2) * (1.0 + nu_2) / e_2);
}

struct HertzMindlin {
  float modulus = 0.0f;          ///< E*, Pa
  float damping = 0.0f;          ///< 2 sqrt(5/6) beta sqrt(2 E*), so that the coefficient is damping sqrt(a m*)
  float shear_stiffness = 0.0f;  ///< 8 G*, Pa
  float shear_damping = 0.0f;    ///< as damping, with 8 G* for 2 E*

  /// `delta` > 0 (m), `radius` R* (m), `mass` m* (kg).
  template <class R>
  GDESP_HD ContactCoefficients<R> operator()(const R& delta, const R& radius, const R& mass) const {
    using real::sqrt;
    const R a = sqrt(radius * delta);
    const R root = sqrt(a * mass);
    const R stiffness = R(2.0f * modulus) * a;
    return {R(0.66666667f) * stiffness * delta, stiffness, R(damping) * root, R(shear_stiffness) * a,
            R(shear_damping) * root};
  }
  /// S_t(now) / S_t(one step ago) for a contact that opened at v_apart >= 0 (m/s) during dt (s), to first order.
  template <class R>
  GDESP_HD static R unloading(const R& delta, const R& v_apart, const R& dt) {
    return delta / (delta + R(0.5f) * v_apart * dt);
  }
  /// Energy of the elastic force, J: (2/5) F delta.
  GDESP_HD static float normal_energy(float elastic_force, float delta) { return 0.4f * elastic_force * delta; }
};

/// The law of a pair of materials.
inline HertzMindlin make_hertz_mindlin(double e_star, double g_star, double restitution) {
  const double scale = 2.0 * std::sqrt(5.0 / 6.0) * damping_ratio(restitution);
  return {static_cast<float>(e_star), static_cast<float>(scale * std::sqrt(2.0 * e_star)),
          static_cast<float>(8.0 * g_star), static_cast<float>(scale * std::sqrt(8.0 * g_star))};
}

}  // namespace gdesp::dem
