// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/run_up_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
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
      corner.reserve(polygon.size());
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
  const ConnectedWater connected = view.connected(options_.rule.connectivity);
  most_torn_ =
      std::max(most_torn_, static_cast<std::size_t>(std::count(connected.torn.begin(), connected.torn.end(), 1)));
  const RunUpFrame f =
      measure_run_up(view.grid(), connected, {info_.dp, still_, options_.rule.contact * info_.dp}, walls_, regions_);
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

Panel RunUpMeasurement::against_time() const {
  Panel panel;
  panel.title = "Run-up against time, " + plain_text(info_.name);
  panel.x_label = "time t (s)";
  panel.y_label = "above still water (m)";
  panel.note = "connected water on a wall; reading resolves dp = " + format_number(info_.dp) + " m";
  for (std::size_t k = 0; k < regions_.size(); ++k) {
    panel.series.push_back({regions_[k].name == "all" ? "whole shore" : plain_text(regions_[k].name),
                            time_,
                            height_[k],
                            {},
                            {},
                            MarkStyle::line,
                            {},
                            static_cast<int>(k)});
  }
  panel.y_low = 0.0;
  panel.y_high = maximum_[0].height > 0.0 ? 1.25 * maximum_[0].height : info_.dp;
  double highest_splash = 0.0;
  bool shown = false;
  for (const double s : splash_[0])
    highest_splash = std::max(highest_splash, std::isfinite(s) ? s : 0.0), shown = shown || s <= panel.y_high;
  if (highest_splash > panel.y_high)
    panel.note += "; splash up to " + format_number(std::round(10 * highest_splash) / 10) + " m";
  if (shown) panel.series.push_back({"splash", time_, splash_[0], {}, {}, MarkStyle::points, {}, 7});
  return panel;
}

Panel RunUpMeasurement::along_shore() const {
  Panel panel;
  const auto place = [&](const Point2& p) {
    return "(" + format_number(std::round(p.x + info_.offset.x)) + ", " +
           format_number(std::round(p.y + info_.offset.y)) + ")";
  };
  const auto& bins = profile_->bins();
  const double width = bins.size() > 1 ? bins[1].distance - bins[0].distance : 2.0 * bins[0].distance;
  panel.title = "Highest run-up along the shore, " +
                (regions_[profile_region_].name == "all" ? "whole shore" : plain_text(regions_[profile_region_].name));
  panel.x_label = "distance along " + plain_text(line_.name) + " (m)";
  panel.y_label = "highest run-up (m)";
  panel.note = "from " + place(line_.from) + " to " + place(line_.to) + "; places " + format_number(width) +
               " m wide; bars: dp/2";
  Series area{"", {}, {}, {}, {}, MarkStyle::band, {}, 0}, highest{"", {}, {}, {}, {}, MarkStyle::line, {}, 0},
      reading{"", {}, {}, {}, {}, MarkStyle::points, {}, 0};
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto put = [&](double x, double y) {
    highest.x.push_back(x), highest.y.push_back(y);
    area.x.push_back(x), area.y.push_back(y), area.low.push_back(0.0), area.high.push_back(y);
  };
  double last = 0.0, top = info_.dp;
  for (const ShoreProfile::Bin& bin : bins) {
    if (!bin.any) {
      put(none, none);  // no bank here that the water reached
      continue;
    }
    put(bin.distance - 0.5 * width, bin.height);
    put(bin.distance + 0.5 * width, bin.height);
    reading.x.push_back(bin.distance), reading.y.push_back(bin.height);
    reading.low.push_back(std::max(0.0, bin.height - 0.5 * info_.dp)),
        reading.high.push_back(bin.height + 0.5 * info_.dp);
    last = bin.distance + 0.5 * width;
    top = std::max(top, bin.height + 0.5 * info_.dp);
  }
  panel.x_low = 0.0;
  panel.x_high = last > 0.0 ? last : 1.0;
  panel.y_low = 0.0;
  panel.y_high = 1.1 * top;
  panel.series = {area, highest};
  if (reading.x.size() <= 40) panel.series.push_back(reading);
  return panel;
}

Figure RunUpMeasurement::figure() const {
  Figure figure;
  figure.panel.push_back(against_time());
  if (info_.dimensions != 3) return figure;
  const auto& bins = profile_->bins();
  if (std::any_of(bins.begin(), bins.end(), [](const ShoreProfile::Bin& bin) { return bin.any; })) {
    figure.panel.push_back(along_shore());
  } else {
    figure.panel.back().note += "; nothing climbs the " + plain_text(regions_[profile_region_].name);
  }
  return figure;
}

std::string RunUpMeasurement::summary() const {
  const auto shown = [](double metres) {  // three digits: more than the reading resolves
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", metres);
    return std::string(text);
  };
  std::string text;
  for (const Maximum& m : maximum_) {
    text += (text.empty() ? "" : "; ") + (m.region == "all" ? std::string("highest run-up") : m.region) + " ";
    text += m.climbs ? shown(m.height) + " m at t = " + format_number(m.time) + " s" : "none";
  }
  return text + " (reading resolves " + format_number(info_.dp) + " m)";
}

}  // namespace gdesp::analysis
