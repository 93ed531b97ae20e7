// SPDX-License-Identifier: GPL-3.0-or-later
// Pressure of the water on a grain, as the derivative of the work that the grain's volume takes from the water.
// @eq coupling.buoyancy
//   F_i = -grad_i (V_i w(N_i) P_i),  P_i = sum_a V_a p_ia W_ia / n_i,  n_i = sum_a V_a W_ia,  N_i = n_i/(1 - S_i),
//   p_ia = P_a + rho g.(r_i - r_a): the pressure of water particle a carried to the grain; w: smoothstep from 0 at N = 0.25
//   to 1 at 0.75 (a grain out of the water feels none). Water particle a takes the exact opposite of its term,
//     F_ia = -V_i V_a { [(w/n_i)(p_ia - P_i) + w'/(1 - S_i) max(P_i, 0)] grad_i W_ia + (w/n_i) rho g W_ia };
//   the wall takes the rest, -V_i w' max(P_i, 0) N_i/(1 - S_i) grad_i S_i.
//   V: volume [m3]; P: pressure [Pa]; W [1/m3]; S_i = sum_w V_w W_iw over walls: N = 1 in the deep and beside walls, in edges and
//   corners too; F [N]. In still water p_ia = P_i and F = -rho g V exactly where w = 1.
//   The volume is withdrawn from the water with the same weights, eps_a = 1 - sum_i V_i (w/n_i) W_ai (coupling.porosity), and the
//   water's own pressure force, the walls' too, takes the mixture pressure
//     Pi_a = eps_a P_a + sum_i V_i [(w/n_i)(P_i + rho g.(r_a - r_i)) - w'/(1 - S_i) max(P_i, 0)] W_ai
//   for P_a, so that squeezed water gains what grains and water pay: no energy is made (docs/decisions/0043). P constant, w' = 0: Pi = P.
//   Source: -V grad P: Robinson, Ramaioli, Luding (2014), eq. 17, doi:10.1016/j.ijmultiphaseflow.2013.11.003; discrete
//   form by derivation of the energy sum m e(rho) with rho = superficial density/eps, as for SPH itself: Price (2012),
//   doi:10.1016/j.jcp.2010.12.011. Own derivation.
#pragma once

#include "core/host_device.hpp"
#include "core/real.hpp"
#include "core/vec3.hpp"

namespace gdesp::coupling {

inline constexpr float dry_share = 0.25f, wet_share = 0.75f;

/// w(N).
GDESP_HD inline float immersion(float N) {
  const float t = real::min(real::max((N - dry_share) / (wet_share - dry_share), 0.0f), 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

/// dw/dN.
GDESP_HD inline float immersion_slope(float N) {
  const float t = real::min(real::max((N - dry_share) / (wet_share - dry_share), 0.0f), 1.0f);
  return 6.0f * t * (1.0f - t) / (wet_share - dry_share);
}

/// 1 - S: room that walls leave; never less than a corner leaves.
GDESP_HD inline float open_share(float walls) { return real::max(1.0f - walls, 0.1f); }

/// V w/n: what the grain weighs in the porosity of the water around it, m3.
GDESP_HD inline float deposited_volume(float volume, float n, float room) {
  const float w = immersion(n / room);
  return w > 0.0f ? volume * w / n : 0.0f;
}

/// Sums around a grain.
struct Surroundings {
  float water;              ///< n
  float pressure;           ///< sum_a V_a p_ia W_ia, Pa
  Vec3f water_gradient;     ///< sum_a V_a grad_i W_ia, 1/m
  Vec3f pressure_gradient;  ///< sum_a V_a p_ia grad_i W_ia, Pa/m
  float room;               ///< 1 - S
  Vec3f wall_gradient;      ///< grad_i S, 1/m
};

struct Buoyancy {
  Vec3f force;     ///< N, on the grain
  Vec3f gradient;  ///< Pa/m, of the pressure at the grain
  float slope,
      offset;  ///< the grain's force on a is u_a [(slope p_ia + offset) grad_i W_ia + slope rho g W_ia]: m3, N m
};

/// `rho_g`: rho g, N/m3.
GDESP_HD inline Buoyancy buoyancy(float volume, const Surroundings& q, const Vec3f& rho_g) {
  const float N = q.water / q.room, w = immersion(N);
  if (!(w > 0.0f)) return {};
  const float inverse = 1.0f / q.water, P = q.pressure * inverse;
  const float squeeze = immersion_slope(N) * real::max(P, 0.0f) / q.room;
  const Vec3f gradient = (q.pressure_gradient - q.water_gradient * P) * inverse + rho_g;
  return {(gradient * w + (q.water_gradient + q.wall_gradient * N) * squeeze) * -volume, gradient, volume * w * inverse,
          volume * (squeeze - w * inverse * P)};
}

}  // namespace gdesp::coupling
