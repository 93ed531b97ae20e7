// SPDX-License-Identifier: GPL-3.0-or-later
// @eq dem.motion.leapfrog
//   v(n+1/2) = v(n-1/2) + F(n)/m k,  r(n+1) = r(n) + v(n+1/2) dt,  k = (dt_before + dt)/2;
//   w(n+1/2) = w(n-1/2) + T(n)/I k;  velocity in the forces: v(n+1) = v(n+1/2) + (dt/2) F(n)/m
//   r: position [m]; v: velocity [m/s]; w: angular velocity [rad/s]; m: mass [kg]; I: moment of inertia [kg m2],
//   2/5 m R^2 of a sphere, 1/2 m R^2 of a disc; F, T: force [N], torque [N m]. dt_before = 0 at the start, where v is
//   that of time 0. Second order in dt, also with forces that depend on velocity.
//   Source: Hockney & Eastwood (1988), Computer Simulation Using Particles, section 4-3, doi:10.1201/9780367806934;
//   velocity predicted for the forces: Groot & Warren (1997), J. Chem. Phys. 107, 4423, doi:10.1063/1.474784, eq. 9.
// @eq dem.motion.drag
//   J = k b (w + k (a_u - F/M)) / (1 + k b (1/M + 1/m_f)),  w = u - v;
//   v_new = v + (k F + J)/M,  u_new = u + k a_u - J/m_f
//   J: impulse on the grain [N s] in the time k [s], and with the other sign on the water; b: drag coefficient [kg/s]; u, v:
//   velocity of the water at the grain, of the grain [m/s]; M = m + added mass [kg]; m_f: mass of the water that shares the
//   drag [kg]; F: all other forces on the grain [N]; a_u: acceleration of the water but for drag [m/s2].
//   Implicit for the slip: monotone and stable for any k b; where F and a_u are steady so is w = mu (a_u - F/M)/b,
//   mu = M m_f/(M + m_f), for any k: the terminal velocity knows no step.
//   Source: the backward Euler rule on M dv/dt = F + b (u - v), m_f du/dt = m_f a_u - b (u - v); eq. 11 of the G-DeSp paper.
#pragma once

#include "core/host_device.hpp"

namespace gdesp::dem {

/// What drag acts between.
struct DraggedPair {
  float drag;                          ///< b, kg/s
  float inverse_grain, inverse_water;  ///< 1/M, 1/m_f; 1/kg
};

/// J, N s, of one component or of all. `slip` = w + k (a_u - F/M), m/s: what it would be without drag; `kick` = k, s.
template <class R>
GDESP_HD inline R drag_impulse(const DraggedPair& p, float kick, const R& slip) {
  return (kick * p.drag / (1.0f + kick * p.drag * (p.inverse_grain + p.inverse_water))) * slip;
}

/// I / (m R^2).
GDESP_HD inline float inertia_factor(int dimensions) { return dimensions == 2 ? 0.5f : 0.4f; }

}  // namespace gdesp::dem
