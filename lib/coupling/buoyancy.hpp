// SPDX-License-Identifier: GPL-3.0-or-later
// Pressure of the water on a grain, as the gradient of the work that the grain's volume takes from the water.
// @eq coupling.buoyancy
//   F_i = -grad_i (V_i w(s_i) P_i),  P_i = sum_b V_b P_b W_ib / S_i,  S_i = sum_b V_b W_ib (b: water and walls),
//   s_i = sum_a V_a W_ia / (1 - sum_w V_w W_iw)  (a: water, w: walls): the share of the room around the grain that is wet;
//   w(s): smoothstep from 0 at s = 0.25 to 1 at 0.75. The force on water particle a is the exact opposite of its term:
//   F_ia = -V_i V_a [ (w/S_i)(P_a - P_i) + w' max(P_i, 0)/(1 - S_wall) ] grad_i W_ia.
//   V: volume [m3]; P: pressure [Pa]; W [1/m3]; F [N]. Under water w = 1 and F_i = -V_i grad P_i: exact for a linear
//   pressure on average over the grain's place, also beside walls, whose particles carry the extrapolated pressure.
//   The grain's volume is withdrawn from the water with the same weights, eps_a = 1 - sum_i V_i (w/S_i) W_ai
//   (coupling.porosity), so that what the water takes when it is squeezed is what the grain pays: no energy is made.
//   Source: -V grad P: Robinson, Ramaioli, Luding (2014), eq. 17, doi:10.1016/j.ijmultiphaseflow.2013.11.003; discrete
//   form from the derivative of the energy, as for SPH itself: Price (2012), doi:10.1016/j.jcp.2010.12.011. Own derivation.
#pragma once

#include "core/host_device.hpp"
#include "core/real.hpp"
#include "core/vec3.hpp"

namespace gdesp::coupling {

inline constexpr float dry_share = 0.25f, wet_share = 0.75f;

/// w(s).
GDESP_HD inline float immersion(float s) {
  const float t = real::min(real::max((s - dry_share) / (wet_share - dry_share), 0.0f), 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

/// dw/ds.
GDESP_HD inline float immersion_slope(float s) {
  const float t = real::min(real::max((s - dry_share) / (wet_share - dry_share), 0.0f), 1.0f);
  return 6.0f * t * (1.0f - t) / (wet_share - dry_share);
}

/// Sums around a grain.
struct Surroundings {
  float water;          ///< sum_a V_a W_ia
  float walls;          ///< sum_w V_w W_iw
  float pressure;       ///< sum_b V_b P_b W_ib, Pa
  Vec3f water_gradient, walls_gradient;   ///< 1/m
  Vec3f pressure_gradient;                ///< Pa/m
};

/// Room that walls leave; never less than a corner leaves.
GDESP_HD inline float open_share(float walls) { return real::max(1.0f - walls, 0.1f); }

/// s_i.
GDESP_HD inline float share_in_water(float water, float walls) { return water / open_share(walls); }

/// V w/S: what the grain weighs in the porosity of the water around it, m3.
GDESP_HD inline float deposited_volume(float volume, float water, float walls) {
  const float w = immersion(share_in_water(water, walls));
  return w > 0.0f ? volume * w / (water + walls) : 0.0f;
}

struct Buoyancy {
  Vec3f force;          ///< N, on the grain, of water and walls
  Vec3f gradient;       ///< Pa/m, of the pressure at the grain
  float slope, offset;  ///< the force of the grain on water a is V_a (slope P_a + offset) grad_i W_ia: m3, N m
};

GDESP_HD inline Buoyancy buoyancy(float volume, const Surroundings& q) {
  const float s = share_in_water(q.water, q.walls), w = immersion(s);
  if (!(w > 0.0f)) return {};
  const float open = open_share(q.walls), inverse = 1.0f / (q.water + q.walls);
  const float P = q.pressure * inverse;
  const float squeeze = immersion_slope(s) * real::max(P, 0.0f) / open;
  const Vec3f gradient = (q.pressure_gradient - (q.water_gradient + q.walls_gradient) * P) * inverse;
  const Vec3f wetting = q.water_gradient + q.walls_gradient * s;   // (1 - S_wall) grad s
  return {(gradient * w + wetting * squeeze) * -volume, gradient, volume * w * inverse,
          volume * (squeeze - w * inverse * P)};
}

}  // namespace gdesp::coupling
