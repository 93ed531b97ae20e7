// SPDX-License-Identifier: GPL-3.0-or-later
// What the pointwise kernels of the fluid see of a FluidSystem.
#pragma once

#include "neighbors/cluster_list.hpp"
#include "sph/cavitation.hpp"
#include "sph/tait.hpp"

namespace gdesp::sph {

// Writes the record of a slot from its state.
struct RecordPacker {
  Domain domain;
  bool paper_form;
  const Vec3<std::int32_t>* cluster_tile;
  const std::uint32_t* id;
  const float* porosity;    // null: 1
  const float* mass_share;  // null: 1
  bool cavitates;
  float* record;
  bool keeps_pressure = false;  // that of the record stays

  GDESP_HD void operator()(Index slot, const FixedPosition& p, const Vec3f& v, float D) const {
    const Index c = slot / exec::cluster_size;
    float* r = record + record_offset(c) + slot % exec::cluster_size;
    if (id[slot] == no_particle) {
      r[0] = r[4] = r[8] = padding_coordinate;
      r[12] = 1.0f;
      r[16] = r[20] = r[24] = r[28] = 0.0f;
      return;
    }
    const Vec3f x = domain.relative_to_tile(p, cluster_tile[c]);
    const float ratio = 1.0f + D;
    const float at_rest = porosity ? porosity[slot] : 1.0f;
    const float A = cavitated_pressure(tait_pressure(porosity ? ratio / at_rest - 1.0f : D), cavitates);
    const float M = mass_share ? mass_share[slot] : 1.0f;
    r[0] = x.x;
    r[4] = x.y;
    r[8] = x.z;
    r[12] = paper_form ? M : M / cavitated_density(ratio, at_rest, cavitates);
    r[16] = v.x;
    r[20] = v.y;
    r[24] = v.z;
    if (!keeps_pressure) r[28] = paper_form ? A / (ratio * ratio) : A;
  }
};

struct FluidStateView {
  FixedPosition* position;
  Vec3f* velocity;
  float* density;
  const float* rate;
  const Vec3f* external;  // null: none
  Vec3f gravity;

  GDESP_HD float rate_at(Index slot, int row) const {
    return rate[16 * static_cast<std::int64_t>(slot / exec::cluster_size) + 4 * row + slot % exec::cluster_size];
  }
  GDESP_HD Vec3f acceleration(Index slot) const {
    Vec3f a{rate_at(slot, 0), rate_at(slot, 1), rate_at(slot, 2)};
    a += gravity;
    if (external) a += external[slot];
    return a;
  }
};

/// Gives the records of wall particles the pressure of their density.
struct EvolvedWallReset {
  const float* density;
  bool paper_form;
  float* record;
  GDESP_HD void operator()(Index s) const {
    float* r = record + record_offset(s / exec::cluster_size) + s % exec::cluster_size;
    const float D = density[s], A = tait_pressure(D);
    r[12] = paper_form ? 1.0f : 1.0f / (1.0f + D);
    r[28] = paper_form ? A / ((1.0f + D) * (1.0f + D)) : A;
  }
};

}  // namespace gdesp::sph
