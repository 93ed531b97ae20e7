// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/run_up_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace gdesp::analysis {

std::vector<std::string> RunUpMeasurement::begin(const RunInfo& info) {
  info_ = info;
  if (!info.still_water_level) {
    throw Error(ErrorKind::input, "run-up is counted from the still-water level, which " + info.name +
                                      " does not carry; give it with --still-water METRES");
  }
  still_ = *info.still_water_level;
  walls_ = WallSurface(info.walls);
  info_.walls = {};
  regions_ = bank_regions(info);
  height_.resize(regions_.size());
  splash_.resize(regions_.size());
  for (const BankRegion& r : regions_) maximum_.push_back({r.name, 0.0, 0.0, {}, false});
  choose_line();
  if (options_.along_shore) return {"s[m]", "x[m]", "y[m]", "z[m]", "run_up[m]", "t[s]", "resolution[m]"};
  return {"t[s]", "region", "run_up[m]", "x[m]", "y[m]", "z[m]", "splash[m]", "resolution[m]"};
}

void RunUpMeasurement::choose_line() {
  const auto named = [&](const std::string& name) {
    return std::find_if(regions_.begin(), regions_.end(), [&](const BankRegion& r) { return r.name == name; });
  };
  if (!options_.region.empty()) {
    const auto found = named(options_.region);
    if (found == regions_.end()) {
      std::string known;
      for (const BankRegion& r : regions_) known += (known.empty() ? "" : ", ") + r.name;
      throw Error(ErrorKind::usage, "--region " + options_.region + ": there are " + known);
    }
    profile_region_ = static_cast<std::size_t>(found - regions_.begin());
  } else {
    const auto far = named("far bank");
    profile_region_ = far != regions_.end() ? static_cast<std::size_t>(far - regions_.begin()) : regions_.size() > 1;
  }
  if (!options_.section.empty()) {
    line_ = find_section(info_, options_.section);
  } else {
    line_ = {"the lake's long axis", info_.lake.from, info_.lake.to};
    const auto& polygon = regions_[profile_region_].polygon;
    if (!polygon.empty()) {  // the region's own long axis
      std::vector<Vec3d> corner;
      for (const Point2& p : polygon) corner.push_back({p.x, p.y, 0.0});
      const LongAxis axis = find_long_axis(corner);
      line_ = {"the region's long axis", axis.from, axis.to};
    }
  }
  const double length = std::hypot(line_.to.x - line_.from.x, line_.to.y - line_.from.y);
  if (length <= 0.0) line_.to.x = line_.from.x + std::max(info_.dp, 1e-9);
  profile_.emplace(line_.from, line_.to, options_.bin > 0.0 ? options_.bin : 4.0 * info_.dp);
}

void RunUpMeasurement::add(FrameView& view, const RowSink& emit) {
  const RunUpFrame f = measure_run_up(view.grid(), info_.dp, still_, walls_, regions_, options_.rule);
  time_.push_back(view.time());
  profile_->add(view.time(), f.on_bank, regions_[profile_region_]);
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < regions_.size(); ++k) {
    const RunUpReading& r = f.region[k];
    height_[k].push_back(r.height);
    splash_[k].push_back(r.splash > 0.0 ? r.splash : none);
    const Vec3d at = r.climbs ? to_scene(info_, r.at) + Vec3d{0, 0, 0.5 * info_.dp} : Vec3d{none, none, none};
    if (r.climbs && r.height > maximum_[k].height) maximum_[k] = {regions_[k].name, r.height, view.time(), at, true};
    if (!options_.along_shore) {
      emit({view.time(), regions_[k].name, r.height, at.x, at.y, at.z, r.splash, info_.dp});
    }
  }
}

void RunUpMeasurement::finish(const RowSink& emit) {
  if (!options_.along_shore) return;
  for (const ShoreProfile::Bin& bin : profile_->bins()) {
    if (!bin.any) continue;
    const Vec3d at = to_scene(info_, bin.at);
    emit({bin.distance, at.x, at.y, at.z + 0.5 * info_.dp, bin.height, bin.time, info_.dp});
  }
}

Figure RunUpMeasurement::figure() const {
  Figure figure;
  Panel in_time;
  in_time.title = "Run-up against time, " + info_.name;
  in_time.x_label = "time t (s)";
  in_time.y_label = "height above still water (m)";
  in_time.note = "resolution " + format_number(info_.dp) + " m; connected water on a wall";
  for (std::size_t k = 0; k < regions_.size(); ++k) {
    in_time.series.push_back({regions_[k].name == "all" ? "whole shore" : plain_text(regions_[k].name), time_, height_[k], {}, {},
                              MarkStyle::line, {}, static_cast<int>(k)});
  }
  in_time.y_low = 0.0;
  in_time.y_high = 1.0;
  double highest_splash = 0.0;
  for (const double s : splash_[0]) highest_splash = std::max(highest_splash, std::isfinite(s) ? s : 0.0);
  if (maximum_[0].height > 0.0) in_time.y_high = 1.4 * maximum_[0].height;
  if (highest_splash > in_time.y_high) in_time.note += "; splash up to " + format_number(std::round(10 * highest_splash) / 10) + " m";
  const bool any_splash = std::any_of(splash_[0].begin(), splash_[0].end(), [](double s) { return std::isfinite(s); });
  if (any_splash) in_time.series.push_back({"splash", time_, splash_[0], {}, {}, MarkStyle::points, {}, 7});
  figure.panel.push_back(std::move(in_time));
  if (info_.dimensions == 2) return figure;
  Panel along;
  along.title = "Highest run-up along the shore, " + plain_text(regions_[profile_region_].name);
  along.x_label = "distance along " + plain_text(line_.name) + " (m)";
  along.y_label = "run-up (m)";
  along.y_low = 0.0;
  along.y_high = std::max(1.1 * maximum_[profile_region_].height, info_.dp);
  Series highest{"", {}, {}, {}, {}, MarkStyle::line, {}, 0};
  Series area{"", {}, {}, {}, {}, MarkStyle::band, {}, 0};
  for (const ShoreProfile::Bin& bin : profile_->bins()) {
    highest.x.push_back(bin.distance);
    highest.y.push_back(bin.height);
    area.low.push_back(0.0);
    area.high.push_back(bin.height);
  }
  area.x = highest.x, area.y = highest.y;
  along.series = {area, highest};
  figure.panel.push_back(std::move(along));
  return figure;
}

std::string RunUpMeasurement::summary() const {
  std::string text;
  for (const Maximum& m : maximum_) {
    text += (text.empty() ? "" : "; ") + (m.region == "all" ? std::string("highest run-up") : m.region) + " ";
    if (!m.climbs) {
      text += "none";
      continue;
    }
    text += format_number(std::round(m.height * 1e3) / 1e3) + " m at t = " + format_number(m.time) + " s";
  }
  return text + " (resolution " + format_number(info_.dp) + " m)";
}

}  // namespace gdesp::analysis
