// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/front_measurement.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "analysis/front.hpp"
#include "core/error.hpp"

namespace gdesp::analysis {

Vec3d parse_direction(const std::string& text) {
  if (text == "x" || text == "+x") return {1, 0, 0};
  if (text == "-x") return {-1, 0, 0};
  if (text == "y" || text == "+y") return {0, 1, 0};
  if (text == "-y") return {0, -1, 0};
  double x = 0, y = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf%c", &x, &y, &rest) != 2 || std::hypot(x, y) == 0.0) {
    throw Error(ErrorKind::usage, "--direction " + text + ": valid are x, -x, y, -y or two numbers NX,NY");
  }
  const double length = std::hypot(x, y);
  return {x / length, y / length, 0.0};
}

std::vector<double> grain_volumes(const GrainTable& grains, int dimensions) {
  std::vector<double> volume;
  volume.reserve(grains.diameter.size());
  for (const double d : grains.diameter) {
    volume.push_back(dimensions == 2 ? std::numbers::pi * d * d / 4.0 : std::numbers::pi * d * d * d / 6.0);
  }
  return volume;
}

std::vector<std::string> FrontMeasurement::begin(const RunInfo& info) {
  info_ = info;
  info_.walls = {};
  const double height = info.fluid_upper.z - info.fluid_lower.z + info.dp;
  scale_ = options_.scale_length > 0.0 ? options_.scale_length : height;
  if (!(scale_ > 0.0))
    throw Error(ErrorKind::input, "the run has no water to take the scale from; give --scale-length METRES");
  if (options_.origin) {
    origin_ = *options_.origin - dot(info.offset, options_.direction);
  } else {
    const Vec3d& d = options_.direction;  // the corner of the fluid's box that lies furthest along d
    const Vec3d corner{d.x > 0 ? info.fluid_upper.x : info.fluid_lower.x,
                       d.y > 0 ? info.fluid_upper.y : info.fluid_lower.y, 0.0};
    origin_ = dot(corner, d) + 0.5 * info.dp;
  }
  return {"t[s]", "x_front[m]", "x_tip[m]", "x_solids[m]", "t*", "x*", "x*_solids"};
}

void FrontMeasurement::add(FrameView& view, const RowSink& emit) {
  const Vec3d& d = options_.direction;
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto water = leading_edge(view.main_positions(), d, options_.fraction, info_.dp);
  const auto tip = leading_edge(view.main_positions(), d, 0.0, info_.dp);
  const GrainTable& grains = view.frame().grains;
  std::optional<double> solids;
  if (!grains.position.empty()) {
    const std::vector<double> volume = grain_volumes(grains, info_.dimensions);
    solids = leading_edge(grains.position, d, options_.fraction, 0.0, volume, grains.diameter);
  } else if (!view.frame().bodies.vertex.empty()) {
    solids = leading_edge(view.frame().bodies.vertex, d, 0.0, 1e-9);
  }
  const double shift = dot(info_.offset, d);
  time_.push_back(view.time());
  water_.push_back(water ? *water - origin_ : none);
  tip_.push_back(tip ? *tip - origin_ : none);
  solids_.push_back(solids ? *solids - origin_ : none);
  emit({view.time(), water ? *water + shift : none, tip ? *tip + shift : none, solids ? *solids + shift : none,
        view.time() * std::sqrt(info_.gravity() / scale_), water_.back() / scale_, solids_.back() / scale_});
}

Figure FrontMeasurement::figure() const {
  Panel panel;
  panel.title = "Leading edge, " + plain_text(info_.name);
  panel.x_label = "dimensionless time t* = t (g/L)^{1/2}";
  panel.y_label = "dimensionless front x* = (x - x_0)/L";
  panel.note = "L = " + format_number(scale_) + " m; front: " + format_number(100.0 * options_.fraction) +
               " % of the fill lies beyond";
  const double to_star = std::sqrt(info_.gravity() / scale_);
  const auto scaled = [](std::vector<double> v, double factor) {
    for (double& value : v) value *= factor;
    return v;
  };
  const std::vector<double> t = scaled(time_, to_star);
  const auto finite = [](const std::vector<double>& v) {
    for (const double value : v) {
      if (std::isfinite(value)) return true;
    }
    return false;
  };
  if (finite(water_))
    panel.series.push_back({"water", t, scaled(water_, 1.0 / scale_), {}, {}, MarkStyle::line, {}, 0});
  if (finite(solids_))
    panel.series.push_back({"solids", t, scaled(solids_, 1.0 / scale_), {}, {}, MarkStyle::line, {}, 1});
  if (!options_.reference.empty()) {
    const Table table = read_table(options_.reference);
    panel.series.push_back({"reference",
                            table.numbers(options_.reference_t),
                            table.numbers(options_.reference_x),
                            {},
                            {},
                            MarkStyle::points,
                            {},
                            6});
  }
  Figure figure;
  figure.panel.push_back(std::move(panel));
  figure.panel_height_mm = 100.0;
  return figure;
}

std::string FrontMeasurement::summary() const {
  if (time_.empty()) return {};
  return "front at t = " + format_number(time_.back()) + " s: " + format_number(water_.back()) + " m from the start" +
         (std::isfinite(solids_.back()) ? "; solids: " + format_number(solids_.back()) + " m" : "");
}

}  // namespace gdesp::analysis
