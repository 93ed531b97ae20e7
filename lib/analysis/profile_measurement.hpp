// SPDX-License-Identifier: GPL-3.0-or-later
// `surge-analyze profile`: the surface along a line at given times; of the water, and of the slide.
#pragma once

#include "analysis/measurement.hpp"
#include "analysis/wall_surface.hpp"

namespace gdesp::analysis {

struct ProfileOptions {
  std::string section;          ///< of the scene; empty and no line: the domain's middle line along x
  std::optional<Section> line;  ///< scene coordinates
  double step = 0.0;            ///< m; 0: dp
  std::vector<double> times;    ///< s; empty: every frame
  bool solids = true;           ///< the slide's surface too
};

/// Two-dimensional runs: the line is the x axis over the fluid and the slide.
/// Solids: top of the grains, the highest point of a sphere over (x, y), of those within half a diameter of the
/// section's plane strip of width dp (or the largest grain); rigid bodies: the highest triangle over the point.
class ProfileMeasurement : public Measurement {
 public:
  explicit ProfileMeasurement(ProfileOptions options) : options_(std::move(options)) {}
  std::vector<std::string> begin(const RunInfo& info) override;
  void add(FrameView& view, const RowSink& emit) override;
  void finish(const RowSink& emit) override;
  bool done() const override { return !options_.times.empty() && next_time_ >= options_.times.size(); }
  Figure figure() const override;
  std::string summary() const override;

  struct Curve {
    double time = 0.0;
    std::vector<double> water, solids;
  };
  const std::vector<Curve>& curves() const { return curve_; }
  const std::vector<double>& distance() const { return distance_; }

 private:
  void choose_line();
  Curve measure(FrameView& view) const;
  std::optional<Panel> above_still_water(std::size_t shown, double range) const;
  void emit_curve(const Curve& curve, const RowSink& emit) const;

  ProfileOptions options_;
  RunInfo info_;
  Section line_;  // case coordinates
  std::vector<double> distance_, bed_;
  std::vector<Point2> point_;
  std::vector<Curve> curve_;
  std::optional<Curve> last_;  // the frame before, to pick the nearest to a wanted time
  std::size_t next_time_ = 0;
  std::optional<double> late_;  // a wanted time past the last frame
};

/// Height of the highest sphere surface over each point; NaN where none. `reach` m: grains' horizontal distance.
std::vector<double> top_of_grains(const GrainTable& grains, const std::vector<Point2>& point, int dimensions);

}  // namespace gdesp::analysis
