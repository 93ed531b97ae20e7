// SPDX-License-Identifier: GPL-3.0-or-later
// What every contact law gives for one contact: an elastic force and the coefficients of the other terms. Laws are
// written on a real type R (float, or eight lanes), without branches on data, and do not change when i and j are
// exchanged: both copies of a contact agree to the last bit.
#pragma once

#include "core/host_device.hpp"
#include "core/real.hpp"

namespace gdesp::dem {

/// Sign convention: r_ij = r_i - r_j, n = r_ij / |r_ij| points at i; overlap = radius_i + radius_j - |r_ij| > 0.
template <class R>
struct ContactCoefficients {
  R elastic_force;         ///< N, along +n on i
  R normal_stiffness;      ///< N/m, d(elastic_force)/d(overlap)
  R normal_damping;        ///< N s/m, times -(v_ij . n)
  R tangential_stiffness;  ///< N/m
  R tangential_damping;    ///< N s/m
};

/// a b / (a + b): effective radius, effective mass.
template <class R>
GDESP_HD inline R harmonic_half(const R& a, const R& b) {
  return (a * b) / (a + b);
}

}  // namespace gdesp::dem
