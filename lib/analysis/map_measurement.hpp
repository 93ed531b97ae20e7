// SPDX-License-Identifier: GPL-3.0-or-later
// `surge-analyze map`: what the wave reached, in the terrain's own coordinates.
//
// Definitions, per cell of a raster:
//   level_max   highest free surface seen over the cell, m (elevation);
//   depth_max   highest level minus the ground, m; cells that were ever wet;
//   arrival     first time at which the level departs by the threshold from its first reading, or at which a
//               dry cell has become wet, s; not known where the water stood still;
//   run-up line outline of the cells that were ever wet by more than the threshold of depth.
#pragma once

#include "analysis/measurement.hpp"

namespace gdesp::analysis {

struct MapOptions {
  double cell = 0.0;       ///< m; 0: dp
  double threshold = 0.0;  ///< m, for arrival and wet; 0: dp / 2
};

/// A line of the run-up: case coordinates, z on the ground.
using GroundLine = std::vector<Vec3d>;

class MapMeasurement : public Measurement {
 public:
  explicit MapMeasurement(MapOptions options) : options_(options) {}
  std::vector<std::string> begin(const RunInfo& info) override;
  void add(FrameView& view, const RowSink& emit) override;
  void finish(const RowSink& emit) override;  ///< one row per map: range and wet area
  Figure figure() const override;
  std::string summary() const override;

  const Raster& ground() const { return ground_; }
  const Raster& level_max() const { return level_; }
  const Raster& depth_max() const { return depth_; }
  const Raster& arrival() const { return arrival_; }
  std::vector<GroundLine> run_up_lines() const;
  const RunInfo& info() const { return info_; }

 private:
  std::vector<double> contour_levels() const;

  MapOptions options_;
  RunInfo info_;
  double threshold_ = 0.0, last_time_ = 0.0;
  Raster ground_, first_, level_, depth_, arrival_, last_departure_;
  bool any_ = false;
};

/// Lines along which a raster passes `value` (NaN counts as below), by marching squares, chained; raster coordinates.
std::vector<std::vector<Point2>> contour_lines(const Raster& raster, double value);

}  // namespace gdesp::analysis
