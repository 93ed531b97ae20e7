// SPDX-License-Identifier: GPL-3.0-or-later
// `surge-analyze front`: the leading edges of water and solids against time, and as x*, t*.
#pragma once

#include "analysis/measurement.hpp"

namespace gdesp::analysis {

struct FrontOptions {
  Vec3d direction{1, 0, 0};      ///< unit
  double fraction = 0.001;       ///< of the fill, beyond the front
  double scale_length = 0.0;     ///< m; 0: height of the water at the start
  std::optional<double> origin;  ///< m, scene coordinates along the direction; default: the water's edge at the start
  std::string reference;         ///< CSV or TSV with t* and x*, drawn into the plot
  std::string reference_t = "t_star", reference_x = "x_star";
};

/// x* = (x - origin) / L and t* = t sqrt(g / L), the scales of Lobovsky et al. 2014 (J. Fluids Struct. 48, 407,
/// doi 10.1016/j.jfluidstructs.2014.03.009), L the height of the water column; that is also t* of the paper's Fig. A7.
class FrontMeasurement : public Measurement {
 public:
  explicit FrontMeasurement(FrontOptions options) : options_(std::move(options)) {}
  std::vector<std::string> begin(const RunInfo& info) override;
  void add(FrameView& view, const RowSink& emit) override;
  Figure figure() const override;
  std::string summary() const override;

 private:
  FrontOptions options_;
  RunInfo info_;
  double scale_ = 1.0, origin_ = 0.0;                // origin along the direction, case coordinates
  std::vector<double> time_, water_, tip_, solids_;  // m from the origin
};

/// Parses "x", "-x", "y", "-y" or "nx,ny" to a unit vector; throws Error(usage).
Vec3d parse_direction(const std::string& text);

/// Volumes (m3; m2 in two dimensions) of grains: pi d^3/6 or pi d^2/4.
std::vector<double> grain_volumes(const GrainTable& grains, int dimensions);

}  // namespace gdesp::analysis
