// SPDX-License-Identifier: GPL-3.0-or-later
// The loops over pairs of the coupling: nodes add up what grains, water and walls bring; grains and water read what nodes
// hold. Each pass is one half of a sum sum_n S_n(r_i) sum_a S_n(r_a) q_a/V_n (coupling.averaging), r: from the j of the
// list to its i, so from a particle to the node where nodes add up.
#pragma once

#include "coupling/averaging_spline.hpp"
#include "coupling/coupling_slots.hpp"

namespace gdesp::coupling {

// Rows of the nodes' sums (four floats each).
constexpr Index node_rows = 64;
enum NodeRow {
  node_water = 0,      // sum_a V_a S/V
  node_boosted = 4,    // sum_a u_a S/V
  node_pressure = 8,   // sum_a V_a (P_a - rho g.(r_a - r_n)) S/V
  node_velocity = 12,  // sum_a u_a v_a S/V
  node_drag = 12,      // after the gather: sum_i (D_i/N_i) S/V
  node_wall = 24,      // sum_w V_w S/V
  node_solid = 28,     // sum_i V_i (w/n) S/V, then sum_i V_i w S/V
  node_slope = 32,     // sum_i slope_i S/V
  node_offset = 36,    // sum_i (slope_i rho g.(r_n - r_i) - offset_i) S/V
  node_pull = 40,      // sum_i (offset_i + slope_i rho g.(r_i - r_n)) grad S/V + (slope_i rho g - force_i) S/V
  node_slope_gradient = 52
};

// Four places of a cluster, and those of one of the other kind against them.
template <class Real>
struct Place {
  Real x, y, z;
};
template <class Lanes>
GDESP_HD inline Place<typename Lanes::Real> place_i(const Lanes& lanes, const float* r) {
  return {lanes.load_i(r + row_x), lanes.load_i(r + row_y), lanes.load_i(r + row_z)};
}
template <class Lanes>
GDESP_HD inline Place<typename Lanes::Real> separation(const Lanes& lanes, const Place<typename Lanes::Real>& i,
                                                       const float* rj, const Vec3f& shift) {
  using Real = typename Lanes::Real;
  return {i.x + Real(shift.x) - lanes.load_j(rj + row_x), i.y + Real(shift.y) - lanes.load_j(rj + row_y),
          i.z + Real(shift.z) - lanes.load_j(rj + row_z)};
}
template <class Real>
GDESP_HD inline Real dot(const Vec3f& a, const Place<Real>& r) {
  return Real(a.x) * r.x + Real(a.y) * r.y + Real(a.z) * r.z;
}

// Pairs of a pass: the records of i and of j, and who is near whom.
struct NodePairs {
  AveragingSpline spline;
  ClusterListView list;
  const float* of_i;
  const float* of_j;

  // visit(j, r): for each cluster in reach.
  template <class Lanes, class Visit>
  GDESP_HD void for_each(Index c, const Lanes& lanes, const Visit& visit) const {
    const auto i = place_i(lanes, of_i + record_offset(c));
    for_each_cluster(
        list, c, [&](Index j, const Vec3f& shift) { visit(j, separation(lanes, i, of_j + record_offset(j), shift)); });
  }
};

// Where the four of something stand in rows by cluster.
template <class Float>
GDESP_HD inline Float* rows_of(Float* first, Index rows, Index c) {
  return first + static_cast<std::int64_t>(rows) * c;
}

// One quantity of j, a row of `source`, into a row of the nodes; `factor` comes to 1/V.
struct AddAtNodes {
  NodePairs pairs;
  const float* source;  // null: 1
  Index source_rows;
  float factor;
  float* row;  // of node_rows
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    Real sum(0.0f);
    pairs.for_each(c, lanes, [&](Index j, const Place<Real>& r) {
      const Real S = pairs.spline.weight(r.x, r.y, r.z);
      sum += source ? S * lanes.load_j(rows_of(source, source_rows, j)) : S;
    });
    lanes.store_sum_i(rows_of(row, node_rows, c), sum * Real(factor * pairs.spline.inverse_volume));
  }
};

// One row of the nodes at i, over `factor` (a row of i, or null).
struct ReadAtPlaces {
  NodePairs pairs;
  const float* row;
  const float* factor;
  Index factor_rows;
  float* result;
  Index result_rows;
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    Real sum(0.0f);
    pairs.for_each(c, lanes, [&](Index j, const Place<Real>& r) {
      sum += pairs.spline.weight(r.x, r.y, r.z) * lanes.load_j(rows_of(row, node_rows, j));
    });
    lanes.store_sum_i(rows_of(result, result_rows, c),
                      factor ? sum * lanes.load_i(rows_of(factor, factor_rows, c)) : sum);
  }
};

// All that grains ask of the water, at the nodes.
struct WaterAtNodes {
  NodePairs pairs;
  Vec3f rho_g;
  const float* water;
  float* nodes;
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const Real zero(0.0f), inverse_volume(pairs.spline.inverse_volume);
    Real water_sum = zero, boosted = zero, pressure = zero, velocity[3] = {zero, zero, zero};
    pairs.for_each(c, lanes, [&](Index j, const Place<Real>& r) {
      const float* rj = pairs.of_j + record_offset(j);
      const float* wj = rows_of(water, water_rows, j);
      const Real VS = lanes.load_j(wj) * pairs.spline.weight(r.x, r.y, r.z), uS = VS * lanes.load_j(wj + water_boost);
      water_sum += VS;
      boosted += uS;
      pressure += VS * (lanes.load_j(wj + 4) + dot(rho_g, r));  // r: from the water to the node
      for (int k = 0; k < 3; ++k) velocity[k] += uS * lanes.load_j(rj + 16 + 4 * k);
    });
    float* out = rows_of(nodes, node_rows, c);
    lanes.store_sum_i(out + node_water, water_sum * inverse_volume);
    lanes.store_sum_i(out + node_boosted, boosted * inverse_volume);
    lanes.store_sum_i(out + node_pressure, pressure * inverse_volume);
    for (int k = 0; k < 3; ++k) lanes.store_sum_i(out + node_velocity + 4 * k, velocity[k] * inverse_volume);
  }
};

// Sums over the water at a grain.
struct GatherAtGrains {
  NodePairs pairs;
  Vec3f rho_g;
  const float* nodes;
  float* sums;
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const Real zero(0.0f);
    Real water = zero, boosted = zero, pressure = zero, solid = zero, velocity[3] = {zero, zero, zero};
    Real water_gradient[3] = {zero, zero, zero}, pressure_gradient[3] = {zero, zero, zero};
    Real wall = zero, wall_gradient[3] = {zero, zero, zero};
    pairs.for_each(c, lanes, [&](Index j, const Place<Real>& r) {
      AveragingSpline::Gradient<Real> gradient;
      const Real S = pairs.spline.weight(r.x, r.y, r.z, gradient);
      const float* n = rows_of(nodes, node_rows, j);
      const Real U = lanes.load_j(n + node_water), P = lanes.load_j(n + node_pressure) + U * dot(rho_g, r);
      const Real walls = lanes.load_j(n + node_wall);
      water += S * U;
      wall += S * walls;
      boosted += S * lanes.load_j(n + node_boosted);
      solid += S * lanes.load_j(n + node_solid);
      pressure += S * P;
      const Real d[3] = {gradient.x, gradient.y, gradient.z};
      for (int k = 0; k < 3; ++k) {
        velocity[k] += S * lanes.load_j(n + node_velocity + 4 * k);
        water_gradient[k] += d[k] * U;
        pressure_gradient[k] += d[k] * P;
        wall_gradient[k] += d[k] * walls;
      }
    });
    float* out = rows_of(sums, sum_rows, c);
    lanes.store_sum_i(out + sum_water, water);
    lanes.store_sum_i(out + sum_boosted, boosted);
    lanes.store_sum_i(out + sum_solid, solid);
    lanes.store_sum_i(out + sum_pressure, pressure);
    lanes.store_sum_i(out + sum_wall, wall);
    for (int k = 0; k < 3; ++k) {
      lanes.store_sum_i(out + sum_velocity + 4 * k, velocity[k]);
      lanes.store_sum_i(out + sum_water_gradient + 4 * k, water_gradient[k]);
      lanes.store_sum_i(out + sum_pressure_gradient + 4 * k, pressure_gradient[k]);
      lanes.store_sum_i(out + sum_wall_gradient + 4 * k, wall_gradient[k]);
    }
  }
};

// What the grains add to the mixture pressure, at the nodes.
struct MixtureAtNodes {
  NodePairs pairs;
  Vec3f rho_g;
  float* nodes;
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const Real inverse_volume(pairs.spline.inverse_volume);
    Real slope(0.0f), offset(0.0f);
    pairs.for_each(c, lanes, [&](Index j, const Place<Real>& r) {
      const float* rj = pairs.of_j + record_offset(j);
      const Real S = pairs.spline.weight(r.x, r.y, r.z), of_grain = lanes.load_j(rj + row_volume);
      slope += S * of_grain;
      offset += S * (of_grain * dot(rho_g, r) - lanes.load_j(rj + row_offset));  // r: from the grain to the node
    });
    float* out = rows_of(nodes, node_rows, c);
    lanes.store_sum_i(out + node_slope, slope * inverse_volume);
    lanes.store_sum_i(out + node_offset, offset * inverse_volume);
  }
};

// The mixture pressure, in the place of the pressure, for the water's own momentum.
struct MixturePressure {
  NodePairs pairs;
  Vec3f rho_g;
  float inverse_stiffness;
  const float* nodes;
  const float* water;
  const float* porosity;
  const float* density;  // of the form of the paper: the row is over its ratio squared; null else
  float* fluid;
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const float* w = rows_of(water, water_rows, c);
    Real of_grains(0.0f);
    bool any = false;
    pairs.for_each(c, lanes, [&](Index j, const Place<Real>& r) {
      const float* n = rows_of(nodes, node_rows, j);
      of_grains += pairs.spline.weight(r.x, r.y, r.z) *
                   (lanes.load_j(n + node_offset) + lanes.load_j(n + node_slope) * dot(rho_g, r));
      any = true;
    });
    if (!any) return;
    // A quarter in each of the four lanes that are added up.
    const Real own = lanes.load_i(porosity + 4 * static_cast<std::int64_t>(c)) * lanes.load_i(w + 4) * Real(0.25f);
    Real scale(inverse_stiffness);
    if (density) {
      const Real ratio = Real(1.0f) + lanes.load_i(density + 4 * static_cast<std::int64_t>(c));
      scale = scale / (ratio * ratio);
    }
    lanes.store_sum_i(fluid + record_offset(c) + 28, (own + of_grains) * scale);
  }
};

// What the grains took, at the nodes.
struct ReactionAtNodes {
  NodePairs pairs;
  Vec3f rho_g;
  float* nodes;
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const Real zero(0.0f), inverse_volume(pairs.spline.inverse_volume);
    const float g[3] = {rho_g.x, rho_g.y, rho_g.z};
    Real pull[3] = {zero, zero, zero}, slope_gradient[3] = {zero, zero, zero}, drag[3] = {zero, zero, zero};
    pairs.for_each(c, lanes, [&](Index j, const Place<Real>& r) {
      const float* rj = pairs.of_j + record_offset(j);
      // At the grain, which is at -r from the node.
      AveragingSpline::Gradient<Real> gradient;
      const Real S = pairs.spline.weight(-r.x, -r.y, -r.z, gradient);
      const Real slope = lanes.load_j(rj + row_volume), push = lanes.load_j(rj + row_offset) - slope * dot(rho_g, r);
      const Real d[3] = {gradient.x, gradient.y, gradient.z};
      for (int k = 0; k < 3; ++k) {
        pull[k] += push * d[k] + S * slope * Real(g[k]);
        drag[k] += S * lanes.load_j(rj + row_force + 4 * k);
        slope_gradient[k] += slope * d[k];
      }
    });
    float* out = rows_of(nodes, node_rows, c);
    for (int k = 0; k < 3; ++k) {
      lanes.store_sum_i(out + node_pull + 4 * k, pull[k] * inverse_volume);
      lanes.store_sum_i(out + node_slope_gradient + 4 * k, slope_gradient[k] * inverse_volume);
      lanes.store_sum_i(out + node_drag + 4 * k, drag[k] * inverse_volume);
    }
  }
};

struct ReactionOnFluid {
  NodePairs pairs;
  Vec3f rho_g;
  float inverse_mass;  // 1 / (rho0 V0)
  const float* nodes;
  const float* water;
  const float* mass_share;
  float* reaction;
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const float* w = rows_of(water, water_rows, c);
    const Real P = lanes.load_i(w + 4), boost = lanes.load_i(w + water_boost);
    Real f[3] = {Real(0.0f), Real(0.0f), Real(0.0f)};
    pairs.for_each(c, lanes, [&](Index j, const Place<Real>& r) {  // r: from the node to the water
      const float* n = rows_of(nodes, node_rows, j);
      const Real S = pairs.spline.weight(r.x, r.y, r.z), p = P - dot(rho_g, r);
      for (int k = 0; k < 3; ++k) {
        f[k] += S * (lanes.load_j(n + node_pull + 4 * k) + p * lanes.load_j(n + node_slope_gradient + 4 * k) -
                     boost * lanes.load_j(n + node_drag + 4 * k));
      }
    });
    const Real scale =
        Real(inverse_mass) * lanes.load_i(w) / lanes.load_i(mass_share + 4 * static_cast<std::int64_t>(c));
    for (int k = 0; k < 3; ++k) lanes.store_sum_i(rows_of(reaction, 12, c) + 4 * k, f[k] * scale);
  }
};

}  // namespace gdesp::coupling
