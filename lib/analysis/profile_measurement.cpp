// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/profile_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace gdesp::analysis {

namespace {
constexpr double none = std::numeric_limits<double>::quiet_NaN();

double drawn_range(const Panel& panel) {
  double low = 1e300, high = -1e300;
  for (const Series& s : panel.series) {
    for (const double y : s.y) {
      if (std::isfinite(y)) low = std::min(low, y), high = std::max(high, y);
    }
  }
  return high - low;
}

}  // namespace

std::vector<double> top_of_grains(const GrainTable& grains, const std::vector<Point2>& point, int dimensions) {
  std::vector<double> top(point.size(), none);
  if (grains.position.empty()) return top;
  const double largest = *std::max_element(grains.diameter.begin(), grains.diameter.end());
  const ColumnGrid grid(grains.position, largest, dimensions);
  const double all = std::numeric_limits<double>::infinity();
#pragma omp parallel for schedule(dynamic, 16)
  for (std::size_t k = 0; k < point.size(); ++k) {
    double best = -all;
    grid.for_each(point[k].x, point[k].y, -all, all, [&](std::size_t s, double r2) {
      const double d = grains.diameter[grid.index(s)];
      // A point between grains of a packing still lies on the deposit: half a diameter of reach beyond the radius.
      if (r2 > d * d) return;
      best = std::max(best, grid.position(s).z + std::sqrt(std::max(0.0, 0.25 * d * d - r2)));
    });
    if (std::isfinite(best)) top[k] = best;
  }
  return top;
}

std::vector<std::string> ProfileMeasurement::begin(const RunInfo& info) {
  info_ = info;
  choose_line();
  const WallSurface walls(info.walls);
  info_.walls = {};
  for (const Point2& p : point_) {
    const auto height = walls.height(p.x, info_.dimensions == 2 ? 0.0 : p.y);
    bed_.push_back(height ? *height : none);
  }
  std::sort(options_.times.begin(), options_.times.end());
  return {"t[s]", "s[m]", "x[m]", "y[m]", "z_surface[m]", "z_solids[m]", "z_bed[m]"};
}

void ProfileMeasurement::choose_line() {
  if (options_.line) {
    line_ = *options_.line;
    line_.from.x -= info_.offset.x, line_.from.y -= info_.offset.y;
    line_.to.x -= info_.offset.x, line_.to.y -= info_.offset.y;
  } else if (!options_.section.empty()) {
    line_ = find_section(info_, options_.section);
  } else {
    const double y = 0.5 * (info_.domain.lower.y + info_.domain.upper.y);
    line_ = {"x", {info_.domain.lower.x, y}, {info_.domain.upper.x, y}};
    const auto sections = sections_in_case(info_);
    if (!sections.empty()) line_ = sections[0];
  }
  const double length = std::hypot(line_.to.x - line_.from.x, line_.to.y - line_.from.y);
  if (!(length > 0.0)) throw Error(ErrorKind::usage, "the profile's line has no length; give --line x1,y1,x2,y2");
  const double step = options_.step > 0.0 ? options_.step : info_.dp;
  const int count = static_cast<int>(std::floor(length / step + 1e-9)) + 1;
  if (count > 2000000)
    throw Error(ErrorKind::usage, "--step " + format_number(step) + " makes more than 2 million points");
  for (int k = 0; k < count; ++k) {
    const double s = k * step, share = s / length;
    distance_.push_back(s);
    point_.push_back(
        {line_.from.x + share * (line_.to.x - line_.from.x), line_.from.y + share * (line_.to.y - line_.from.y)});
  }
}

ProfileMeasurement::Curve ProfileMeasurement::measure(FrameView& view) const {
  Curve curve;
  curve.time = view.time();
  curve.water.assign(point_.size(), none);
  if (!view.frame().fluid.position.empty()) {
    const FluidSampler& water = view.water();
#pragma omp parallel for schedule(dynamic, 16)
    for (std::size_t k = 0; k < point_.size(); ++k) {
      if (const auto level = water.surface_level(point_[k].x, point_[k].y)) curve.water[k] = *level;
    }
  }
  curve.solids = top_of_grains(view.frame().grains, point_, info_.dimensions);
  if (!view.frame().bodies.triangle.empty()) {
    TriangleTable bodies = view.frame().bodies;
    bodies.body.assign(bodies.triangle.size(), 0);
    const WallSurface surface(bodies);
    for (std::size_t k = 0; k < point_.size(); ++k) {
      if (const auto z = surface.height(point_[k].x, point_[k].y)) {
        curve.solids[k] = std::isfinite(curve.solids[k]) ? std::max(curve.solids[k], *z) : *z;
      }
    }
  }
  return curve;
}

void ProfileMeasurement::emit_curve(const Curve& curve, const RowSink& emit) const {
  const double up = info_.offset.z;
  for (std::size_t k = 0; k < point_.size(); ++k) {
    emit({curve.time, distance_[k], point_[k].x + info_.offset.x, point_[k].y + info_.offset.y, curve.water[k] + up,
          curve.solids[k] + up, bed_[k] + up});
  }
}

void ProfileMeasurement::add(FrameView& view, const RowSink& emit) {
  if (options_.times.empty()) {
    curve_.push_back(measure(view));
    emit_curve(curve_.back(), emit);
    return;
  }
  // The frame nearest to each wanted time: decided when the first later frame is seen.
  if (next_time_ >= options_.times.size()) return;
  Curve now = measure(view);
  while (next_time_ < options_.times.size() && now.time >= options_.times[next_time_]) {
    const double wanted = options_.times[next_time_++];
    const bool earlier = last_ && wanted - last_->time < now.time - wanted;
    curve_.push_back(earlier ? *last_ : now);
    emit_curve(curve_.back(), emit);
  }
  last_ = std::move(now);
}

void ProfileMeasurement::finish(const RowSink& emit) {
  if (next_time_ >= options_.times.size() || !last_) return;
  if (options_.times.back() > last_->time * (1.0 + 1e-6)) late_ = options_.times.back();
  next_time_ = options_.times.size();
  curve_.push_back(*last_);  // the wanted time lies past the end: the last frame, with its own time in the table
  emit_curve(curve_.back(), emit);
}

Figure ProfileMeasurement::figure() const {
  Figure figure;
  Panel panel;
  panel.title = "Surface along section " + plain_text(line_.name) + ", " + plain_text(info_.name);
  panel.x_label = "distance along the line (m)";
  panel.y_label = "elevation (m)";
  const auto lifted = [&](std::vector<double> v) {
    for (double& z : v) z += info_.offset.z;
    return v;
  };
  if (std::any_of(bed_.begin(), bed_.end(), [](double z) { return std::isfinite(z); })) {
    panel.series.push_back({"bed", distance_, lifted(bed_), {}, {}, MarkStyle::line, {}, 6});
  }
  const std::size_t shown = std::min<std::size_t>(curve_.size(), 5);
  for (std::size_t j = 0; j < shown; ++j) {
    const std::size_t k = shown == curve_.size() ? j : j * (curve_.size() - 1) / (shown - 1);
    const Curve& c = curve_[k];
    const std::string at = "t = " + format_number(c.time) + " s";
    const bool solids = std::any_of(c.solids.begin(), c.solids.end(), [](double z) { return std::isfinite(z); });
    panel.series.push_back(
        {"water, " + at, distance_, lifted(c.water), {}, {}, MarkStyle::line, {}, static_cast<int>(j)});
    if (solids)
      panel.series.push_back(
          {"slide, " + at, distance_, lifted(c.solids), {}, {}, MarkStyle::dashes, {}, static_cast<int>(j)});
  }
  const double range = drawn_range(panel);
  figure.panel.push_back(std::move(panel));
  figure.width_mm = 180.0;
  figure.panel_height_mm = 90.0;
  if (const auto waves = above_still_water(shown, range)) figure.panel.push_back(*waves);
  return figure;
}

// The water alone, where the valley is so much higher that its waves would not be seen.
std::optional<Panel> ProfileMeasurement::above_still_water(std::size_t shown, double range) const {
  if (!info_.still_water_level || info_.scene.terrain.files.empty()) return std::nullopt;
  Panel panel;
  panel.title = "The water's surface above still water";
  panel.x_label = "distance along the line (m)";
  panel.y_label = "above still water (m)";
  for (std::size_t j = 0; j < shown; ++j) {
    const std::size_t k = shown == curve_.size() ? j : j * (curve_.size() - 1) / (shown - 1);
    std::vector<double> rise = curve_[k].water;
    for (double& z : rise) z -= *info_.still_water_level;
    panel.series.push_back({"t = " + format_number(curve_[k].time) + " s",
                            distance_,
                            std::move(rise),
                            {},
                            {},
                            MarkStyle::line,
                            {},
                            static_cast<int>(j)});
  }
  return drawn_range(panel) < 0.3 * range ? std::optional(panel) : std::nullopt;
}

std::string ProfileMeasurement::summary() const {
  return std::to_string(curve_.size()) + " profiles of " + std::to_string(point_.size()) + " points along " +
         line_.name +
         (late_ ? "; no frame as late as t = " + format_number(*late_) +
                      " s, the last one is taken (t = " + format_number(curve_.back().time) + " s)"
                : "");
}

}  // namespace gdesp::analysis
