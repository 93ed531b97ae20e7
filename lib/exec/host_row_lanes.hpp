// SPDX-License-Identifier: GPL-3.0-or-later
// Eight lanes on the CPU: one AVX register of floats (the compiler takes two SSE registers without AVX). Included by
// exec/lanes.hpp for the host compiler only.
#pragma once

namespace gdesp::exec {

/// Eight integers side by side.
struct Int8 {
  typedef std::int32_t Vector __attribute__((vector_size(32)));
  Vector v;
  Int8() = default;
  Int8(Vector x) : v(x) {}
  Int8(std::int32_t x) : v(x - Vector{}) {}
};
/// Wraps around, as differences of fractions of a tile are meant to.
inline Int8 operator-(const Int8& a, const Int8& b) {
  typedef std::uint32_t Unsigned __attribute__((vector_size(32)));
  return reinterpret_cast<Int8::Vector>(reinterpret_cast<Unsigned>(a.v) - reinterpret_cast<Unsigned>(b.v));
}
inline Int8::Vector operator==(const Int8& a, const Int8& b) { return a.v == b.v; }

/// Eight floats side by side.
struct Float8 {
  typedef float Vector __attribute__((vector_size(32)));
#if defined(__AVX512VL__)
  struct Mask {
    __mmask8 bits;
  };  // a bit a lane
#else
  typedef std::int32_t Mask __attribute__((vector_size(32)));
#endif
  Vector v;

  Float8() = default;
  Float8(Vector x) : v(x) {}
  Float8(float x) : v(x - Vector{}) {}
  Float8& operator+=(const Float8& b) {
    v += b.v;
    return *this;
  }
  Float8& operator-=(const Float8& b) {
    v -= b.v;
    return *this;
  }
  Float8& operator*=(const Float8& b) {
    v *= b.v;
    return *this;
  }
};

inline Float8 operator+(const Float8& a, const Float8& b) { return a.v + b.v; }
inline Float8 operator-(const Float8& a, const Float8& b) { return a.v - b.v; }
inline Float8 operator*(const Float8& a, const Float8& b) { return a.v * b.v; }
inline Float8 operator/(const Float8& a, const Float8& b) { return a.v / b.v; }
inline Float8 operator-(const Float8& a) { return -a.v; }
#if defined(__AVX512VL__)
inline __m256 packed(const Float8& a) { return reinterpret_cast<__m256>(a.v); }
inline Float8::Mask operator<(const Float8& a, const Float8& b) {
  return {_mm256_cmp_ps_mask(packed(a), packed(b), _CMP_LT_OQ)};
}
inline Float8::Mask operator>(const Float8& a, const Float8& b) { return b < a; }
inline Float8 select(const Float8::Mask& c, const Float8& a, const Float8& b) {
  return Float8(reinterpret_cast<Float8::Vector>(_mm256_mask_mov_ps(packed(b), c.bits, packed(a))));
}
#else
inline Float8::Mask operator<(const Float8& a, const Float8& b) { return a.v < b.v; }
inline Float8::Mask operator>(const Float8& a, const Float8& b) { return a.v > b.v; }
inline Float8 select(const Float8::Mask& c, const Float8& a, const Float8& b) { return c ? a.v : b.v; }
#endif
#if defined(__AVX__)
// One instruction each, which the compiler does not see in a comparison and a choice.
inline Float8 max(const Float8& a, const Float8& b) { return Float8(__builtin_ia32_maxps256(a.v, b.v)); }
inline Float8 min(const Float8& a, const Float8& b) { return Float8(__builtin_ia32_minps256(a.v, b.v)); }
#else
inline Float8 max(const Float8& a, const Float8& b) { return a.v > b.v ? a.v : b.v; }
inline Float8 min(const Float8& a, const Float8& b) { return a.v < b.v ? a.v : b.v; }
#endif
inline Float8 sqrt(const Float8& a) {
#if defined(__AVX__)
  return Float8(__builtin_ia32_sqrtps256(a.v));
#else
  Float8 r;
  for (int k = 0; k < 8; ++k) r.v[k] = __builtin_sqrtf(a.v[k]);
  return r;
#endif
}

#if defined(__AVX512VL__)
inline Float8 inverse_sqrt(const Float8& a) {
  const __m256 guess = _mm256_rsqrt14_ps(packed(a)), half = _mm256_mul_ps(guess, _mm256_set1_ps(0.5f));
  const __m256 error = _mm256_fnmadd_ps(_mm256_mul_ps(packed(a), guess), guess, _mm256_set1_ps(1.0f));
  return Float8(reinterpret_cast<Float8::Vector>(_mm256_fmadd_ps(error, half, guess)));
}
#else
inline Float8 inverse_sqrt(const Float8& a) { return Float8(1.0f) / sqrt(a); }
#endif

/// The eight lanes of one row of contacts; the same interface as DeviceRowLanes.
struct HostRowLanes {
  using Real = Float8;
  using Int = Int8;
  using Mask = Float8::Mask;

  static Real load(const float* p) {
    Float8::Vector v;
    std::memcpy(&v, p, sizeof(v));
    return v;
  }
  static Int load(const std::int32_t* p) {
    Int8::Vector v;
    std::memcpy(&v, p, sizeof(v));
    return v;
  }
  static void store(float* p, const Real& a) { std::memcpy(p, &a.v, sizeof(a.v)); }
  static void store(std::int32_t* p, const Int& a) { std::memcpy(p, &a.v, sizeof(a.v)); }
  /// The bits of a float as an integer, and an integer's value as a float.
  static Int bits(const Real& a) { return Int8::Vector(a.v); }
  static Real value(const Int& a) { return __builtin_convertvector(a.v, Float8::Vector); }
  static Int truncate(const Real& a) { return __builtin_convertvector(a.v, Int8::Vector); }
  static Int scaled(const Int& a, std::int32_t by) { return a.v * by; }

  /// Four floats from each of eight records: out[k] = p[stride * index + k].
  static void gather4(const float* p, int stride, const Int& index, Real out[4]) {
    typedef float Four __attribute__((vector_size(16)));
    Four q[8];
    for (int k = 0; k < 8; ++k) {
      std::memcpy(&q[k], p + static_cast<std::int64_t>(index.v[k]) * stride, sizeof(Four));
    }
    Float8::Vector a[4];
    for (int k = 0; k < 4; ++k) a[k] = __builtin_shufflevector(q[k], q[k + 4], 0, 1, 2, 3, 4, 5, 6, 7);
    const auto low_01 = __builtin_shufflevector(a[0], a[1], 0, 8, 1, 9, 4, 12, 5, 13);
    const auto low_23 = __builtin_shufflevector(a[2], a[3], 0, 8, 1, 9, 4, 12, 5, 13);
    const auto high_01 = __builtin_shufflevector(a[0], a[1], 2, 10, 3, 11, 6, 14, 7, 15);
    const auto high_23 = __builtin_shufflevector(a[2], a[3], 2, 10, 3, 11, 6, 14, 7, 15);
    out[0] = Float8(__builtin_shufflevector(low_01, low_23, 0, 1, 8, 9, 4, 5, 12, 13));
    out[1] = Float8(__builtin_shufflevector(low_01, low_23, 2, 3, 10, 11, 6, 7, 14, 15));
    out[2] = Float8(__builtin_shufflevector(high_01, high_23, 0, 1, 8, 9, 4, 5, 12, 13));
    out[3] = Float8(__builtin_shufflevector(high_01, high_23, 2, 3, 10, 11, 6, 7, 14, 15));
  }
  /// One float from each of eight places.
  static Real gather(const float* p, const Int& index) {
    Real r;
    for (int k = 0; k < 8; ++k) r.v[k] = p[index.v[k]];
    return r;
  }

  /// Sum of the lanes in the order ((0+4)+(2+6)) + ((1+5)+(3+7)).
  static float sum(const Real& a) {
    typedef float Four __attribute__((vector_size(16)));
    const Four q = __builtin_shufflevector(a.v, a.v, 0, 1, 2, 3) + __builtin_shufflevector(a.v, a.v, 4, 5, 6, 7);
    return (q[0] + q[2]) + (q[1] + q[3]);
  }
  /// sum() of three at once: x, y, z and 0.
  static Float4 sums(const Real& x, const Real& y, const Real& z) {
    typedef float Four __attribute__((vector_size(16)));
    const auto half = [](const Real& a) {
      return __builtin_shufflevector(a.v, a.v, 0, 1, 2, 3) + __builtin_shufflevector(a.v, a.v, 4, 5, 6, 7);
    };
    const Four qx = half(x), qy = half(y), qz = half(z), none{};
    const Four xy = __builtin_shufflevector(qx, qy, 0, 4, 1, 5) + __builtin_shufflevector(qx, qy, 2, 6, 3, 7);
    const Four zw = __builtin_shufflevector(qz, none, 0, 4, 1, 5) + __builtin_shufflevector(qz, none, 2, 6, 3, 7);
    return Float4(__builtin_shufflevector(xy, zw, 0, 1, 4, 5) + __builtin_shufflevector(xy, zw, 2, 3, 6, 7));
  }
  static float largest(const Real& a) {
    typedef float Four __attribute__((vector_size(16)));
    const Four x = __builtin_shufflevector(a.v, a.v, 0, 1, 2, 3), y = __builtin_shufflevector(a.v, a.v, 4, 5, 6, 7);
    const Four q = x > y ? x : y;
    return max(max(q[0], q[2]), max(q[1], q[3]));
  }
  static bool any(const Mask& m) {
#if defined(__AVX512VL__)
    return m.bits != 0;
#else
    long long words[4];
    std::memcpy(words, &m, sizeof(words));
    return ((words[0] | words[1]) | (words[2] | words[3])) != 0;
#endif
  }
  /// True in the lane that acts alone for its row.
  static constexpr bool leader() { return true; }
  /// What one lane wrote to memory, all lanes of the row may read after this.
  static void share_memory() {}
};

}  // namespace gdesp::exec
