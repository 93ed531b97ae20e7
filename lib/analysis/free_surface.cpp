// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/free_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/smoothing.hpp"

namespace gdesp::analysis {
namespace {

constexpr double samples_per_dp = 4.0;  // of f along the vertical
constexpr double emptiness = 0.05;      // f below which a layer has ended
constexpr double window_in_h = 5.0;     // depth below the topmost particle that is looked at: > 4h is deep
constexpr double smallest_layer = 0.5;  // dp of water that still is a layer

double power(double base, int exponent) { return exponent == 2 ? base * base : base * base * base; }

}  // namespace

// The particles around one vertical line, within one window of height.
struct FluidSampler::Column {
  struct Near {
    double z, r2, volume;
  };
  double h = 0.0, factor = 0.0;
  std::vector<Near> near;  // by increasing z

  double fraction(double z) const {
    const double reach = 2.0 * h, inverse = 1.0 / (h * h);
    auto first =
        std::lower_bound(near.begin(), near.end(), z - reach, [](const Near& a, double value) { return a.z < value; });
    double sum = 0.0;
    for (; first != near.end() && first->z < z + reach; ++first) {
      const double dz = z - first->z;
      sum += first->volume * wendland_shape((first->r2 + dz * dz) * inverse);
    }
    return factor * sum;
  }
};

FluidSampler::FluidSampler(std::span<const Vec3d> position, std::span<const float> porosity, double dp, int dimensions)
    : dp_(dp), h_(smoothing_ratio * dp), volume_(power(dp, dimensions)),
      factor_(wendland_normalisation(h_, dimensions)), grid_(position, 2.0 * h_, dimensions) {
  if (porosity.size() != position.size()) return;
  weight_.resize(position.size());
  for (std::size_t s = 0; s < weight_.size(); ++s) {
    weight_[s] = static_cast<float>(volume_ / std::clamp(porosity[grid_.index(s)], 0.2f, 1.0f));
  }
}

double FluidSampler::fluid_fraction(const Vec3d& x) const {
  const double inverse = 1.0 / (h_ * h_);
  double sum = 0.0;
  grid_.for_each(x.x, x.y, x.z - 2.0 * h_, x.z + 2.0 * h_, [&](std::size_t s, double r2) {
    const double dz = x.z - grid_.position(s).z;
    sum += volume(s) * wendland_shape((r2 + dz * dz) * inverse);
  });
  return factor_ * sum;
}

std::optional<double> FluidSampler::surface_level(double x, double y) const {
  const double reach = 2.0 * h_, dz = dp_ / samples_per_dp;
  const LayerResponse& response = layer_response(dimensions());
  thread_local Column column;
  column.h = h_;
  column.factor = factor_;
  double top = grid_.highest_below(x, y, reach, std::numeric_limits<double>::infinity());
  while (std::isfinite(top)) {
    const double bottom = top - window_in_h * h_;
    column.near.clear();
    grid_.for_each(x, y, bottom - reach, top, [&](std::size_t s, double r2) {
      if (r2 < reach * reach) column.near.push_back({grid_.position(s).z, r2, volume(s)});
    });
    std::sort(column.near.begin(), column.near.end(), [](const auto& a, const auto& b) { return a.z < b.z; });

    double largest = 0.0, content = 0.0, z = top + reach, layer_top = top + reach;
    bool inside = false, ended = false;
    for (; z > bottom && !ended; z -= dz) {
      const double f = column.fraction(z);
      if (f > emptiness && !inside) layer_top = z + dz;
      inside = inside || f > emptiness;
      ended = inside && f <= emptiness;
      largest = std::max(largest, f);
      content += f * dz;
    }
    if (content >= smallest_layer * dp_ && largest > 2.0 * emptiness) {
      double thickness = ended ? response.thickness_from_ratio(content / (largest * h_)) : 4.0;
      double share = ended && thickness > 0.0 ? content / (thickness * h_) : largest;
      if (ended && (thickness <= 0.0 || share > 1.0)) {
        share = 1.0;
        thickness = content / h_;
      }
      const double threshold = std::min(share * response.edge(thickness), 0.95 * largest);
      double high = layer_top, low = layer_top;
      while (column.fraction(low) < threshold && low > bottom) high = low, low -= dz;
      for (int k = 0; k < 20; ++k) {
        const double middle = 0.5 * (low + high);
        (column.fraction(middle) < threshold ? high : low) = middle;
      }
      return 0.5 * (low + high);
    }
    top = grid_.highest_below(x, y, reach, ended ? std::min(z, top - dz) : top - dz);
  }
  return std::nullopt;
}

std::optional<double> FluidSampler::sample(const Vec3d& x, std::span<const float> value,
                                           double vertical_gradient) const {
  const double inverse = 1.0 / (h_ * h_);
  double sum = 0.0, weighted = 0.0;
  grid_.for_each(x.x, x.y, x.z - 2.0 * h_, x.z + 2.0 * h_, [&](std::size_t s, double r2) {
    const double dz = x.z - grid_.position(s).z;
    const double w = volume(s) * wendland_shape((r2 + dz * dz) * inverse);
    sum += w;
    weighted += w * (value[grid_.index(s)] + vertical_gradient * dz);
  });
  if (factor_ * sum < emptiness) return std::nullopt;
  return weighted / sum;
}

void fill_surface_levels(const FluidSampler& sampler, Raster& raster) {
  const std::size_t count = static_cast<std::size_t>(raster.nx) * raster.ny;
  raster.value.assign(count, std::numeric_limits<float>::quiet_NaN());
#pragma omp parallel for schedule(dynamic, 64)
  for (std::size_t k = 0; k < count; ++k) {
    const int ix = static_cast<int>(k % raster.nx), iy = static_cast<int>(k / raster.nx);
    if (const auto level = sampler.surface_level(raster.x(ix), raster.y(iy))) {
      raster.value[k] = static_cast<float>(*level);
    }
  }
}

Raster make_raster(const Vec3d& lower, const Vec3d& upper, double dx, int dimensions) {
  Raster raster;
  raster.x0 = lower.x;
  raster.y0 = dimensions == 2 ? 0.0 : lower.y;
  raster.dx = dx;
  raster.nx = std::max(1, static_cast<int>(std::floor((upper.x - lower.x) / dx + 1.0 + 1e-9)));
  raster.ny = dimensions == 2 ? 1 : std::max(1, static_cast<int>(std::floor((upper.y - lower.y) / dx + 1.0 + 1e-9)));
  raster.value.assign(static_cast<std::size_t>(raster.nx) * raster.ny, std::numeric_limits<float>::quiet_NaN());
  return raster;
}

}  // namespace gdesp::analysis
