// SPDX-License-Identifier: GPL-3.0-or-later
// The one file of the analysis that includes OpenVDB.
#include "analysis/surface_mesh.hpp"

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetFilter.h>
#include <openvdb/tools/ParticlesToLevelSet.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <filesystem>

#include "analysis/column_grid.hpp"
#include "analysis/smoothing.hpp"
#include "core/error.hpp"

namespace gdesp::analysis {
namespace {

constexpr double ball = 1.3;       // radius in dp
constexpr double half_width = 3.0; // of the narrow band, in voxels

/// What ParticlesToLevelSet asks of a list of particles.
struct ParticleList {
  using PosType = openvdb::Vec3R;
  std::span<const Vec3d> position;
  std::size_t size() const { return position.size(); }
  void getPos(std::size_t n, PosType& p) const { p = PosType(position[n].x, position[n].y, position[n].z); }
};

openvdb::FloatGrid::Ptr make_level_set(std::span<const Vec3d> position, const SurfaceOptions& options) {
  openvdb::initialize();
  const double voxel = options.voxel > 0.0 ? options.voxel : 0.5 * options.dp;
  auto grid = openvdb::createLevelSet<openvdb::FloatGrid>(voxel, half_width);
  grid->setName("surface");
  if (position.empty()) return grid;
  openvdb::tools::ParticlesToLevelSet<openvdb::FloatGrid> raster(*grid);
  raster.setRmin(0.5);
  raster.rasterizeSpheres(ParticleList{position}, ball * options.dp);
  raster.finalize(true);
  openvdb::tools::LevelSetFilter<openvdb::FloatGrid> filter(*grid);
  filter.mean(1);
  filter.offset(static_cast<float>((ball - 0.5) * options.dp));
  return grid;
}

// Velocity at each vertex: mean of the particles within 2h weighted with W.
std::vector<Vec3f> sample_velocity(const std::vector<Vec3d>& vertex, std::span<const Vec3d> position,
                                   std::span<const Vec3f> velocity, double dp) {
  const double h = smoothing_ratio * dp;
  const ColumnGrid grid(position, 2.0 * h, 3);
  std::vector<Vec3f> result(vertex.size());
#pragma omp parallel for schedule(dynamic, 1024)
  for (std::size_t k = 0; k < vertex.size(); ++k) {
    const Vec3d& v = vertex[k];
    Vec3d sum;
    double weight = 0.0;
    grid.for_each(v.x, v.y, v.z - 2.0 * h, v.z + 2.0 * h, [&](std::size_t s, double r2) {
      const double dz = v.z - grid.position(s).z;
      const double w = wendland_shape((r2 + dz * dz) / (h * h));
      sum += Vec3d(velocity[grid.index(s)]) * w;
      weight += w;
    });
    if (weight > 0.0) result[k] = Vec3f(sum * (1.0 / weight));
  }
  return result;
}

}  // namespace

SurfaceMesh extract_surface(std::span<const Vec3d> position, std::span<const Vec3f> velocity,
                            const SurfaceOptions& options) {
  const auto grid = make_level_set(position, options);
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*grid, points, triangles, quads, 0.0, 0.0);
  SurfaceMesh mesh;
  mesh.vertex.reserve(points.size());
  for (const auto& p : points) mesh.vertex.push_back({p.x(), p.y(), p.z()});
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {  // OpenVDB turns the other way round
    mesh.triangle.push_back({static_cast<std::int32_t>(a), static_cast<std::int32_t>(c), static_cast<std::int32_t>(b)});
  };
  for (const auto& t : triangles) add(t[0], t[1], t[2]);
  for (const auto& q : quads) {
    add(q[0], q[1], q[2]);
    add(q[0], q[2], q[3]);
  }
  if (velocity.size() == position.size() && !velocity.empty()) {
    mesh.velocity = sample_velocity(mesh.vertex, position, velocity, options.dp);
  }
  return mesh;
}

void write_surface_vdb(std::span<const Vec3d> position, const SurfaceOptions& options, const Vec3d& offset, double time,
                       const std::string& path) {
  const auto grid = make_level_set(position, options);
  grid->transform().postTranslate(openvdb::Vec3d(offset.x, offset.y, offset.z));
  grid->insertMeta("time", openvdb::DoubleMetadata(time));
  grid->insertMeta("dp", openvdb::DoubleMetadata(options.dp));
  const std::string aside = path + ".part";
  try {
    openvdb::io::File(aside).write({grid});
    std::filesystem::rename(aside, path);
  } catch (const std::exception& problem) {
    std::error_code ignored;
    std::filesystem::remove(aside, ignored);
    throw Error(ErrorKind::resource, path + ": cannot be written: " + problem.what());
  }
}

double enclosed_volume(const SurfaceMesh& mesh) {
  double six = 0.0;
  for (const auto& t : mesh.triangle) six += dot(mesh.vertex[t.x], cross(mesh.vertex[t.y], mesh.vertex[t.z]));
  return six / 6.0;
}

}  // namespace gdesp::analysis
