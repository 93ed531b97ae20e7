// SPDX-License-Identifier: GPL-3.0-or-later
// Four floats side by side: the three components of a vector and room for one number more. For the pointwise part of a
// loop, where a particle's own quantities change together. On the CPU a register; on a device four numbers of one thread.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/host_device.hpp"
#include "core/vec3.hpp"

#if defined(__SSE4_1__) && !defined(__CUDACC__)
#include <smmintrin.h>
#endif

namespace gdesp::exec {

#if !defined(__CUDACC__)
#pragma GCC diagnostic ignored "-Wpsabi"

struct Float4 {
  typedef float Vector __attribute__((vector_size(16)));
  Vector v;
  Float4() = default;
  Float4(Vector a) : v(a) {}
  Float4(float x, float y, float z, float w) : v(Vector{x, y, z, w}) {}
  float operator[](int k) const { return v[k]; }
};
struct Int4 {
  typedef std::uint32_t Vector __attribute__((vector_size(16)));  // unsigned: sums wrap around
  Vector v;
};

inline Float4 operator+(const Float4& a, const Float4& b) { return a.v + b.v; }
inline Float4 operator-(const Float4& a, const Float4& b) { return a.v - b.v; }
inline Float4 operator*(const Float4& a, const Float4& b) { return a.v * b.v; }
inline Float4 operator/(const Float4& a, const Float4& b) { return a.v / b.v; }
inline Float4 operator*(float s, const Float4& a) { return a.v * s; }
inline Int4 operator+(const Int4& a, const Int4& b) { return {a.v + b.v}; }
inline Int4 operator-(const Int4& a, const Int4& b) { return {a.v - b.v}; }

/// Four floats from 16 aligned bytes, and back.
inline Float4 load4(const float* p) {
  Float4 a;
  std::memcpy(&a.v, p, sizeof(a.v));
  return a;
}
inline void store4(float* p, const Float4& a) { std::memcpy(p, &a.v, sizeof(a.v)); }
/// The bits as integers, and back.
inline Int4 bits(const Float4& a) { return {Int4::Vector(a.v)}; }
inline Float4 from_bits(const Int4& a) { return Float4::Vector(a.v); }
/// The values as floats, and whole floats as integers.
inline Float4 value(const Int4& a) {
  typedef std::int32_t Signed __attribute__((vector_size(16)));
  return __builtin_convertvector(Signed(a.v), Float4::Vector);
}
inline Int4 truncate(const Float4& a) {
  typedef std::int32_t Signed __attribute__((vector_size(16)));
  return {Int4::Vector(__builtin_convertvector(a.v, Signed))};
}
/// Rounded to whole numbers, halves to even ones.
inline Float4 rint(const Float4& a) {
#if defined(__SSE4_1__)
  return Float4::Vector(_mm_round_ps(reinterpret_cast<__m128>(a.v), _MM_FROUND_CUR_DIRECTION));
#else
  return {::rintf(a.v[0]), ::rintf(a.v[1]), ::rintf(a.v[2]), ::rintf(a.v[3])};
#endif
}
/// a with the last number of b.
inline Float4 with_last_of(const Float4& a, const Float4& b) { return __builtin_shufflevector(a.v, b.v, 0, 1, 2, 7); }
/// x, y, z and 0.
inline Float4 load3(const Vec3f& a) { return {a.x, a.y, a.z, 0.0f}; }
inline Int4 load3(const Vec3<std::int32_t>& a) {
  return {Int4::Vector{static_cast<std::uint32_t>(a.x), static_cast<std::uint32_t>(a.y),
                       static_cast<std::uint32_t>(a.z), 0u}};
}

#else  // a device, or its host side

struct alignas(16) Float4 {
  float v[4];
  Float4() = default;
  GDESP_HD Float4(float x, float y, float z, float w) : v{x, y, z, w} {}
  GDESP_HD float operator[](int k) const { return v[k]; }
};
struct alignas(16) Int4 {
  std::uint32_t v[4];
};

GDESP_HD inline Float4 operator+(const Float4& a, const Float4& b) {
  return {a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2], a.v[3] + b.v[3]};
}
GDESP_HD inline Float4 operator-(const Float4& a, const Float4& b) {
  return {a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2], a.v[3] - b.v[3]};
}
GDESP_HD inline Float4 operator*(const Float4& a, const Float4& b) {
  return {a.v[0] * b.v[0], a.v[1] * b.v[1], a.v[2] * b.v[2], a.v[3] * b.v[3]};
}
GDESP_HD inline Float4 operator/(const Float4& a, const Float4& b) {
  return {a.v[0] / b.v[0], a.v[1] / b.v[1], a.v[2] / b.v[2], a.v[3] / b.v[3]};
}
GDESP_HD inline Float4 operator*(float s, const Float4& a) { return {s * a.v[0], s * a.v[1], s * a.v[2], s * a.v[3]}; }
GDESP_HD inline Int4 operator+(const Int4& a, const Int4& b) {
  return {{a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2], a.v[3] + b.v[3]}};
}
GDESP_HD inline Int4 operator-(const Int4& a, const Int4& b) {
  return {{a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2], a.v[3] - b.v[3]}};
}
GDESP_HD inline Float4 load4(const float* p) { return *reinterpret_cast<const Float4*>(p); }
GDESP_HD inline void store4(float* p, const Float4& a) { *reinterpret_cast<Float4*>(p) = a; }
GDESP_HD inline Int4 bits(const Float4& a) {
  Int4 b;
  memcpy(&b, &a, sizeof(b));
  return b;
}
GDESP_HD inline Float4 from_bits(const Int4& a) {
  Float4 b;
  memcpy(&b, &a, sizeof(b));
  return b;
}
GDESP_HD inline Float4 value(const Int4& a) {
  return {static_cast<float>(static_cast<std::int32_t>(a.v[0])), static_cast<float>(static_cast<std::int32_t>(a.v[1])),
          static_cast<float>(static_cast<std::int32_t>(a.v[2])), static_cast<float>(static_cast<std::int32_t>(a.v[3]))};
}
GDESP_HD inline Int4 truncate(const Float4& a) {
  Int4 b;
  for (int k = 0; k < 4; ++k) b.v[k] = static_cast<std::uint32_t>(static_cast<std::int32_t>(a.v[k]));
  return b;
}
GDESP_HD inline Float4 rint(const Float4& a) {
  return {::rintf(a.v[0]), ::rintf(a.v[1]), ::rintf(a.v[2]), ::rintf(a.v[3])};
}
GDESP_HD inline Float4 with_last_of(const Float4& a, const Float4& b) { return {a.v[0], a.v[1], a.v[2], b.v[3]}; }
GDESP_HD inline Float4 load3(const Vec3f& a) { return {a.x, a.y, a.z, 0.0f}; }
GDESP_HD inline Int4 load3(const Vec3<std::int32_t>& a) {
  return {{static_cast<std::uint32_t>(a.x), static_cast<std::uint32_t>(a.y), static_cast<std::uint32_t>(a.z), 0u}};
}
#endif

GDESP_HD inline Vec3f first3(const Float4& a) { return {a[0], a[1], a[2]}; }
GDESP_HD inline float dot3(const Float4& a, const Float4& b) {
  const Float4 c = a * b;
  return (c[0] + c[1]) + c[2];
}

}  // namespace gdesp::exec
