// SPDX-License-Identifier: GPL-3.0-or-later
// A case: what mesh2particles writes and gdesp-run reads, a folder of files that other programs open
// (docs/formats/case.md draws it). Positions are scene coordinates minus `offset`.
#pragma once

#include <string>
#include <vector>

#include "particles/particle_tables.hpp"
#include "scene/scene.hpp"

namespace gdesp {

struct SourceFile {
  std::string path, sha256;
};

struct Case {
  Scene scene;
  Vec3d offset;                    ///< m; scene coordinates = case coordinates + offset
  Box domain;                      ///< case coordinates; particles that leave it are reported as lost
  double still_water_level = 0.0;  ///< m, case coordinates (the highest fill's level)
  double terrain_top = 0.0;        ///< m, case coordinates
  FluidTable fluid;
  BoundaryTable boundary;
  GrainTable grains;
  TriangleTable walls;  ///< what grains collide with, and what pictures show; bodies included
  std::vector<Body> bodies;
  std::vector<SourceFile> sources;
};

/// Writes the folder `path` aside and renames it when complete. Refuses to overwrite unless `force`.
/// fluid.vtp boundary.vtp grains.vtp walls.vtp bodies.vtp case.toml (boundary.vdb is the voxeliser's own).
/// `extra_files`: files already made elsewhere, moved in under their base names.
void write_case(const std::string& path, const Case& c, bool force, const std::vector<std::string>& extra_files = {});

/// Reads a folder written by write_case; `overrides` change scene keys that need no new particles
/// (time.*, numerics.*, coupling.*, contact.*, economy.*, fluid.kinematic_viscosity): others are errors that say so.
/// Checks sizes, finiteness and body numbers; throws Error(input).
Case read_case(const std::string& path, const std::vector<Override>& overrides = {});

}  // namespace gdesp
