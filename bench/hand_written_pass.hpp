// SPDX-License-Identifier: GPL-3.0-or-later
// The combined fluid pass (accurate form, artificial viscosity, density diffusion, water alone) without the layers of
// the library, on its records and lists: by intrinsics, as one would write it for one machine, and pair by pair in
// scalars. Yardsticks for bench_thin_layer and tests/regression/speed.
#pragma once

#include "sph/fluid_system.hpp"

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace gdesp::bench {

/// What both need: the law, the lists, the records, and factors of the rates.
struct PlainPass {
  sph::FluidPairLaw law;
  float c2, diffusion;  // m2/s2, m2/s
  ClusterListView list;
  const float* record;
  const float* mass_share;  // null: 1
  float* rate;              // ax ay az dD, 4 each, per cluster
};

inline PlainPass plain_pass(sph::FluidSystem<exec::OpenMP>& fluid, float* rate) {
  const sph::FluidParameters& p = fluid.parameters();
  return {fluid.pair_law(),
          static_cast<float>(p.sound_speed * p.sound_speed),
          static_cast<float>(2.0 * p.density_diffusion * p.h * p.sound_speed),
          fluid.fluid_list(),
          fluid.records(),
          fluid.mass_share(),
          rate};
}

/// One pair after the other.
struct ScalarPass {
  PlainPass p;
  __attribute__((optimize("no-tree-vectorize", "no-tree-slp-vectorize"))) void operator()(exec::Index c) const {
    for (int i = 0; i < 4; ++i) {
      const float* ri = p.record + record_offset(c) + i;
      sph::FluidRates<float> sum;
      for_each_cluster(p.list, c, [&](exec::Index j, const Vec3f& shift) {
        for (int k = 0; k < 4; ++k) {
          const float* rj = p.record + record_offset(j) + k;
          sph::add_fluid_pair<true, true, sph::Viscosity::artificial, true>(
              p.law, ri[0] + shift.x - rj[0], ri[4] + shift.y - rj[4], ri[8] + shift.z - rj[8], ri[16] - rj[16],
              ri[20] - rj[20], ri[24] - rj[24], ri[28], rj[28], rj[12], 1.0f, sum);
        }
      });
      const float volume = p.mass_share ? ri[12] / p.mass_share[4 * static_cast<std::int64_t>(c) + i] : ri[12];
      float* out = p.rate + 16 * static_cast<std::int64_t>(c) + i;
      out[0] = p.c2 * volume * sum.ax;
      out[4] = p.c2 * volume * sum.ay;
      out[8] = p.c2 * volume * sum.az;
      out[12] = sum.compression / volume + p.diffusion * sum.diffusion;
    }
  }
};

#if defined(__AVX512F__)
/// Sixteen pairs at once, by intrinsics.
struct HandWrittenPass {
  PlainPass p;

  static __m512 own(const float* q) {
    const __m512i lane = _mm512_set_epi32(3, 3, 3, 3, 2, 2, 2, 2, 1, 1, 1, 1, 0, 0, 0, 0);
    return _mm512_permutexvar_ps(lane, _mm512_castps128_ps512(_mm_loadu_ps(q)));
  }
  static __m512 other(const float* q) { return _mm512_broadcast_f32x4(_mm_loadu_ps(q)); }
  static float of_own(__m512 sum, int i) {
    alignas(64) float lane[16];
    _mm512_store_ps(lane, sum);
    return (lane[4 * i] + lane[4 * i + 1]) + (lane[4 * i + 2] + lane[4 * i + 3]);
  }

  void operator()(exec::Index c) const {
    const float* ri = p.record + record_offset(c);
    const __m512 x = own(ri), y = own(ri + 4), z = own(ri + 8), u = own(ri + 16), v = own(ri + 20), w = own(ri + 24);
    const __m512 a = own(ri + 28), zero = _mm512_setzero_ps(), one = _mm512_set1_ps(1.0f);
    const __m512 fall = _mm512_set1_ps(p.law.inverse_support), slope = _mm512_set1_ps(p.law.slope);
    const __m512 viscosity = _mm512_set1_ps(p.law.artificial), eta2 = _mm512_set1_ps(p.law.eta2);
    const __m512 gx = _mm512_set1_ps(p.law.gx), gy = _mm512_set1_ps(p.law.gy), gz = _mm512_set1_ps(p.law.gz);
    const __m512 half = _mm512_set1_ps(0.5f), least = _mm512_set1_ps(1.0e-37f);
    __m512 ax = zero, ay = zero, az = zero, compression = zero, diffusion = zero;
    for_each_cluster(p.list, c, [&](exec::Index j, const Vec3f& shift) {
      const float* rj = p.record + record_offset(j);
      const __m512 dx = _mm512_sub_ps(_mm512_add_ps(x, _mm512_set1_ps(shift.x)), other(rj));
      const __m512 dy = _mm512_sub_ps(_mm512_add_ps(y, _mm512_set1_ps(shift.y)), other(rj + 4));
      const __m512 dz = _mm512_sub_ps(_mm512_add_ps(z, _mm512_set1_ps(shift.z)), other(rj + 8));
      const __m512 du = _mm512_sub_ps(u, other(rj + 16)), dv = _mm512_sub_ps(v, other(rj + 20));
      const __m512 dw = _mm512_sub_ps(w, other(rj + 24)), aj = other(rj + 28);
      const __m512 r2 = _mm512_fmadd_ps(dz, dz, _mm512_fmadd_ps(dy, dy, _mm512_mul_ps(dx, dx)));
      const __m512 guess = _mm512_rsqrt14_ps(_mm512_max_ps(r2, least)), root = _mm512_mul_ps(r2, guess);
      const __m512 r = _mm512_fmadd_ps(_mm512_fnmadd_ps(root, root, r2), _mm512_mul_ps(guess, half), root);
      const __m512 t = _mm512_max_ps(zero, _mm512_fnmadd_ps(r, fall, one));
      const __m512 G = _mm512_mul_ps(_mm512_mul_ps(_mm512_mul_ps(_mm512_mul_ps(slope, other(rj + 12)), t), t), t);
      const __m512 vr = _mm512_fmadd_ps(dw, dz, _mm512_fmadd_ps(dv, dy, _mm512_mul_ps(du, dx)));
      const __m512 d = _mm512_add_ps(r2, eta2), q = _mm512_rcp14_ps(d);
      const __m512 inverse = _mm512_fmadd_ps(_mm512_fnmadd_ps(d, q, one), q, q);
      const __m512 closing = _mm512_mul_ps(_mm512_min_ps(vr, zero), viscosity);
      const __m512 push = _mm512_mul_ps(G, _mm512_fnmadd_ps(closing, inverse, _mm512_add_ps(a, aj)));
      ax = _mm512_fmadd_ps(push, dx, ax);
      ay = _mm512_fmadd_ps(push, dy, ay);
      az = _mm512_fmadd_ps(push, dz, az);
      compression = _mm512_fnmadd_ps(G, vr, compression);
      const __m512 jump = _mm512_sub_ps(aj, a);
      const __m512 head = _mm512_fmadd_ps(gz, dz, _mm512_fmadd_ps(gy, dy, _mm512_fmadd_ps(gx, dx, jump)));
      const __m512 kept = _mm512_max_ps(_mm512_min_ps(head, _mm512_max_ps(jump, zero)), _mm512_min_ps(jump, zero));
      diffusion = _mm512_fmadd_ps(G, kept, diffusion);
    });
    float* out = p.rate + 16 * static_cast<std::int64_t>(c);
    for (int i = 0; i < 4; ++i) {
      const float volume = p.mass_share ? ri[12 + i] / p.mass_share[4 * static_cast<std::int64_t>(c) + i] : ri[12 + i];
      out[i] = p.c2 * volume * of_own(ax, i);
      out[4 + i] = p.c2 * volume * of_own(ay, i);
      out[8 + i] = p.c2 * volume * of_own(az, i);
      out[12 + i] = of_own(compression, i) / volume + p.diffusion * of_own(diffusion, i);
    }
  }
};
#endif

/// Runs a pass over all clusters on the threads there are, as exec::pair_pass does.
template <class Pass>
void run_plain(const Pass& pass, exec::Index clusters) {
#pragma omp parallel for schedule(dynamic, 64)
  for (exec::Index c = 0; c < clusters; ++c) pass(c);
}

/// Largest difference between two sets of rates, over the largest size of that quantity.
inline double largest_difference(const float* a, const float* b, exec::Index clusters) {
  double worst = 0.0;
  for (int row = 0; row < 4; ++row) {
    double difference = 0.0, size = 1.0e-30;
    for (exec::Index s = 0; s < 4 * clusters; ++s) {
      const std::int64_t at = 16 * static_cast<std::int64_t>(s / 4) + 4 * row + s % 4;
      difference = std::max(difference, std::abs(static_cast<double>(a[at]) - static_cast<double>(b[at])));
      size = std::max(size, std::abs(static_cast<double>(b[at])));
    }
    worst = std::max(worst, difference / size);
  }
  return worst;
}

}  // namespace gdesp::bench
