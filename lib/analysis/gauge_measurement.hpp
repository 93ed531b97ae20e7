// SPDX-License-Identifier: GPL-3.0-or-later
// `surge-analyze gauge`: water level and pressure at points against time, and when the wave arrives.
#pragma once

#include "analysis/measurement.hpp"

namespace gdesp::analysis {

struct GaugeOptions {
  std::vector<Gauge> gauges;  ///< scene coordinates; empty: the scene's own
  bool arrivals = false;      ///< print one row per gauge: arrival time, highest level, highest pressure
  double threshold = 0.0;     ///< m, departure that counts as arrival; 0: dp / 2
};

/// Level: the free surface over (x, y) of the connected water (free_surface.hpp), or of a far lake's column where one is. Pressure, where the gauge has a z: mean of
/// the particles' pressure weighted with W within 2.6 dp, each carried hydrostatically to the gauge's height.
/// Arrival: first departure of the level (of the pressure, where the gauge stands dry: never) by the threshold
/// from its first reading, linear between frames. A gauge that is dry at first: when it first is wet.
class GaugeMeasurement : public Measurement {
 public:
  explicit GaugeMeasurement(GaugeOptions options) : options_(std::move(options)) {}
  std::vector<std::string> begin(const RunInfo& info) override;
  void add(FrameView& view, const RowSink& emit) override;
  void finish(const RowSink& emit) override;
  Figure figure() const override;
  std::string summary() const override;

 private:
  std::optional<double> arrival(std::size_t gauge) const;

  GaugeOptions options_;
  RunInfo info_;
  std::vector<Gauge> gauge_;  // case coordinates
  double threshold_ = 0.0;
  std::vector<double> time_;
  std::vector<std::vector<double>> level_, pressure_;
};

/// "name=x,y" or "name=x,y,z" or "x,y[,z]"; throws Error(usage).
Gauge parse_gauge(const std::string& text, int number);

}  // namespace gdesp::analysis
