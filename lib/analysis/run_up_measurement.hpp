// SPDX-License-Identifier: GPL-3.0-or-later
// `surge-analyze runup`: climb height against time per bank or region, and its maximum along the shore.
#pragma once

#include "analysis/measurement.hpp"
#include "analysis/wall_surface.hpp"

namespace gdesp::analysis {

struct RunUpOptions {
  bool along_shore = false;  ///< the table by place instead of by time
  std::string section;       ///< the line along which places are counted; empty: chosen
  std::string region;        ///< for the table along the shore; empty: far bank, or the first of the scene
  double bin = 0.0;          ///< m; 0: 4 dp
  RunUpRule rule;
};

class RunUpMeasurement : public Measurement {
 public:
  explicit RunUpMeasurement(RunUpOptions options) : options_(std::move(options)) {}
  std::vector<std::string> begin(const RunInfo& info) override;
  void add(FrameView& view, const RowSink& emit) override;
  void finish(const RowSink& emit) override;
  Figure figure() const override;
  std::string summary() const override;

  /// The highest reading of each region over all frames.
  struct Maximum {
    std::string region;
    double height = 0.0, time = 0.0;
    Vec3d at;
    bool climbs = false;
  };
  const std::vector<Maximum>& maxima() const { return maximum_; }
  const ShoreProfile& shore() const { return *profile_; }
  std::size_t most_torn() const {
    return most_torn_;
  }  ///< largest number of torn particles in a frame (connected_water.hpp)

 private:
  void choose_line();
  Panel against_time() const;
  Panel along_shore() const;

  RunUpOptions options_;
  RunInfo info_;
  double still_ = 0.0;
  WallSurface walls_;
  std::vector<BankRegion> regions_;
  std::size_t profile_region_ = 0;
  Section line_;  // case coordinates
  std::optional<ShoreProfile> profile_;
  std::vector<double> time_;
  std::vector<std::vector<double>> height_, splash_;  // per region
  std::vector<Maximum> maximum_;
  std::size_t most_torn_ = 0;
};

}  // namespace gdesp::analysis
