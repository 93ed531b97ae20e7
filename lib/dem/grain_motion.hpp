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
//   v_new = (v + k/M (F + b u)) / (1 + k b/M);  impulse on the grain J = k b (u - v_new) = M (v_new - v) - k F
//   b: drag coefficient [kg/s]; u: fluid velocity at the grain [m/s]; M = m + added mass [kg]; F: all other forces.
//   Implicit Euler for the relaxation: stable for any k b/M, monotone towards u.
//   Source: the backward Euler rule on m dv/dt = F + b (u - v), eq. 11 of the G-DeSp paper.
#pragma once

#include "core/host_device.hpp"

namespace gdesp::dem {

/// v_new, m/s, of one component or of all. `share` = k/M, s/kg.
template <class R>
GDESP_HD inline R dragged_velocity(const R& v, float share, const R& force, float drag, const R& u) {
  return (1.0f / (1.0f + share * drag)) * (v + share * (force + drag * u));
}

/// I / (m R^2).
GDESP_HD inline float inertia_factor(int dimensions) { return dimensions == 2 ? 0.5f : 0.4f; }

}  // namespace gdesp::dem
