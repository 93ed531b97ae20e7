// SPDX-License-Identifier: GPL-3.0-or-later
// Passes in which particles read what the nodes around them hold: the second half of each sum of the coupling
// (coupling.averaging). The four particles of a cluster one after the other, sixteen numbers at a time: lane 4 k + q has
// quantity q of the k-th of four nodes along x. Splines are products, so those along y and z weigh a row of four nodes at
// once and those along x come last.
#pragma once

#include "coupling/averaging_spline.hpp"
#include "coupling/coupling_slots.hpp"
#include "coupling/node_bricks.hpp"

namespace gdesp::coupling {

// Splines of the four particles of a cluster along one axis: lane 4 i + k is of particle i and its k-th node.
template <class Real>
struct AxisSplines {
  Real second;     // cell of the second node
  Real weight;     // B
  Real slope;      // dB/dx, 1/m
  Real distance2;  // (distance over spacing)^2

  // s: place from the first node of the tile, in spacings; k: 0, 1, 2, 3.
  GDESP_HD AxisSplines(const Real& s, const Real& k, float inverse_spacing) {
    using real::floor;
    second = floor(s);
    const Real distance = s - second + Real(1.0f) - k;
    weight = cubic_spline(distance);
    slope = cubic_spline_slope(distance) * Real(inverse_spacing);
    distance2 = distance * distance;
  }
  // The plane: one node along y.
  GDESP_HD explicit AxisSplines(const Real& k) {
    using real::select;
    second = slope = distance2 = Real(0.0f);
    weight = select(k < Real(0.5f), Real(1.0f), Real(0.0f));
  }
};

// The sums of one particle: sixteen lanes for each group, of the values and, of group 0, of the gradient.
template <class Real, int groups>
struct NodeSums {
  Real value[groups];
  Real gradient[3];
};

struct NodeReader {
  AveragingSpline spline;
  NodeBricksView bricks;
  const Vec3<std::int32_t>* cluster_tile;
  const float* record;

  // use(i, sums) for those of the four particles of a cluster that have nodes in reach, miss(i) for the others.
  template <int groups, bool gradient, class Lanes, class Use, class Miss>
  GDESP_HD void for_each(Index c, const Lanes& lanes, const Use& use, const Miss& miss) const {
    using Real = typename Lanes::Real;
    using real::min;
    const Vec3<std::int32_t> tile = cluster_tile[c];
    const Real k = lanes.number_of_j();
    const float* r = record + record_offset(c);
    // Padding is beyond all nodes however far away, and no whole number then overflows.
    const auto along = [&](int row, float inverse) {
      const Real s = min(lanes.load_i(r + row) * Real(inverse) - Real(0.5f), Real(1.0e6f));
      return AxisSplines<Real>(s, k, inverse);
    };
    const AxisSplines<Real> ax = along(0, spline.inverse_spacing.x),
                            ay = spline.plane ? AxisSplines<Real>(k) : along(4, spline.inverse_spacing.y),
                            az = along(8, spline.inverse_spacing.z);
    const auto second_x = lanes.exchange(ax.second), second_y = lanes.exchange(ay.second),
               second_z = lanes.exchange(az.second);
    const Splines<Lanes> x(lanes, ax), y(lanes, ay), z(lanes, az);
    for (int i = 0; i < exec::cluster_size; ++i) {
      const Vec3<std::int32_t> first{static_cast<std::int32_t>(second_x[4 * i]) - 1,
                                     static_cast<std::int32_t>(second_y[4 * i]) - (spline.plane ? 0 : 1),
                                     static_cast<std::int32_t>(second_z[4 * i]) - 1};
      const float* values = bricks.at(tile, first);
      if (values) {
        use(i, add_up<groups, gradient>(lanes, values, i, x, y, z));
      } else {
        miss(i);
      }
    }
  }

 private:
  template <class Lanes>
  struct Splines {
    typename Lanes::Exchange weight, slope, distance2;
    GDESP_HD Splines(const Lanes& lanes, const AxisSplines<typename Lanes::Real>& axis)
        : weight(lanes.exchange(axis.weight)), slope(lanes.exchange(axis.slope)),
          distance2(lanes.exchange(axis.distance2)) {}
  };

  template <int groups, bool gradient, class Lanes>
  GDESP_HD NodeSums<typename Lanes::Real, groups> add_up(const Lanes& lanes, const float* values, int i,
                                                         const Splines<Lanes>& x, const Splines<Lanes>& y,
                                                         const Splines<Lanes>& z) const {
    using Real = typename Lanes::Real;
    using real::select;
    const Real zero(0.0f);
    // By row of four nodes, lane 4 y + z.
    const Real wy = y.weight.spread(i), wz = z.weight.repeated(i);
    const auto within =
                   lanes.exchange(Real(spline_reach * spline_reach) - y.distance2.spread(i) - z.distance2.repeated(i)),
               weight = lanes.exchange(wy * wz), slope_y = lanes.exchange(gradient ? y.slope.spread(i) * wz : zero),
               slope_z = lanes.exchange(gradient ? wy * z.slope.repeated(i) : zero);
    const Real distance2 = x.distance2.spread(i);
    NodeSums<Real, groups> sums;
    for (int g = 0; g < groups; ++g) sums.value[g] = zero;
    for (int a = 0; a < 3; ++a) sums.gradient[a] = zero;
    const Index group = bricks.group_stride(), row_y = 4 * bricks.shape.nodes.x, row_z = row_y * bricks.shape.nodes.y;
    const int rows_y = spline.plane ? 1 : 4;
    for (int ky = 0; ky < rows_y; ++ky) {
      for (int kz = 0; kz < 4; ++kz) {
        const int row = 4 * ky + kz;
        const auto inside = distance2 < Real(within[row]);
        const float* q = values + ky * row_y + kz * row_z;
        for (int g = 0; g < groups; ++g) {
          const Real held = select(inside, lanes.load(q + g * group), zero);
          sums.value[g] += held * Real(weight[row]);
          if (gradient && g == 0) {
            sums.gradient[1] += held * Real(slope_y[row]);
            sums.gradient[2] += held * Real(slope_z[row]);
          }
        }
      }
    }
    const Real wx = x.weight.spread(i);
    if (gradient) {
      sums.gradient[0] = sums.value[0] * x.slope.spread(i);
      sums.gradient[1] = sums.gradient[1] * wx;
      sums.gradient[2] = sums.gradient[2] * wx;
    }
    for (int g = 0; g < groups; ++g) sums.value[g] = sums.value[g] * wx;
    return sums;
  }
};

// Where particle i of cluster c has its results, `stride` floats a slot.
GDESP_HD inline float* of_slot(float* first, Index stride, Index c, int i) {
  return first + static_cast<std::int64_t>(stride) * (exec::cluster_size * c + i);
}

// The four quantities of group 0 at each particle, by slot.
struct ReadNodes {
  NodeReader nodes;
  float* result;
  Index stride;  // floats a slot
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const auto at = [&](int i) { return of_slot(result, stride, c, i); };
    nodes.for_each<1, false>(
        c, lanes, [&](int i, const NodeSums<Real, 1>& sums) { lanes.store_sum_j(at(i), sums.value[0]); },
        [&](int i) { lanes.store_sum_j(at(i), Real(0.0f)); });
  }
};

// All that a grain asks of the water: two groups of values and the gradients of the first, by slot (GrainSum).
struct GatherAtGrains {
  NodeReader nodes;
  float* result;
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const auto at = [&](int i) { return of_slot(result, sums_of_grain, c, i); };
    nodes.for_each<2, true>(
        c, lanes,
        [&](int i, const NodeSums<Real, 2>& sums) {
          float* to = at(i);
          for (int g = 0; g < 2; ++g) lanes.store_sum_j(to + 4 * g, sums.value[g]);
          for (int a = 0; a < 3; ++a) lanes.store_sum_j(to + sum_gradient + 4 * a, sums.gradient[a]);
        },
        [&](int i) {
          for (int k = 0; k < sums_of_grain; k += 4) lanes.store_sum_j(at(i) + k, Real(0.0f));
        });
  }
};

// A lane's quantity out of four scalars.
template <class Lanes>
GDESP_HD inline typename Lanes::Real of_quantity(const Lanes& lanes, float q0, float q1, float q2, float q3) {
  using Real = typename Lanes::Real;
  using real::select;
  const Real q = lanes.number_of_j();
  return select(q < Real(1.5f), select(q < Real(0.5f), Real(q0), Real(q1)), select(q < Real(2.5f), Real(q2), Real(q3)));
}

// The mixture pressure, in the place of the pressure, for the water's own momentum.
struct MixturePressure {
  NodeReader nodes;
  Vec3f rho_g;
  float inverse_stiffness;
  const float* water;
  const float* porosity;
  const float* density;  // of the form of the paper: the row is over its ratio squared; null else
  float* fluid;
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    nodes.for_each<1, false>(
        c, lanes,
        [&](int i, const NodeSums<Real, 1>& sums) {
          float* record = fluid + record_offset(c) + i;
          const Index s = exec::cluster_size * c + i;
          const float head = dot(rho_g, vector_at(record));
          const float of_grains = lanes.sum(sums.value[0] * of_quantity(lanes, head, 1.0f, 0.0f, 0.0f));
          const float ratio = density ? 1.0f + density[s] : 1.0f;
          const float own = porosity[s] * water[water_rows * static_cast<std::int64_t>(c) + i + water_pressure];
          if (lanes.leader()) record[28] = (own + of_grains) * inverse_stiffness / (ratio * ratio);
        },
        [](int) {});
  }
};

// What the grains took: a group for each axis, over mass and volume of the water.
struct ReactionOnFluid {
  NodeReader nodes;
  Vec3f rho_g;
  const float* water;
  float* reaction;
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const auto at = [&](int i) { return of_slot(reaction, 4, c, i); };
    nodes.for_each<3, false>(
        c, lanes,
        [&](int i, const NodeSums<Real, 3>& sums) {
          const float* r = nodes.record + record_offset(c) + i;
          const float* w = water + water_rows * static_cast<std::int64_t>(c) + i;
          const float head = dot(rho_g, vector_at(r));
          const Real of = of_quantity(lanes, 1.0f, w[water_pressure] - head, -w[water_boost], 0.0f);
          float f[3];
          for (int a = 0; a < 3; ++a) f[a] = lanes.sum(sums.value[a] * of);
          if (lanes.leader()) {
            for (int a = 0; a < 3; ++a) at(i)[a] = f[a];
          }
        },
        [&](int i) { lanes.store_sum_j(at(i), Real(0.0f)); });
  }
};

}  // namespace gdesp::coupling
