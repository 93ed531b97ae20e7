// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/map_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "analysis/wall_surface.hpp"
#include "core/error.hpp"

namespace gdesp::analysis {

namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t most_cells = 100u << 20;

// Lines around the cells that have a value; those of single cells (spray) are left out.
auto edge_of(Raster raster) {
  for (float& v : raster.value) v = std::isfinite(v) ? 1.0f : 0.0f;
  auto lines = contour_lines(raster, 0.5);
  std::erase_if(lines, [](const auto& line) { return line.size() < 8; });
  return lines;
}

Raster empty_like(const Raster& r) {
  Raster copy = r;
  std::fill(copy.value.begin(), copy.value.end(), none);
  return copy;
}

}  // namespace

std::vector<std::string> MapMeasurement::begin(const RunInfo& info) {
  info_ = info;
  if (info.dimensions == 2)
    throw Error(ErrorKind::input, info.name + ": a map needs a run in three dimensions; see profile");
  const double cell = options_.cell > 0.0 ? options_.cell : info.dp;
  threshold_ = options_.threshold > 0.0 ? options_.threshold : 0.5 * info.dp;
  const Vec3d size = info.domain.upper - info.domain.lower;
  if (size.x / cell * (size.y / cell) > static_cast<double>(most_cells)) {
    throw Error(ErrorKind::usage,
                "--cell " + format_number(cell) + ": makes more than 100 million cells; take a larger one");
  }
  // Cell centres on multiples of the cell in the scene's own coordinates, so that maps of several runs lie on top of each other.
  const auto snap = [&](double value, double offset) {
    return std::floor((value + offset) / cell) * cell + 0.5 * cell - offset;
  };
  const Vec3d lower{snap(info.domain.lower.x, info.offset.x), snap(info.domain.lower.y, info.offset.y), 0.0};
  ground_ = make_raster(lower, info.domain.upper, cell, 3);
  const WallSurface walls(info.walls);
  info_.walls = {};
#pragma omp parallel for schedule(dynamic, 256)
  for (std::size_t k = 0; k < ground_.value.size(); ++k) {
    const auto z =
        walls.height(ground_.x(static_cast<int>(k % ground_.nx)), ground_.y(static_cast<int>(k / ground_.nx)));
    if (z) ground_.value[k] = static_cast<float>(*z);
  }
  first_ = level_ = depth_ = arrival_ = last_departure_ = empty_like(ground_);
  return {"map", "unit", "lowest", "highest", "cells", "area[m2]"};
}

void MapMeasurement::add(FrameView& view, const RowSink&) {
  if (view.frame().fluid.position.empty()) return;
  Raster now = empty_like(ground_);
  fill_surface_levels(view.water(), now);
  const double t = view.time();
#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < now.value.size(); ++k) {
    const float z = now.value[k], bed = ground_.value[k];
    const float depth = std::isfinite(bed) ? z - bed : none;
    if (!std::isfinite(z) || (std::isfinite(bed) && depth < threshold_)) continue;
    if (!any_) first_.value[k] = z;
    if (!(level_.value[k] >= z)) level_.value[k] = z;
    if (std::isfinite(depth) && !(depth_.value[k] >= depth)) depth_.value[k] = depth;
    if (!any_ || std::isfinite(arrival_.value[k])) continue;
    const float start = first_.value[k];
    const double departure = std::isfinite(start) ? std::abs(z - start) : threshold_;
    const double before = std::isfinite(last_departure_.value[k]) ? last_departure_.value[k] : 0.0;
    if (!std::isfinite(start))
      arrival_.value[k] = static_cast<float>(t);
    else if (departure > threshold_)
      arrival_.value[k] =
          static_cast<float>(last_time_ + (threshold_ - before) / (departure - before) * (t - last_time_));
    last_departure_.value[k] = static_cast<float>(departure);
  }
  any_ = true;
  last_time_ = t;
}

void MapMeasurement::finish(const RowSink& emit) {
  const auto row = [&](const char* name, const char* unit, const Raster& r, double up) {
    double low = 1e300, high = -1e300;
    std::size_t count = 0;
    for (const float v : r.value) {
      if (!std::isfinite(v)) continue;
      low = std::min(low, static_cast<double>(v));
      high = std::max(high, static_cast<double>(v));
      ++count;
    }
    const double missing = std::numeric_limits<double>::quiet_NaN();
    emit({std::string(name), std::string(unit), count ? low + up : missing, count ? high + up : missing,
          static_cast<double>(count), static_cast<double>(count) * r.dx * r.dx});
  };
  row("level_max", "m", level_, info_.offset.z);
  row("depth_max", "m", depth_, 0.0);
  row("arrival", "s", arrival_, 0.0);
}

std::vector<GroundLine> MapMeasurement::run_up_lines() const {
  std::vector<GroundLine> lines;
  for (const auto& line : edge_of(level_)) {
    GroundLine on_ground;
    for (const Point2& p : line) {
      const int ix = std::clamp(static_cast<int>(std::lround((p.x - ground_.x0) / ground_.dx)), 0, ground_.nx - 1);
      const int iy = std::clamp(static_cast<int>(std::lround((p.y - ground_.y0) / ground_.dx)), 0, ground_.ny - 1);
      on_ground.push_back({p.x, p.y, ground_.at(ix, iy)});
    }
    lines.push_back(std::move(on_ground));
  }
  return lines;
}

// About twenty round elevations (of the scene) over the ground's range; case coordinates.
std::vector<double> MapMeasurement::contour_levels() const {
  double low = 1e300, high = -1e300;
  for (const float z : ground_.value) {
    if (std::isfinite(z)) low = std::min<double>(low, z), high = std::max<double>(high, z);
  }
  std::vector<double> levels;
  if (!(high > low)) return levels;
  const double unit = std::pow(10.0, std::floor(std::log10((high - low) / 20.0)));
  double step = unit;
  for (const double m : {2.0, 5.0, 10.0}) {
    if (step < (high - low) / 20.0) step = m * unit;
  }
  const double up = info_.offset.z, first = std::ceil((low + up) / step);
  const int most =
      static_cast<int>((high - low) / step) + 1;  // (a range below the rounding of `up` would never be left by steps)
  for (int k = 0; k < most && (first + k) * step < high + up; ++k) levels.push_back((first + k) * step - up);
  return levels;
}

Figure MapMeasurement::figure() const {
  Figure figure;
  figure.panel_height_mm = 95.0;
  const double missing = std::numeric_limits<double>::quiet_NaN();
  Series ground, outline;  // all lines of a kind in one series, with gaps between
  ground.style = MarkStyle::thin, ground.colour = 7;
  outline.style = MarkStyle::line, outline.colour = 6;
  Series lake;
  lake.style = MarkStyle::dashes, lake.colour = 0;
  const auto join = [&](Series& s, const auto& line) {
    for (const auto& p : line) s.x.push_back(p.x + info_.offset.x), s.y.push_back(p.y + info_.offset.y);
    s.x.push_back(missing), s.y.push_back(missing);
  };
  for (const GroundLine& line : run_up_lines()) join(outline, line);
  for (const auto& line : edge_of(first_)) join(lake, line);
  for (const double z : contour_levels()) {
    for (const auto& line : contour_lines(ground_, z)) join(ground, line);
  }
  const auto add = [&](const char* title, const char* label, const Raster& r, double up) {
    ColourMap m;
    m.title = std::string(title) + ", " + plain_text(info_.name);
    m.x_label = "easting (m)";
    m.y_label = "northing (m)";
    m.value_label = label;
    m.x0 = r.x0 + info_.offset.x, m.y0 = r.y0 + info_.offset.y, m.dx = r.dx, m.nx = r.nx, m.ny = r.ny;
    m.value = r.value;
    for (float& v : m.value) v += static_cast<float>(up);
    m.overlay = {ground, outline, lake};
    m.note = "black: outline of all that was ever wet; grey: ground\nblue dashes: water's edge at the start";
    figure.map.push_back(std::move(m));
  };
  add("Highest water level", "elevation (m)", level_, info_.offset.z);
  add(("Arrival: first departure by " + format_number(threshold_) + " m").c_str(), "time (s)", arrival_, 0.0);
  return figure;
}

std::string MapMeasurement::summary() const {
  std::size_t wet = 0, before = 0;
  for (std::size_t k = 0; k < level_.value.size(); ++k)
    wet += std::isfinite(level_.value[k]), before += std::isfinite(first_.value[k]);
  const double area = level_.dx * level_.dx;
  const bool large = area * static_cast<double>(wet) >= 1e5;  // m2
  const double unit = large ? 1e6 : 1.0;
  char text[160];
  std::snprintf(text, sizeof text, "the water reached %.4g %s, of which %.4g %s were water at the start",
                area * static_cast<double>(wet) / unit, large ? "km2" : "m2", area * static_cast<double>(before) / unit,
                large ? "km2" : "m2");
  return text;
}

}  // namespace gdesp::analysis
