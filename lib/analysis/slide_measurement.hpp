// SPDX-License-Identifier: GPL-3.0-or-later
// `surge-analyze slide`: centre of mass, front, velocity and submerged share of the slide against time.
#pragma once

#include "analysis/measurement.hpp"
#include "analysis/slide_state.hpp"

namespace gdesp::analysis {

struct SlideOptions {
  std::optional<Vec3d> direction;  ///< of the front; default: from the slide to the lake's middle, else x
  double fraction = 0.001;         ///< of the slide's volume that lies beyond its front
};

class SlideMeasurement : public Measurement {
 public:
  explicit SlideMeasurement(SlideOptions options) : options_(options) {}
  std::vector<std::string> begin(const RunInfo& info) override;
  void add(FrameView& view, const RowSink& emit) override;
  Figure figure() const override;
  std::string summary() const override;

 private:
  SlideOptions options_;
  RunInfo info_;
  Vec3d direction_{1, 0, 0};
  std::optional<double> first_front_;
  std::optional<Vec3d> last_centre_;
  double last_time_ = 0.0;
  std::vector<double> time_, speed_, travel_, depth_, submerged_;
};

}  // namespace gdesp::analysis
