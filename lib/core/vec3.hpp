// SPDX-License-Identifier: GPL-3.0-or-later
// Three components, for host and device. The sign conventions of the project: r_ij = r_i - r_j, v_ij = v_i - v_j.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/host_device.hpp"

namespace gdesp {

template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  GDESP_HD T& operator[](int axis) { return axis == 0 ? x : (axis == 1 ? y : z); }
  GDESP_HD const T& operator[](int axis) const { return axis == 0 ? x : (axis == 1 ? y : z); }

  GDESP_HD Vec3& operator+=(const Vec3& b) {
    x += b.x;
    y += b.y;
    z += b.z;
    return *this;
  }
  GDESP_HD Vec3& operator-=(const Vec3& b) {
    x -= b.x;
    y -= b.y;
    z -= b.z;
    return *this;
  }
  GDESP_HD Vec3& operator*=(T s) {
    x *= s;
    y *= s;
    z *= s;
    return *this;
  }

  template <class U>
  GDESP_HD explicit operator Vec3<U>() const {
    return {static_cast<U>(x), static_cast<U>(y), static_cast<U>(z)};
  }
};

template <class T>
GDESP_HD Vec3<T> operator+(Vec3<T> a, const Vec3<T>& b) {
  return a += b;
}
template <class T>
GDESP_HD Vec3<T> operator-(Vec3<T> a, const Vec3<T>& b) {
  return a -= b;
}
template <class T>
GDESP_HD Vec3<T> operator-(const Vec3<T>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
GDESP_HD Vec3<T> operator*(Vec3<T> a, T s) {
  return a *= s;
}
template <class T>
GDESP_HD Vec3<T> operator*(T s, Vec3<T> a) {
  return a *= s;
}
template <class T>
GDESP_HD bool operator==(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}
template <class T>
GDESP_HD T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
GDESP_HD Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
GDESP_HD T norm(const Vec3<T>& a) {
  return std::sqrt(dot(a, a));
}

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

}  // namespace gdesp
