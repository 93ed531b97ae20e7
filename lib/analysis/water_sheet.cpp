// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/water_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/wall_surface.hpp"

namespace gdesp::analysis {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();
constexpr double margin = 3.0;  // dp past the last particles

std::vector<float> speeds_of_main(FrameView& view) {
  const FluidTable& fluid = view.frame().fluid;
  std::vector<float> speed;
  if (fluid.velocity.size() != fluid.position.size()) return speed;
  const auto& main = view.connected().main;
  for (std::size_t i = 0; i < main.size(); ++i) {
    if (main[i]) speed.push_back(norm(fluid.velocity[i]));
  }
  return speed;
}

// Speed at every wet cell, half a spacing below the surface.
std::vector<float> speeds_at(FrameView& view, const Raster& level) {
  const std::vector<float> particle = speeds_of_main(view);
  std::vector<float> speed(level.value.size(), none);
  if (particle.empty()) return speed;
  const FluidSampler& water = view.water();
#pragma omp parallel for schedule(dynamic, 64)
  for (std::size_t k = 0; k < speed.size(); ++k) {
    if (!std::isfinite(level.value[k])) continue;
    const int ix = static_cast<int>(k % level.nx), iy = static_cast<int>(k / level.nx);
    const Vec3d at{level.x(ix), level.y(iy), level.value[k] - 0.5 * view.info().dp};
    speed[k] = static_cast<float>(water.sample(at, particle).value_or(0.0));
  }
  return speed;
}

// Ground at every cell.
std::vector<float> ground_at(const RunInfo& info, const Raster& shape) {
  const WallSurface walls(info.walls);
  std::vector<float> ground(shape.value.size(), none);
#pragma omp parallel for schedule(dynamic, 256)
  for (std::size_t k = 0; k < ground.size(); ++k) {
    const auto z = walls.height(shape.x(static_cast<int>(k % shape.nx)), shape.y(static_cast<int>(k / shape.nx)));
    if (z) ground[k] = static_cast<float>(*z);
  }
  return ground;
}

// Past the particles the sheet goes on under rising ground, and over the lake's own shallows while the water stands about as
// high as at rest: not over a dam's crest, nor where the water has drawn back from the slide.
bool is_shore(const RunInfo& info, float level, float ground) {
  if (!std::isfinite(level) || !std::isfinite(ground)) return false;
  const double depth = level - ground;
  if (depth <= 0.0 || !info.still_water_level) return depth <= 0.5 * info.dp;
  return ground <= *info.still_water_level && level >= *info.still_water_level - 0.5 * info.dp &&
         depth <= 1.2 * info.dp;
}

// One ring of cells outwards: dry cells beside cells of `from` take the mean of those.
void extend(const Raster& shape, const std::vector<std::uint8_t>& from, std::vector<float>& value) {
  const std::vector<float> before = value;
  for (int iy = 0; iy < shape.ny; ++iy) {
    for (int ix = 0; ix < shape.nx; ++ix) {
      const std::size_t k = static_cast<std::size_t>(iy) * shape.nx + ix;
      if (std::isfinite(before[k])) continue;
      double sum = 0.0;
      int count = 0;
      for (int jy = std::max(iy - 1, 0); jy <= std::min(iy + 1, shape.ny - 1); ++jy) {
        for (int jx = std::max(ix - 1, 0); jx <= std::min(ix + 1, shape.nx - 1); ++jx) {
          const std::size_t j = static_cast<std::size_t>(jy) * shape.nx + jx;
          if (from[j] && std::isfinite(before[j])) sum += before[j], ++count;
        }
      }
      if (count > 0) value[k] = static_cast<float>(sum / count);
    }
  }
}

}  // namespace

WaterSheet make_water_sheet(FrameView& view, double cell) {
  WaterSheet sheet;
  if (view.connected().main_count == 0) return sheet;
  const double edge = margin * view.info().dp + cell;
  const ColumnGrid& grid = view.water().grid();
  Raster level = make_raster(grid.lower() - Vec3d{edge, edge, 0}, grid.upper() + Vec3d{edge, edge, 0}, cell, 3);
  fill_surface_levels(view.water(), level);
  std::vector<float> speed = speeds_at(view, level);
  const std::vector<float> measured = level.value, ground = ground_at(view.info(), level);
  const int rings = static_cast<int>(std::ceil(margin * view.info().dp / cell));
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<std::uint8_t> from(
        ground.size());  // what lies under the ground leads no further: a dam has another side
    for (std::size_t k = 0; k < from.size(); ++k) from[k] = std::isfinite(measured[k]) || !(ground[k] > level.value[k]);
    extend(level, from, speed);
    extend(level, from, level.value);
  }
  const bool moving = view.frame().fluid.velocity.size() == view.frame().fluid.position.size();
  std::vector<std::int32_t> number(level.value.size(), -1);
  for (std::size_t k = 0; k < number.size(); ++k) {
    if (!std::isfinite(measured[k]) && !is_shore(view.info(), level.value[k], ground[k])) continue;
    number[k] = static_cast<std::int32_t>(sheet.vertex.size());
    sheet.vertex.push_back(
        {level.x(static_cast<int>(k % level.nx)), level.y(static_cast<int>(k / level.nx)), level.value[k]});
    if (moving) sheet.speed.push_back(std::isfinite(speed[k]) ? speed[k] : 0.0f);
  }
  for (int iy = 0; iy + 1 < level.ny; ++iy) {
    for (int ix = 0; ix + 1 < level.nx; ++ix) {
      const std::size_t k = static_cast<std::size_t>(iy) * level.nx + ix;
      const std::int32_t a = number[k], b = number[k + 1], c = number[k + level.nx + 1], d = number[k + level.nx];
      if (a >= 0 && b >= 0 && c >= 0) sheet.triangle.push_back({a, b, c});
      if (a >= 0 && c >= 0 && d >= 0) sheet.triangle.push_back({a, c, d});
    }
  }
  return sheet;
}

}  // namespace gdesp::analysis
