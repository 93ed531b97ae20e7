// SPDX-License-Identifier: GPL-3.0-or-later
// From a scene to a case: everything mesh2particles does, without files being written (but the boundary grid).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "geometry/boundary_layers.hpp"
#include "geometry/packing_settlement.hpp"
#include "geometry/scene_parts.hpp"
#include "geometry/water_fill.hpp"
#include "io/case.hpp"

namespace gdesp::geometry {

struct SlideReport {
  std::string name, kind;
  std::size_t grains = 0;
  double volume = 0.0;                ///< m3, of the body above the terrain
  double porosity = 0.0;              ///< reached (granular)
  double largest_overlap = 0.0;       ///< share of the diameter (granular)
  double mass = 0.0;                  ///< kg
  double seconds = 0.0;               ///< of packing
  std::optional<SettledBed> settled;  ///< granular, relaxation "gravity"
};

/// What was built, in numbers and words.
struct BuildReport {
  Notes notes;
  std::vector<FillReport> fills;
  std::vector<SlideReport> slides;
  std::size_t band_voxels = 0;
  std::vector<std::pair<std::string, double>> seconds;  ///< per stage
};

/// `counts_only`: grains are spread over their slide, as many as were asked for, but not moved apart.
enum class BuildScope { everything, counts_only };

struct BuildOptions {
  std::string vdb_path = {};                              ///< where boundary.vdb goes; empty: not written
  std::function<void(const std::string&)> on_stage = {};  ///< called with the name of each stage as it begins
  BuildScope scope = BuildScope::everything;
  GrainSettler settler = {};  ///< for slides with relaxation "gravity"
};

/// Builds the case. Throws Error(input), and what the settler throws.
Case build_case(const Scene& scene, BuildReport& report, const BuildOptions& options = {});

/// The part of build_case that needs no particles: parts in case coordinates, lattice, domain.
struct Layout {
  SceneParts parts;
  Scene scene;  ///< in case coordinates
  Vec3d offset;
  std::optional<double> surface;  ///< m, free and still, that all the water has in common
  Lattice lattice;
  Box domain;          ///< case coordinates
  WallSurfaces walls;  ///< exposed surface of everything at rest
};
Layout lay_out(const Scene& scene, Notes& notes);

/// Offset that brings large coordinates near zero: per axis, 0 unless the coordinates exceed twice the largest extent.
Vec3d choose_offset(const Box& box, int dimensions);

}  // namespace gdesp::geometry
