// SPDX-License-Identifier: GPL-3.0-or-later
// Sixteen lanes: the pairs of four i particles with four j particles, lane = 4 * i + j. On the CPU the lanes are
// one AVX-512 register (two AVX2 registers); on a GPU they are half a warp. Pair functors are written once, on the
// type Lanes::Real, with the free functions below instead of branches on data.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/host_device.hpp"
#include "core/real.hpp"
#include "exec/backend.hpp"
#include "exec/float4.hpp"

#if defined(__AVX512F__) && !defined(__CUDACC__)
#include <immintrin.h>
#endif

namespace gdesp::exec {

/// Particles in a cluster.
inline constexpr Index cluster_size = 4;

// One real lane (GPU), and the scalars of both.
using real::floor;
using real::inverse_sqrt;
using real::max;
using real::min;
using real::reciprocal;
using real::select;
using real::sqrt;

#if !defined(__CUDACC__)
// Lanes never cross the border of a library: how they are passed there does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

/// Sixteen floats side by side.
struct Float16 {
  typedef float Vector __attribute__((vector_size(64)));
#if defined(__AVX512F__)
  struct Mask {
    __mmask16 bits;
  };  // a bit a lane: comparisons make it, choices take it
#else
  typedef int Mask __attribute__((vector_size(64)));
#endif
  Vector v;

  Float16() = default;
  Float16(Vector x) : v(x) {}
  Float16(float x) : v(x - Vector{}) {}
  Float16& operator+=(const Float16& b) {
    v += b.v;
    return *this;
  }
  Float16& operator-=(const Float16& b) {
    v -= b.v;
    return *this;
  }
};

inline Float16 operator+(const Float16& a, const Float16& b) { return a.v + b.v; }
inline Float16 operator-(const Float16& a, const Float16& b) { return a.v - b.v; }
inline Float16 operator*(const Float16& a, const Float16& b) { return a.v * b.v; }
inline Float16 operator/(const Float16& a, const Float16& b) { return a.v / b.v; }
inline Float16 operator-(const Float16& a) { return -a.v; }
#if defined(__AVX512F__)
inline __m512 packed(const Float16& a) { return reinterpret_cast<__m512>(a.v); }
inline Float16 lanes_of(__m512 a) { return Float16(reinterpret_cast<Float16::Vector>(a)); }
inline Float16::Mask operator<(const Float16& a, const Float16& b) {
  return {_mm512_cmp_ps_mask(packed(a), packed(b), _CMP_LT_OQ)};
}
inline Float16::Mask operator>(const Float16& a, const Float16& b) { return b < a; }
// One instruction each, which the compiler does not see in a comparison and a choice.
inline Float16 max(const Float16& a, const Float16& b) { return lanes_of(_mm512_max_ps(packed(a), packed(b))); }
inline Float16 min(const Float16& a, const Float16& b) { return lanes_of(_mm512_min_ps(packed(a), packed(b))); }
inline Float16 select(const Float16::Mask& c, const Float16& a, const Float16& b) {
  return lanes_of(_mm512_mask_mov_ps(packed(b), c.bits, packed(a)));
}
inline Float16 floor(const Float16& a) {
  return lanes_of(_mm512_roundscale_ps(packed(a), _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC));
}
// The divider takes 12 and 16 cycles for a register; a first guess of 14 bits and a step of Newton's go through the
// ports of multiplication in a third of that, and err by one unit in the last place (docs/decisions/0010).
inline Float16 sqrt(const Float16& a) {
  const __m512 guess = _mm512_rsqrt14_ps(_mm512_max_ps(packed(a), _mm512_set1_ps(1.0e-37f)));
  const __m512 root = _mm512_mul_ps(packed(a), guess), half = _mm512_mul_ps(guess, _mm512_set1_ps(0.5f));
  return lanes_of(_mm512_fmadd_ps(_mm512_fnmadd_ps(root, root, packed(a)), half, root));
}
inline Float16 reciprocal(const Float16& a) {
  const __m512 guess = _mm512_rcp14_ps(packed(a));
  return lanes_of(_mm512_fmadd_ps(_mm512_fnmadd_ps(packed(a), guess, _mm512_set1_ps(1.0f)), guess, guess));
}
#else
inline Float16::Mask operator<(const Float16& a, const Float16& b) { return a.v < b.v; }
inline Float16::Mask operator>(const Float16& a, const Float16& b) { return a.v > b.v; }
inline Float16 max(const Float16& a, const Float16& b) { return a.v > b.v ? a.v : b.v; }
inline Float16 min(const Float16& a, const Float16& b) { return a.v < b.v ? a.v : b.v; }
inline Float16 select(const Float16::Mask& c, const Float16& a, const Float16& b) { return c ? a.v : b.v; }
inline Float16 floor(const Float16& a) {
  Float16 r;
  for (int k = 0; k < 16; ++k) r.v[k] = __builtin_floorf(a.v[k]);
  return r;
}
inline Float16 sqrt(const Float16& a) {
  Float16 r;
  for (int k = 0; k < 16; ++k) r.v[k] = __builtin_sqrtf(a.v[k]);
  return r;
}
inline Float16 reciprocal(const Float16& a) { return Float16(1.0f) / a; }
#endif

struct HostLanes {
  using Real = Float16;
  using Mask = Float16::Mask;

  /// p[i] of the four i particles, each in its four lanes.
  static Real load_i(const float* p) {
#if defined(__AVX512F__)
    // Left to itself the compiler puts the lanes together in memory and waits for them there.
    const __m512i of_lane = _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
    return lanes_of(_mm512_permutevar_ps(_mm512_broadcast_f32x4(_mm_loadu_ps(p)), of_lane));
#else
    return Float16(Float16::Vector{p[0], p[0], p[0], p[0], p[1], p[1], p[1], p[1], p[2], p[2], p[2], p[2], p[3], p[3],
                                   p[3], p[3]});
#endif
  }
  /// p[j] of the four j particles, in every fourth lane.
  static Real load_j(const float* p) {
#if defined(__AVX512F__)
    return Float16(reinterpret_cast<Float16::Vector>(_mm512_broadcast_f32x4(_mm_loadu_ps(p))));
#else
    return Float16(Float16::Vector{p[0], p[1], p[2], p[3], p[0], p[1], p[2], p[3], p[0], p[1], p[2], p[3], p[0], p[1],
                                   p[2], p[3]});
#endif
  }
  /// Sixteen values side by side, a lane each.
  static Real load(const float* p) {
    Float16::Vector v;
    std::memcpy(&v, p, sizeof(v));
    return v;
  }
  /// Which of the four j a lane has: 0, 1, 2 or 3.
  static Real number_of_j() {
    const float j[4] = {0.0f, 1.0f, 2.0f, 3.0f};
    return load_j(j);
  }
  /// What each lane brought, for all of them to look up.
  struct Exchange {
    float of_lane[16];
    float operator[](int lane) const { return of_lane[lane]; }
    /// The four values of i = `quarter`: each in four lanes side by side, and in every fourth lane.
    Real spread(int quarter) const { return load_i(of_lane + 4 * quarter); }
    Real repeated(int quarter) const { return load_j(of_lane + 4 * quarter); }
  };
  static Exchange exchange(const Real& a) {
    Exchange all;
    std::memcpy(all.of_lane, &a.v, sizeof(all.of_lane));
    return all;
  }
  /// Sum of all lanes, p[j] = sum of the four lanes of j; first over i in the order (0 + 1) + (2 + 3).
  static float sum(const Real& a) {
    float of_j[4];
    store_sum_j(of_j, a);
    return (of_j[0] + of_j[1]) + (of_j[2] + of_j[3]);
  }
  static void store_sum_j(float* p, const Real& a) {
    typedef float Four __attribute__((vector_size(16)));
    Four of_i[4];
    std::memcpy(of_i, &a.v, sizeof(of_i));
    const Four total = (of_i[0] + of_i[1]) + (of_i[2] + of_i[3]);
    std::memcpy(p, &total, sizeof(total));
  }
  /// p[i] = sum of the four lanes of i, in the order (0 + 1) + (2 + 3).
  static void store_sum_i(float* p, const Real& a) {
    for (int i = 0; i < 4; ++i) p[i] = (a.v[4 * i] + a.v[4 * i + 1]) + (a.v[4 * i + 2] + a.v[4 * i + 3]);
  }
  /// The same sum, in each of the four lanes of i.
  static Real sum_i(const Real& a) {
    float of_i[4];
    store_sum_i(of_i, a);
    return load_i(of_i);
  }
  /// p[i] = largest of the four lanes of i.
  static void store_max_i(float* p, const Real& a) {
    for (int i = 0; i < 4; ++i) p[i] = max(max(a.v[4 * i], a.v[4 * i + 1]), max(a.v[4 * i + 2], a.v[4 * i + 3]));
  }
  static bool any(const Mask& m) {
#if defined(__AVX512F__)
    return m.bits != 0;
#else
    long long bits = 0;
    long long words[8];
    std::memcpy(words, &m, sizeof(words));
    for (long long w : words) bits |= w;
    return bits != 0;
#endif
  }
  /// Bit 4 * i + j of each lane that is true.
  static unsigned bits(const Mask& m) {
#if defined(__AVX512F__)
    return m.bits;
#else
    unsigned b = 0;
    for (int k = 0; k < 16; ++k) b |= static_cast<unsigned>(m[k] & 1) << k;
    return b;
#endif
  }
  /// visit(lane) for each bit: one after the other here, each by its own thread on a device.
  template <class Visit>
  static void for_each_bit(unsigned b, const Visit& visit) {
    for (; b != 0; b &= b - 1) visit(__builtin_ctz(b));
  }
  /// visit(i) for the four i particles.
  template <class Visit>
  static void for_each_i(const Visit& visit) {
    for (int i = 0; i < 4; ++i) visit(i);
  }
  /// What a lane wrote to memory before, the others of its cluster may read after.
  static void share_memory() {}
  /// True in the lane that writes for its cluster.
  static constexpr bool leader() { return true; }
  /// Takes `amount` places from a counter that all clusters share; returns the first.
  static std::uint32_t allocate(std::uint32_t* counter, std::uint32_t amount) {
    return __atomic_fetch_add(counter, amount, __ATOMIC_RELAXED);
  }
};
#endif

/// Largest values over a row pass, each not negative; the order in which they are taken does not matter.
struct Largest {
  float value[4] = {0.0f, 0.0f, 0.0f, 0.0f};
};

/// Leaves a row pass out when an earlier one found value[0] > limit: several passes can then be given at once, and what
/// the earlier ones found is looked at afterwards (on a GPU: one wait instead of one a pass). A pass that is left out
/// copies `after` to its own result, so that the ones behind it are left out too.
struct Gate {
  const Largest* after = nullptr;
  float limit = 0.0f;

  GDESP_HD bool closed() const { return after && after->value[0] > limit; }
};

/// Takes `amount` places from a counter that all bodies share; returns the first.
GDESP_HD inline std::uint32_t add_to_counter(std::uint32_t* counter, std::uint32_t amount) {
#if defined(__CUDA_ARCH__)
  return atomicAdd(counter, amount);
#else
  return __atomic_fetch_add(counter, amount, __ATOMIC_RELAXED);
#endif
}

/// Adds to a sum in whole units: exact, so the order in which bodies add does not matter.
GDESP_HD inline void add_units(std::int64_t* sum, std::int64_t units) {
#if defined(__CUDA_ARCH__)
  atomicAdd(reinterpret_cast<unsigned long long*>(sum), static_cast<unsigned long long>(units));
#else
  __atomic_fetch_add(sum, units, __ATOMIC_RELAXED);
#endif
}

}  // namespace gdesp::exec

#if !defined(__CUDACC__)
#include "exec/host_row_lanes.hpp"
#endif
