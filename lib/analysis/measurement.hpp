// SPDX-License-Identifier: GPL-3.0-or-later
// What every command of surge-analyze that walks over frames is made of: a measurement takes one frame after the
// other, emits rows of its table, and at the end can draw itself and say its result in a sentence.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/connected_water.hpp"
#include "analysis/frame_source.hpp"
#include "analysis/free_surface.hpp"
#include "analysis/plot.hpp"
#include "analysis/run_info.hpp"
#include "analysis/table.hpp"

namespace gdesp::analysis {

/// One frame with what several measurements share, made when first asked for.
class FrameView {
 public:
  FrameView(const Frame& frame, const RunInfo& info) : frame_(frame), info_(info) {}
  const Frame& frame() const { return frame_; }
  const RunInfo& info() const { return info_; }
  double time() const { return frame_.time; }

  const ColumnGrid& grid();                                ///< all fluid particles
  const ConnectedWater& connected();                       ///< main body and splash
  ConnectedWater connected(const ConnectivityRule& rule);  ///< the same by another rule; not kept
  const FluidSampler& water();                             ///< the main body alone
  const FluidSampler& all_water();                         ///< splash included
  const std::vector<Vec3d>& main_positions();

 private:
  const Frame& frame_;
  const RunInfo& info_;
  std::unique_ptr<FluidSampler> all_, main_;
  std::optional<ConnectedWater> connected_;
  std::vector<Vec3d> main_positions_;
};

using RowSink = std::function<void(const std::vector<Cell>&)>;

class Measurement {
 public:
  virtual ~Measurement() = default;
  /// Before the first frame; returns the column names. Throws Error when the run lacks what is needed.
  virtual std::vector<std::string> begin(const RunInfo& info) = 0;
  virtual void add(FrameView& view, const RowSink& emit) = 0;
  virtual void finish(const RowSink&) {}
  virtual bool done() const { return false; }  ///< later frames change nothing
  virtual Figure figure() const = 0;
  virtual std::string summary() const { return {}; }
};

/// Runs measurements over all frames of a source in one pass. sinks[k] belongs to measurements[k].
/// `progress` is told the fraction done (0 when unknown); `stop` ends early.
void run_measurements(FrameSource& source, const std::vector<Measurement*>& measurements,
                      const std::vector<RowSink>& sinks, const std::function<void(double, double)>& progress = {},
                      const std::function<bool()>& stop = {});

/// Case coordinates to the scene's own.
inline Vec3d to_scene(const RunInfo& info, const Vec3d& p) { return p + info.offset; }

}  // namespace gdesp::analysis
