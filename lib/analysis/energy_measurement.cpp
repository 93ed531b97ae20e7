// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/energy_measurement.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace gdesp::analysis {

namespace {

double square(const Vec3f& v) {
  const Vec3d w(v);
  return dot(w, w);
}

// Specific energy of compression over B / rho0, for r near 1 without cancellation.
double compression(double r) {
  const double x = r - 1.0;
  if (std::abs(x) < 1e-3) return 3.5 * x * x + 7.0 / 3.0 * x * x * x;  // Taylor series
  return std::pow(r, 6) / 6.0 + 1.0 / r - 7.0 / 6.0;
}

void add_water(const FluidTable& w, const RunInfo& info, EnergyState& e) {
  const double rho0 = info.fluid_density(), mass = rho0 * std::pow(info.dp, info.dimensions);
  double kinetic = 0, height = 0, px = 0, xx = 0, stored = 0;
  const bool moving = w.velocity.size() == w.position.size();
  const bool compressed = w.density.size() == w.position.size() && w.pressure.size() == w.position.size();
#pragma omp parallel for schedule(static) reduction(+ : kinetic, height, px, xx, stored)
  for (std::size_t i = 0; i < w.position.size(); ++i) {
    height += w.position[i].z;
    if (moving) kinetic += 0.5 * square(w.velocity[i]);
    if (!compressed || w.pressure[i] == 0.0f)
      continue;  // torn water, whose pressure the solver holds at 0, stores nothing
    const double r = w.density[i] / rho0, x = std::pow(r, 7) - 1.0;
    px += w.pressure[i] * x;
    xx += x * x;
    stored += compression(r);
  }
  e.water_kinetic = mass * kinetic;
  e.water_potential = mass * info.gravity() * height;
  if (compressed && xx > 0.0) e.water_compression = mass * std::max(0.0, px / xx) / rho0 * stored;
}

void add_grains(const GrainTable& g, const RunInfo& info, EnergyState& e) {
  double kinetic = 0, rotation = 0, potential = 0;
  const bool moving = g.velocity.size() == g.position.size(), turning = g.angular_velocity.size() == g.position.size();
#pragma omp parallel for schedule(static) reduction(+ : kinetic, rotation, potential)
  for (std::size_t i = 0; i < g.position.size(); ++i) {
    const double d = g.diameter[i], flat = info.dimensions == 2;
    const double volume = flat ? std::numbers::pi * d * d / 4.0 : std::numbers::pi * d * d * d / 6.0;
    const double m = volume * (i < g.density.size() ? g.density[i] : 0.0);
    potential += m * info.gravity() * g.position[i].z;
    if (moving) kinetic += 0.5 * m * square(g.velocity[i]);
    if (turning) rotation += 0.5 * m * d * d / (flat ? 8.0 : 10.0) * square(g.angular_velocity[i]);
  }
  e.solid_kinetic = kinetic;
  e.solid_rotation = rotation;
  e.solid_potential = potential;
}

}  // namespace

EnergyState measure_energy(const Frame& frame, const RunInfo& info) {
  EnergyState e;
  add_water(frame.fluid, info, e);
  add_grains(frame.grains, info, e);
  return e;
}

std::vector<std::string> EnergyMeasurement::begin(const RunInfo& info) {
  info_ = info;
  info_.walls = {};
  value_.resize(8);
  const std::string unit = info.dimensions == 2 ? "[J/m]" : "[J]";
  std::vector<std::string> columns{"t[s]"};
  for (const char* name : {"water_kinetic", "water_potential", "water_compression", "solid_kinetic", "solid_rotation",
                           "solid_potential", "total", "lost"}) {
    columns.push_back(name + unit);
  }
  return columns;
}

void EnergyMeasurement::add(FrameView& view, const RowSink& emit) {
  EnergyState e = measure_energy(view.frame(), info_);
  if (!first_) first_ = e;
  e.water_potential -= first_->water_potential;
  e.solid_potential -= first_->solid_potential;
  const auto sum = [](const EnergyState& s, double pot_w, double pot_s) {
    return s.water_kinetic + pot_w + s.water_compression + s.solid_kinetic + s.solid_rotation + pot_s;
  };
  const double total = sum(e, e.water_potential, e.solid_potential), at_first = sum(*first_, 0.0, 0.0);
  const double row[8] = {e.water_kinetic, e.water_potential, e.water_compression,
                         e.solid_kinetic, e.solid_rotation,  e.solid_potential,
                         total,           at_first - total};
  time_.push_back(view.time());
  std::vector<Cell> cells{view.time()};
  for (int k = 0; k < 8; ++k) {
    value_[k].push_back(row[k]);
    cells.push_back(row[k]);
  }
  emit(cells);
}

Figure EnergyMeasurement::figure() const {
  double largest = 0.0;
  for (const auto& column : value_) {
    for (const double v : column) largest = std::max(largest, std::abs(v));
  }
  const double exponent = largest > 0.0 ? 3.0 * std::floor(std::log10(largest) / 3.0) : 0.0;
  Panel panel;
  panel.title = "Energy budget, " + plain_text(info_.name);
  panel.note = "potential energies counted from the first frame; lost: the total missing since then";
  panel.x_label = "time t (s)";
  panel.y_label = "energy (10^{" + format_number(exponent) + "} " + (info_.dimensions == 2 ? "J/m)" : "J)");
  const char* names[8] = {"water, kinetic",
                          "water, potential",
                          "water, compression",
                          "solids, kinetic",
                          "solids, rotation",
                          "solids, potential",
                          "",
                          "lost"};
  for (int k = 0; k < 8; ++k) {
    if (k == 6 ||
        std::all_of(value_[k].begin(), value_[k].end(), [&](double v) { return std::abs(v) < 1e-4 * largest; }))
      continue;
    std::vector<double> scaled = value_[k];
    for (double& v : scaled) v *= std::pow(10.0, -exponent);
    panel.series.push_back({names[k], time_, std::move(scaled), {}, {}, MarkStyle::line, {}, k == 7 ? 6 : k});
  }
  Figure figure;
  figure.panel.push_back(std::move(panel));
  figure.width_mm = 180.0;
  figure.panel_height_mm = 95.0;
  return figure;
}

std::string EnergyMeasurement::summary() const {
  if (time_.empty()) return {};
  double kinetic = 0.0;
  for (const double v : value_[0]) kinetic = std::max(kinetic, v);
  // In the prefix of the largest: 54.6 GJ.
  const char* const prefix[] = {"", "k", "M", "G", "T", "P"};
  const double largest = std::max(kinetic, std::abs(value_[7].back()));
  const int order = largest >= 1e3 ? std::min(5, static_cast<int>(std::log10(largest) / 3.0)) : 0;
  const double unit = std::pow(10.0, 3 * order);
  char text[160];
  std::snprintf(text, sizeof text,
                "largest kinetic energy of the water %.3g %sJ, of the first total energy %.3g %sJ are lost at the end",
                kinetic / unit, prefix[order], value_[7].back() / unit, prefix[order]);
  return text;
}

}  // namespace gdesp::analysis
