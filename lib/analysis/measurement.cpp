// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/measurement.hpp"

namespace gdesp::analysis {

const FluidSampler& FrameView::all_water() {
  if (!all_) {
    all_ = std::make_unique<FluidSampler>(frame_.fluid.position, frame_.fluid.porosity, info_.dp, info_.dimensions);
  }
  return *all_;
}

const ColumnGrid& FrameView::grid() { return all_water().grid(); }

const ConnectedWater& FrameView::connected() {
  if (!connected_) connected_ = connected(ConnectivityRule{});
  return *connected_;
}

ConnectedWater FrameView::connected(const ConnectivityRule& rule) {
  const float rest = static_cast<float>(info_.fluid_density());
  std::vector<float> relative;
  if (info_.has_case && frame_.fluid.density.size() == frame_.fluid.position.size()) {
    relative = frame_.fluid.density;
    for (float& r : relative) r /= rest;
  }
  return find_connected_water(grid(), info_.dp, rule, relative);
}

const std::vector<Vec3d>& FrameView::main_positions() {
  if (main_positions_.empty()) {
    const ConnectedWater& c = connected();
    main_positions_.reserve(c.main_count);
    for (std::size_t i = 0; i < c.main.size(); ++i) {
      if (c.main[i]) main_positions_.push_back(frame_.fluid.position[i]);
    }
  }
  return main_positions_;
}

const FluidSampler& FrameView::water() {
  const ConnectedWater& c = connected();
  if (c.main_count == c.main.size()) return all_water();
  if (!main_) {
    std::vector<float> porosity;
    if (frame_.fluid.porosity.size() == c.main.size()) {
      for (std::size_t i = 0; i < c.main.size(); ++i) {
        if (c.main[i]) porosity.push_back(frame_.fluid.porosity[i]);
      }
    }
    main_ = std::make_unique<FluidSampler>(main_positions(), porosity, info_.dp, info_.dimensions);
  }
  return *main_;
}

void run_measurements(FrameSource& source, const std::vector<Measurement*>& measurements,
                      const std::vector<RowSink>& sinks, const std::function<void(double, double)>& progress,
                      const std::function<bool()>& stop) {
  std::size_t count = 0;
  while (const auto frame = source.next(stop)) {
    FrameView view(*frame, source.info());
    bool all_done = true;
    for (std::size_t k = 0; k < measurements.size(); ++k) {
      if (!measurements[k]->done()) measurements[k]->add(view, sinks[k]);
      all_done = all_done && measurements[k]->done();
    }
    if (all_done) break;
    ++count;
    const double total = static_cast<double>(source.expected());
    if (progress) progress(total > 0.0 ? static_cast<double>(count) / total : 0.0, frame->time);
    if (stop && stop()) break;
  }
  for (std::size_t k = 0; k < measurements.size(); ++k) measurements[k]->finish(sinks[k]);
}

}  // namespace gdesp::analysis
