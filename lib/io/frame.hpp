// SPDX-License-Identifier: GPL-3.0-or-later
// A frame: the state at one time, as gdesp-run writes it and surge-analyze reads it (docs/formats/frames.md).
// A run folder holds case.link (the case's absolute path), frames/fluid_00012.vtp, grains_00012.vtp,
// bodies_00012.vtp (moved surfaces), fluid.pvd grains.pvd bodies.pvd, log.ndjson, run.json.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "particles/particle_tables.hpp"

namespace gdesp {

/// `force` (N) and `torque` (N m, about the centre): on a free body, of all but gravity; on another, of the water.
struct BodyState {
  Vec3d centre, velocity, angular_velocity;
  double orientation[4] = {1, 0, 0, 0};
  Vec3d force, torque;
};

struct Frame {
  double time = 0.0;  ///< s
  std::int64_t step = 0;
  FluidTable fluid;
  GrainTable grains;
  TriangleTable bodies;  ///< surfaces of moving bodies, at their place now
  std::vector<BodyState> body_states;
  std::vector<FarLakeTable> far_lakes;
};

/// Where one frame's parts lie; empty where there is no such part.
struct FramePaths {
  std::string fluid, grains, bodies;
  double time = 0.0;
  std::int64_t step = 0;
};

/// Writes frames of one run, each part aside and renamed when complete, and keeps the .pvd series up to date.
/// VTP, inline binary, which every ParaView reads. Field names: velocity, density, pressure, porosity, id;
/// diameter, angular_velocity, group. Positions: case coordinates, float64 (ParaView shows the offset in field data).
class FrameWriter {
 public:
  /// `offset` goes into each file as field data, with the time and dp. A folder that holds something is refused
  /// (Error(usage)) unless `force` (an earlier run's frames are removed) or `resume` (frames go on after those
  /// there; one that is as late as a new frame gives way to it).
  FrameWriter(std::string run_folder, Vec3d offset, double dp, bool force, bool resume);
  FramePaths write(const Frame& frame);
  const std::string& folder() const { return folder_; }

 private:
  std::string folder_;
  Vec3d offset_;
  double dp_;
  int next_ = 0;
  std::vector<FramePaths> written_;
};

/// Maps this project's field names to another program's: {"velocity", "Vel"}.
struct FieldMapping {
  std::string ours, theirs;
};

/// What a particle file says beside its particles.
struct FrameMeta {
  double time = 0.0;
  double dp = 0.0;
  Vec3d offset;
  bool has_time = false;
};

/// Reads fluid (or grain) particles from VTP, VTU, legacy VTK or an OpenVDB points file, own or foreign.
FluidTable read_fluid_frame(const std::string& path, const std::vector<FieldMapping>& mapping, FrameMeta* meta);
GrainTable read_grain_frame(const std::string& path, const std::vector<FieldMapping>& mapping, FrameMeta* meta);
TriangleTable read_triangles_vtp(const std::string& path);
/// Moving surfaces and far lakes of a bodies_*.vtp frame. Throws Error(input).
void read_bodies_frame(const std::string& path, Frame& frame);

/// The frames of a finished or running run folder, in time order.
std::vector<FramePaths> list_frames(const std::string& run_folder);
/// The case a run belongs to (absolute path).
std::string run_case_path(const std::string& run_folder);
/// Writes case.link into the run folder, so that run_case_path finds the case.
void write_run_case_path(const std::string& run_folder, const std::string& case_path);
/// States of the moving bodies in a bodies_*.vtp frame; empty when the file has none.
std::vector<BodyState> read_body_states(const std::string& path);

}  // namespace gdesp
