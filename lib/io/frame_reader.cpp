// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/error.hpp"
#include "io/frame.hpp"
#include "io/tables.hpp"

namespace gdesp {

std::unique_ptr<PointSource> open_points(const std::string& path) {
  if (path.ends_with(".vtp")) {
    std::unique_ptr<PointSource> plain = open_plain_vtp(path);
    return plain ? std::move(plain) : open_with_vtk(path);
  }
  if (path.ends_with(".vtu") || path.ends_with(".vtk")) return open_with_vtk(path);
  if (path.ends_with(".vdb")) return open_vdb_points(path);
  throw Error(ErrorKind::input, path + ": particles are read from .vtp, .vtu, .vtk and .vdb files");
}

FluidTable read_fluid_frame(const std::string& path, const std::vector<FieldMapping>& mapping, FrameMeta* meta) {
  const std::unique_ptr<PointSource> source = open_points(path);
  if (meta) *meta = meta_of(*source);
  return fluid_of(*source, path, mapping);
}

GrainTable read_grain_frame(const std::string& path, const std::vector<FieldMapping>& mapping, FrameMeta* meta) {
  const std::unique_ptr<PointSource> source = open_points(path);
  if (meta) *meta = meta_of(*source);
  return grains_of(*source, path, mapping);
}

TriangleTable read_triangles_vtp(const std::string& path) { return triangles_of(*open_points(path), path); }

namespace {

std::vector<FarLakeTable> far_lakes_of(const PointSource& source, const std::string& path) {
  const std::vector<double> count = source.field("far_lake_columns"), x = source.field("far_lake_x"),
                            level = source.field("far_lake_level"), velocity = source.field("far_lake_velocity");
  std::vector<FarLakeTable> lakes;
  std::size_t at = 0;
  for (const double n : count) {
    if (!(n >= 0.0) || n > static_cast<double>(x.size() - at) || x.size() != level.size() ||
        x.size() != velocity.size())
      throw Error(ErrorKind::input, path + ": the fields far_lake_* do not belong together");
    const auto begin = static_cast<std::ptrdiff_t>(at), end = begin + static_cast<std::ptrdiff_t>(n);
    lakes.push_back({{x.begin() + begin, x.begin() + end},
                     {level.begin() + begin, level.begin() + end},
                     {velocity.begin() + begin, velocity.begin() + end}});
    at = static_cast<std::size_t>(end);
  }
  return lakes;
}

}  // namespace

void read_bodies_frame(const std::string& path, Frame& frame) {
  const std::unique_ptr<PointSource> source = open_points(path);
  frame.bodies = triangles_of(*source, path);
  frame.far_lakes = far_lakes_of(*source, path);
}

std::vector<BodyState> read_body_states(const std::string& path) {
  const std::unique_ptr<PointSource> source = open_points(path);
  const std::vector<double> centre = source->field("body_centre"), velocity = source->field("body_velocity"),
                            spin = source->field("body_angular_velocity"),
                            orientation = source->field("body_orientation"), force = source->field("body_force"),
                            torque = source->field("body_torque");
  const std::size_t bodies = centre.size() / 3;
  if (centre.size() != 3 * bodies || velocity.size() != 3 * bodies || spin.size() != 3 * bodies ||
      orientation.size() != 4 * bodies)
    throw Error(ErrorKind::input, path + ": the fields body_* do not belong together");
  std::vector<BodyState> states(bodies);
  for (std::size_t i = 0; i < bodies; ++i) {
    states[i].centre = {centre[3 * i], centre[3 * i + 1], centre[3 * i + 2]};
    states[i].velocity = {velocity[3 * i], velocity[3 * i + 1], velocity[3 * i + 2]};
    states[i].angular_velocity = {spin[3 * i], spin[3 * i + 1], spin[3 * i + 2]};
    for (std::size_t k = 0; k < 4; ++k) states[i].orientation[k] = orientation[4 * i + k];
    if (force.size() == 3 * bodies) states[i].force = {force[3 * i], force[3 * i + 1], force[3 * i + 2]};
    if (torque.size() == 3 * bodies) states[i].torque = {torque[3 * i], torque[3 * i + 1], torque[3 * i + 2]};
  }
  return states;
}

}  // namespace gdesp
