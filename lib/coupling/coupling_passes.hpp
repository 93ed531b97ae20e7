// SPDX-License-Identifier: GPL-3.0-or-later
// The loops over pairs in which nodes add up what grains, water and walls bring: the first half of each sum
// sum_n S_n(r_i) sum_a S_n(r_a) q_a/V_n (coupling.averaging); the second is in node_reading.hpp. r: from a particle to the node.
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
  node_solid = 28,     // sum_i V_i w S/V
  node_deposit = 32,   // sum_i V_i (w/n) S/V, for the porosity of the water
  node_slope = 32,     // then: sum_i slope_i S/V
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

// Volumes of j, a row of `source`, into a row of the nodes; `factor` comes to 1/V.
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

// What the grains take of the water's room, and their own volume (Deposit).
struct SolidAtNodes {
  NodePairs pairs;
  float* nodes;
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const Real inverse_volume(pairs.spline.inverse_volume);
    Real deposit(0.0f), solid(0.0f);
    pairs.for_each(c, lanes, [&](Index j, const Place<Real>& r) {
      const float* rj = pairs.of_j + record_offset(j);
      const Real S = pairs.spline.weight(r.x, r.y, r.z);
      deposit += S * lanes.load_j(rj + row_volume);
      solid += S * lanes.load_j(rj + row_offset);
    });
    float* out = rows_of(nodes, node_rows, c);
    lanes.store_sum_i(out + node_deposit, deposit * inverse_volume);
    lanes.store_sum_i(out + node_solid, solid * inverse_volume);
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

// What bricks take from a node at r (m, from the origin of their tile): pressures as they would be there, in water at rest.
struct RoomOfNodes {
  static constexpr Index groups = 1;
  GDESP_HD void operator()(const float* n, const Vec3f&, float* out) const {
    out[sum_water] = n[node_water];
    out[sum_wall] = n[node_wall];
    out[sum_solid] = n[node_deposit];
  }
};
struct WaterOfNodes {
  static constexpr Index groups = 2;
  Vec3f rho_g;
  GDESP_HD void operator()(const float* n, const Vec3f& r, float* out) const {
    out[sum_water] = n[node_water];
    out[sum_pressure] = n[node_pressure] - n[node_water] * dot(rho_g, r);
    out[sum_wall] = n[node_wall];
    out[sum_solid] = n[node_solid];
    out[sum_boosted] = n[node_boosted];
    for (int k = 0; k < 3; ++k) out[sum_velocity + k] = n[node_velocity + 4 * k];
  }
};
struct MixtureOfNodes {
  static constexpr Index groups = 1;
  Vec3f rho_g;
  GDESP_HD void operator()(const float* n, const Vec3f& r, float* out) const {
    out[0] = n[node_slope];
    out[1] = n[node_offset] - n[node_slope] * dot(rho_g, r);
  }
};
struct ReactionOfNodes {
  static constexpr Index groups = 3;
  Vec3f rho_g;
  GDESP_HD void operator()(const float* n, const Vec3f& r, float* out) const {
    const float head = dot(rho_g, r);
    for (int k = 0; k < 3; ++k) {
      const float slope = n[node_slope_gradient + 4 * k];
      out[4 * k] = n[node_pull + 4 * k] + slope * head;
      out[4 * k + 1] = slope;
      out[4 * k + 2] = n[node_drag + 4 * k];
    }
  }
};

}  // namespace gdesp::coupling
