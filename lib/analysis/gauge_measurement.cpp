// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/gauge_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "analysis/front.hpp"
#include "core/error.hpp"

namespace gdesp::analysis {

namespace {
constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// m, level of a far lake's columns at x, linear between their middles; nothing beside them. The first and the last reach as far to the
/// outside as to their neighbour's middle.
std::optional<double> far_lake_level(const std::vector<FarLakeTable>& lakes, double x) {
  for (const FarLakeTable& lake : lakes) {
    const std::size_t n = lake.x.size();
    if (n < 2) continue;
    const double side = lake.x[1] > lake.x[0] ? 1.0 : -1.0;
    const auto at = [&](std::size_t j) { return side * (lake.x[j] - x); };
    if (at(0) > 0.5 * (at(1) - at(0)) || -at(n - 1) > 0.5 * (at(n - 1) - at(n - 2))) continue;
    std::size_t j = 1;
    while (j + 1 < n && at(j) < 0.0) ++j;
    const double share = std::clamp(-at(j - 1) / (at(j) - at(j - 1)), 0.0, 1.0);
    return lake.level[j - 1] + share * (lake.level[j] - lake.level[j - 1]);
  }
  return std::nullopt;
}

bool any_number(const std::vector<double>& v) {
  return std::any_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
}
}  // namespace

Gauge parse_gauge(const std::string& text, int number) {
  Gauge gauge;
  const auto equals = text.find('=');
  gauge.name = equals == std::string::npos ? "gauge " + std::to_string(number) : text.substr(0, equals);
  const std::string rest = equals == std::string::npos ? text : text.substr(equals + 1);
  char more = 0;
  const int found = std::sscanf(rest.c_str(), "%lf,%lf,%lf%c", &gauge.at.x, &gauge.at.y, &gauge.at.z, &more);
  if (found != 2 && found != 3)
    throw Error(ErrorKind::usage, "--at " + text + ": valid is NAME=X,Y or NAME=X,Y,Z in metres");
  gauge.has_z = found == 3;
  return gauge;
}

std::vector<std::string> GaugeMeasurement::begin(const RunInfo& info) {
  info_ = info;
  info_.walls = {};
  gauge_ = options_.gauges.empty() ? info.scene.gauges : options_.gauges;
  if (gauge_.empty()) throw Error(ErrorKind::usage, info.name + ": the scene has no gauges; give --at NAME=X,Y[,Z]");
  for (Gauge& g : gauge_) g.at = g.at - info.offset;
  threshold_ = options_.threshold > 0.0 ? options_.threshold : 0.5 * info.dp;
  level_.resize(gauge_.size());
  pressure_.resize(gauge_.size());
  if (options_.arrivals) {
    return {"gauge", "x[m]", "y[m]", "t_arrival[s]", "level_max[m]", "t_max[s]", "pressure_max[Pa]", "threshold[m]"};
  }
  return {"t[s]", "gauge", "x[m]", "y[m]", "level[m]", "rise[m]", "pressure[Pa]"};
}

void GaugeMeasurement::add(FrameView& view, const RowSink& emit) {
  time_.push_back(view.time());
  const FluidTable& fluid = view.frame().fluid;
  const double gamma = info_.fluid_density() * info_.gravity();
  for (std::size_t k = 0; k < gauge_.size(); ++k) {
    const Gauge& g = gauge_[k];
    double level = none, pressure = none;
    if (const auto z = far_lake_level(view.frame().far_lakes, g.at.x)) {
      level = *z + info_.offset.z;
    } else if (!fluid.position.empty()) {
      if (const auto z = view.water().surface_level(g.at.x, g.at.y)) level = *z + info_.offset.z;
      if (g.has_z && fluid.pressure.size() == fluid.position.size()) {
        // No water there: none pressed. Above the surface of standing water the carried value would turn negative.
        pressure = view.all_water().sample(g.at, fluid.pressure, -gamma).value_or(0.0);
        if (pressure < 0.0) pressure = std::min(0.0, *view.all_water().sample(g.at, fluid.pressure));
      }
    }
    level_[k].push_back(level);
    pressure_[k].push_back(pressure);
    if (options_.arrivals) continue;
    const auto first = std::find_if(level_[k].begin(), level_[k].end(), [](double z) { return std::isfinite(z); });
    const double rise = first == level_[k].end() ? none : level - *first;
    emit({view.time(), g.name, g.at.x + info_.offset.x, g.at.y + info_.offset.y, level, rise, pressure});
  }
}

std::optional<double> GaugeMeasurement::arrival(std::size_t k) const {
  if (level_[k].empty()) return std::nullopt;
  if (!std::isfinite(level_[k][0])) {  // dry at first
    for (std::size_t i = 1; i < time_.size(); ++i) {
      if (std::isfinite(level_[k][i])) return time_[i];
    }
    return std::nullopt;
  }
  return first_departure(time_, level_[k], threshold_);
}

void GaugeMeasurement::finish(const RowSink& emit) {
  if (!options_.arrivals) return;
  for (std::size_t k = 0; k < gauge_.size(); ++k) {
    double level = none, at = none, pressure = none;
    for (std::size_t i = 0; i < time_.size(); ++i) {
      if (std::isfinite(level_[k][i]) && !(level_[k][i] <= level)) level = level_[k][i], at = time_[i];
      if (std::isfinite(pressure_[k][i]) && !(pressure_[k][i] <= pressure)) pressure = pressure_[k][i];
    }
    emit({gauge_[k].name, gauge_[k].at.x + info_.offset.x, gauge_[k].at.y + info_.offset.y, arrival(k).value_or(none),
          level, at, pressure, threshold_});
  }
}

Figure GaugeMeasurement::figure() const {
  Figure figure;
  Panel level, pressure;
  level.title = "Water level, " + plain_text(info_.name);
  level.x_label = pressure.x_label = "time t (s)";
  level.y_label = "elevation (m)";
  pressure.title = "Pressure, " + plain_text(info_.name);
  pressure.y_label = "pressure (kPa)";
  for (std::size_t k = 0; k < gauge_.size(); ++k) {
    if (any_number(level_[k]))
      level.series.push_back(
          {plain_text(gauge_[k].name), time_, level_[k], {}, {}, MarkStyle::line, {}, static_cast<int>(k)});
    if (!any_number(pressure_[k])) continue;
    std::vector<double> kilo = pressure_[k];
    for (double& p : kilo) p *= 1e-3;
    pressure.series.push_back(
        {plain_text(gauge_[k].name), time_, std::move(kilo), {}, {}, MarkStyle::line, {}, static_cast<int>(k)});
  }
  figure.panel.push_back(std::move(level));
  if (!pressure.series.empty()) figure.panel.push_back(std::move(pressure));
  return figure;
}

std::string GaugeMeasurement::summary() const {
  std::string text;
  for (std::size_t k = 0; k < gauge_.size(); ++k) {
    const auto t = arrival(k);
    const bool wet = std::any_of(level_[k].begin(), level_[k].end(), [](double z) { return std::isfinite(z); });
    text += (text.empty() ? "" : "; ") + gauge_[k].name +
            (t     ? ": arrival at t = " + format_number(std::round(*t * 1e3) / 1e3) + " s"
             : wet ? ": no arrival"
                   : ": no water there at any time (particles are " + format_number(info_.dp) + " m apart)");
  }
  return text;
}

}  // namespace gdesp::analysis
