// SPDX-License-Identifier: GPL-3.0-or-later
// @eq rigid.motion
//   m dV/dt = F + m g,  dL/dt = T;  a step h: drift h/2, forces at mid-step, V += h (F/m + g), L += h T, drift h/2.
//   m: mass [kg]; V: velocity of the centre [m/s]; F: force [N]; L: angular momentum [kg m2/s] and T: torque [N m] about the
//   centre, in world axes. Position Verlet: second order, exact for constant F. Source: Hairer, Lubich, Wanner (2003),
//   Acta Numerica 12, 399, doi:10.1017/S0962492902000144.
// @eq rigid.rotation
//   Free rotation over h: about the principal axes 1, 2, 3, 2, 1 in turn by the angles theta_k = h_k P_k/I_k (h_k = h/2, h/2, h),
//   q <- q (cos theta_k/2, e_k sin theta_k/2),  P <- rotation of P about e_k by -theta_k.
//   q: unit quaternion from principal to world axes; P: angular momentum in principal axes; I_k: principal moments [kg m2].
//   L = q P q* is kept to round-off, the energy to second order without drift (a symplectic splitting).
//   Source: Dullweber, Leimkuhler, McLachlan (1997), J. Chem. Phys. 107, 5840, doi:10.1063/1.474310.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/vec3.hpp"

namespace gdesp::dem {

/// Unit quaternion w + x i + y j + z k; turns body vectors into world vectors.
struct Quaternion {
  double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
};

inline Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
inline Quaternion conjugate(const Quaternion& q) { return {q.w, -q.x, -q.y, -q.z}; }
inline Quaternion normalised(const Quaternion& q) {
  const double s = 1.0 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {s * q.w, s * q.x, s * q.y, s * q.z};
}

/// Of a rotation's matrix, row by row. The largest of the four comes from the diagonal, so that nothing is divided by a small number
/// (Shepperd 1978, doi:10.2514/3.55767b).
inline Quaternion quaternion_of(const double r[9]) {
  const double square[4] = {r[0] + r[4] + r[8], r[0], r[4], r[8]};
  const int largest = static_cast<int>(std::max_element(square, square + 4) - square);
  double q[4];
  if (largest == 0) {
    q[0] = 1.0 + square[0];
    q[1] = r[7] - r[5];
    q[2] = r[2] - r[6];
    q[3] = r[3] - r[1];
  } else {
    const int i = largest - 1, j = (i + 1) % 3, k = (i + 2) % 3;
    q[0] = r[3 * k + j] - r[3 * j + k];
    q[1 + i] = 1.0 + r[4 * i] - r[4 * j] - r[4 * k];
    q[1 + j] = r[3 * j + i] + r[3 * i + j];
    q[1 + k] = r[3 * k + i] + r[3 * i + k];
  }
  return normalised({q[0], q[1], q[2], q[3]});
}

/// Row by row.
inline void to_matrix(const Quaternion& q, double m[9]) {
  m[0] = 1.0 - 2.0 * (q.y * q.y + q.z * q.z);
  m[1] = 2.0 * (q.x * q.y - q.w * q.z);
  m[2] = 2.0 * (q.x * q.z + q.w * q.y);
  m[3] = 2.0 * (q.x * q.y + q.w * q.z);
  m[4] = 1.0 - 2.0 * (q.x * q.x + q.z * q.z);
  m[5] = 2.0 * (q.y * q.z - q.w * q.x);
  m[6] = 2.0 * (q.x * q.z - q.w * q.y);
  m[7] = 2.0 * (q.y * q.z + q.w * q.x);
  m[8] = 1.0 - 2.0 * (q.x * q.x + q.y * q.y);
}
inline Vec3d multiply(const double m[9], const Vec3d& v) {
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
          m[6] * v.x + m[7] * v.y + m[8] * v.z};
}
inline Vec3d rotated(const Quaternion& q, const Vec3d& v) {
  double m[9];
  to_matrix(q, m);
  return multiply(m, v);
}

/// One turn of the splitting: about principal axis `axis` for a time h (s).
inline void turn_about(int axis, double h, const Vec3d& inertia, Quaternion& q, Vec3d& p) {
  if (!(inertia[axis] > 0.0)) return;
  const double theta = h * p[axis] / inertia[axis], c = std::cos(theta), s = std::sin(theta);
  const int j = (axis + 1) % 3, k = (axis + 2) % 3;
  const double pj = c * p[j] + s * p[k], pk = c * p[k] - s * p[j];
  p[j] = pj;
  p[k] = pk;
  Vec3d e;
  e[axis] = std::sin(0.5 * theta);
  q = q * Quaternion{std::cos(0.5 * theta), e.x, e.y, e.z};
}

/// Orientation after a free rotation of h (s) with angular momentum L (kg m2/s, world) and principal moments (kg m2).
inline Quaternion freely_rotated(Quaternion q, const Vec3d& L, const Vec3d& inertia, double h) {
  Vec3d p = rotated(conjugate(q), L);
  turn_about(0, 0.5 * h, inertia, q, p);
  turn_about(1, 0.5 * h, inertia, q, p);
  turn_about(2, h, inertia, q, p);
  turn_about(1, 0.5 * h, inertia, q, p);
  turn_about(0, 0.5 * h, inertia, q, p);
  return normalised(q);
}

/// rad/s, world axes.
inline Vec3d angular_velocity(const Quaternion& q, const Vec3d& L, const Vec3d& inertia) {
  Vec3d p = rotated(conjugate(q), L);
  for (int k = 0; k < 3; ++k) p[k] = inertia[k] > 0.0 ? p[k] / inertia[k] : 0.0;
  return rotated(q, p);
}

}  // namespace gdesp::dem
