// SPDX-License-Identifier: GPL-3.0-or-later
// @eq dem.friction.coulomb
//   f(t + dt) = q P f(t) - S_t v_t dt,  F_t = min(1, mu F_n / |f - c_t v_t|) (f - c_t v_t),
//   and f takes the same factor when the contact slips
//   F_t: tangential force on i [N]; f: its elastic part, the history of the contact [N]; v_t: tangential velocity of
//   i against j at the contact [m/s]; S_t [N/m], c_t [N s/m]: of the law; mu: friction coefficient; F_n >= 0: normal
//   force [N]; P: projection on the plane of contact; q = S_t(now)/S_t(before) while the contact opens, else 1.
//   On j: -F_t, history -f. The factor q (and the force, not the displacement, as history) keeps a closing and
//   opening contact from making energy. Source: Thornton, Cummins, Cleary (2013), Powder Technol. 233, 30,
//   doi:10.1016/j.powtec.2012.08.012; Coulomb cap: Cundall & Strack (1979), doi:10.1680/geot.1979.29.1.47.
//   Coded with v_t at the middle of the step: half of S_t v_t dt before the cap, half after it.
// @eq dem.cohesion.dmt
//   F_a = -2 pi w R* n while delta > 0
//   F_a: pull on i [N]; w: work of adhesion [J/m2]; R*: effective radius [m]. Stiff small grains; the cap of friction
//   counts the Hertz force without it. Source: Derjaguin, Muller, Toporov (1975), J. Colloid Interface Sci. 53, 314,
//   doi:10.1016/0021-9797(75)90018-1.
#pragma once

#include "core/vec3.hpp"
#include "dem/contact_law.hpp"

namespace gdesp::dem {

/// 2 pi w R*, N, for the work of adhesion w (J/m2).
template <class R>
GDESP_HD inline R dmt_pull(float work_of_adhesion, const R& radius) {
  return R(6.28318531f * work_of_adhesion) * radius;
}

/// How the contact moved, and how long.
template <class R>
struct ContactMotion {
  Vec3<R> n;      ///< unit, from j to i
  Vec3<R> v_t;    ///< m/s, tangential velocity of i against j at the contact
  R unloading;    ///< q
  R cap;          ///< mu F_n, N
  R half_before;  ///< s, half of the step that ends now
  R half_after;   ///< s, half of the step that begins now
};

/// The tangential force on i, N; `history` (N) goes from half a step before to half a step after now.
template <class R>
GDESP_HD inline Vec3<R> tangential_force(const ContactCoefficients<R>& c, const ContactMotion<R>& m, Vec3<R>& history) {
  using real::inverse_sqrt;
  using real::max;
  using real::min;
  const R along = dot(history, m.n);
  const R before = c.tangential_stiffness * m.half_before;
  Vec3<R> f{m.unloading * (history.x - along * m.n.x) - before * m.v_t.x,
            m.unloading * (history.y - along * m.n.y) - before * m.v_t.y,
            m.unloading * (history.z - along * m.n.z) - before * m.v_t.z};
  Vec3<R> force{f.x - c.tangential_damping * m.v_t.x, f.y - c.tangential_damping * m.v_t.y,
                f.z - c.tangential_damping * m.v_t.z};
  const R scale = min(R(1.0f), m.cap * inverse_sqrt(max(dot(force, force), R(1.0e-37f))));
  const R after = c.tangential_stiffness * m.half_after;
  history = {f.x * scale - after * m.v_t.x, f.y * scale - after * m.v_t.y, f.z * scale - after * m.v_t.z};
  return {force.x * scale, force.y * scale, force.z * scale};
}

}  // namespace gdesp::dem
