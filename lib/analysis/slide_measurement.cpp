// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/slide_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "analysis/front.hpp"
#include "analysis/front_measurement.hpp"
#include "core/error.hpp"

namespace gdesp::analysis {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

// Water levels over the slide on a raster of spacing dp, nearest cell; cheaper than one column per grain.
class LevelRaster {
 public:
  LevelRaster(FrameView& view, const std::vector<Vec3d>& over) : dimensions_(view.info().dimensions) {
    if (over.empty() || view.frame().fluid.position.empty()) return;
    Vec3d lower = over[0], upper = over[0];
    for (const Vec3d& p : over) {
      lower.x = std::min(lower.x, p.x), lower.y = std::min(lower.y, p.y);
      upper.x = std::max(upper.x, p.x), upper.y = std::max(upper.y, p.y);
    }
    double dx = view.info().dp;
    while ((upper.x - lower.x) / dx * (dimensions_ == 2 ? 1.0 : (upper.y - lower.y) / dx) > 4e6) dx *= 2.0;
    raster_ = make_raster(lower, {upper.x + dx, upper.y + dx, 0}, dx, dimensions_);
    fill_surface_levels(view.water(), raster_);
  }

  std::optional<double> at(double x, double y) const {
    if (raster_.value.empty()) return std::nullopt;
    const int ix = std::clamp(static_cast<int>(std::lround((x - raster_.x0) / raster_.dx)), 0, raster_.nx - 1);
    const int iy = std::clamp(static_cast<int>(std::lround((y - raster_.y0) / raster_.dx)), 0, raster_.ny - 1);
    const float z = raster_.at(ix, dimensions_ == 2 ? 0 : iy);
    return std::isfinite(z) ? std::optional<double>(z) : std::nullopt;
  }

 private:
  int dimensions_;
  Raster raster_;
};

}  // namespace

std::vector<std::string> SlideMeasurement::begin(const RunInfo& info) {
  info_ = info;
  info_.walls = {};
  if (options_.direction) {
    direction_ = *options_.direction;
  } else if (info.slide_centre && info.fluid_count > 0) {
    const Vec3d to{info.lake.centre.x - info.slide_centre->x,
                   info.dimensions == 2 ? 0.0 : info.lake.centre.y - info.slide_centre->y, 0.0};
    if (norm(to) > 0.0) direction_ = to * (1.0 / norm(to));
  }
  return {"t[s]",         "x[m]",       "y[m]",
          "z[m]",         "vx[m/s]",    "vy[m/s]",
          "vz[m/s]",      "speed[m/s]", "front_travel[m]",
          "submerged[-]", "volume[m3]", "fastest[m/s]"};
}

void SlideMeasurement::add(FrameView& view, const RowSink& emit) {
  const Frame& f = view.frame();
  const bool grains = !f.grains.position.empty();
  if (!grains && f.bodies.triangle.empty()) {
    throw Error(ErrorKind::input,
                info_.name + ": the frame at t = " + format_number(view.time()) + " s has neither grains nor bodies");
  }
  const LevelRaster levels(view, grains ? f.grains.position : f.bodies.vertex);
  const LevelAt level = [&](double x, double y) { return levels.at(x, y); };
  SlideState s = grains ? measure_grains(f.grains, info_.dimensions, level) : measure_body(f.bodies, info_.dp, level);
  if (!grains) {
    const double dt = view.time() - last_time_;
    s.velocity = last_centre_ && dt > 0.0 ? (s.centre - *last_centre_) * (1.0 / dt) : Vec3d{none, none, none};
  }
  const auto front = grains ? leading_edge(f.grains.position, direction_, options_.fraction, 0.0,
                                           grain_volumes(f.grains, info_.dimensions), f.grains.diameter)
                            : leading_edge(f.bodies.vertex, direction_, 0.0, 1e-9);
  if (!first_front_) first_front_ = front;
  last_centre_ = s.centre;
  last_time_ = view.time();
  const Vec3d at = to_scene(info_, s.centre);
  time_.push_back(view.time());
  speed_.push_back(norm(s.velocity));
  travel_.push_back(front ? *front - *first_front_ : none);
  depth_.push_back(at.z);
  submerged_.push_back(s.submerged);
  emit({view.time(), at.x, at.y, at.z, s.velocity.x, s.velocity.y, s.velocity.z, speed_.back(), travel_.back(),
        s.submerged, s.volume, grains ? s.fastest : none});
}

Figure SlideMeasurement::figure() const {
  Figure figure;
  figure.panel_height_mm = 64.0;
  const auto panel = [&](const std::string& title, const std::string& label, const std::vector<double>& y, int colour) {
    Panel p;
    p.title = title;
    p.x_label = "time t (s)";
    p.y_label = label;
    p.series.push_back({"", time_, y, {}, {}, MarkStyle::line, {}, colour});
    figure.panel.push_back(std::move(p));
  };
  panel("Slide, " + info_.name, "speed of the centre (m/s)", speed_, 1);
  panel("", "travel of the front (m)", travel_, 1);
  std::vector<double> percent = submerged_;
  for (double& s : percent) s *= 100.0;
  panel("", "submerged volume (%)", percent, 0);
  return figure;
}

std::string SlideMeasurement::summary() const {
  if (time_.empty()) return {};
  double fastest = 0.0;
  for (const double v : speed_) fastest = std::max(fastest, std::isfinite(v) ? v : 0.0);
  char text[160];
  std::snprintf(text, sizeof text,
                "slide: fastest %.3g m/s (centre of mass), front travelled %.4g m, %.3g %% submerged at the end",
                fastest, travel_.back(), 100.0 * submerged_.back());
  return text;
}

}  // namespace gdesp::analysis
