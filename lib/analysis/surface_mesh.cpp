// SPDX-License-Identifier: GPL-3.0-or-later
// The one file of the analysis that includes OpenVDB.
#include "analysis/surface_mesh.hpp"

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <unordered_set>

#include "analysis/closed_union.hpp"
#include "analysis/column_grid.hpp"
#include "analysis/smoothing.hpp"
#include "core/error.hpp"

namespace gdesp::analysis {
namespace {

constexpr double ball = 1.3;                    // radius in dp
constexpr double inwards = 0.72;                // in dp
constexpr double narrow = 1.5, standard = 3.0;  // half width of the band in voxels: for triangles, for a file

openvdb::FloatGrid::Ptr make_level_set(std::span<const Vec3d> position, const SurfaceOptions& options,
                                       double half_width) {
  openvdb::initialize();
  const double voxel = options.voxel > 0.0 ? options.voxel : 0.5 * options.dp;
  auto grid = openvdb::createLevelSet<openvdb::FloatGrid>(voxel, half_width);
  const float end = grid->background();
  using Leaf = openvdb::FloatTree::LeafNodeType;
  static_assert(Leaf::SIZE == std::tuple_size_v<decltype(VoxelTile::value)>);
  for (const VoxelTile& tile : closed_union(position, {voxel, ball * options.dp, inwards * options.dp, half_width})) {
    auto leaf = std::make_unique<Leaf>(openvdb::Coord(tile.first.x, tile.first.y, tile.first.z), end);
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
      if (std::abs(tile.value[i]) < end)
        leaf->setValueOn(i, tile.value[i]);
      else
        leaf->setValueOff(i, tile.value[i] < 0.0f ? -end : end);
    }
    grid->tree().addLeaf(leaf.release());
  }
  openvdb::tools::signedFloodFill(grid->tree());  // the inside, too
  grid->setName("surface");
  return grid;
}

// The particles in cells of 2h that touch a vertex's own: those that its mean needs.
std::vector<std::uint32_t> near_surface(const std::vector<Vec3d>& vertex, std::span<const Vec3d> position,
                                        double cell) {
  const auto key = [&](const Vec3d& p, int dx, int dy, int dz) {
    const auto part = [&](double x, int d) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / cell)) + d + (1 << 20));
    };
    return part(p.x, dx) << 42 | part(p.y, dy) << 21 | part(p.z, dz);
  };
  std::unordered_set<std::uint64_t> own, cells;
  for (const Vec3d& v : vertex) {
    if (!own.insert(key(v, 0, 0, 0)).second) continue;
    for (int n = 0; n < 27; ++n) cells.insert(key(v, n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1));
  }
  std::vector<std::uint8_t> needed(position.size());
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < position.size(); ++i) needed[i] = cells.contains(key(position[i], 0, 0, 0));
  std::vector<std::uint32_t> result;
  for (std::size_t i = 0; i < position.size(); ++i)
    if (needed[i]) result.push_back(static_cast<std::uint32_t>(i));
  return result;
}

// Velocity at each vertex: mean of the particles within 2h weighted with W.
std::vector<Vec3f> sample_velocity(const std::vector<Vec3d>& vertex, std::span<const Vec3d> position,
                                   std::span<const Vec3f> velocity, double dp) {
  const double h = smoothing_ratio * dp;
  const std::vector<std::uint32_t> chosen = near_surface(vertex, position, 2.0 * h);
  std::vector<Vec3d> near;
  near.reserve(chosen.size());
  for (const std::uint32_t i : chosen) near.push_back(position[i]);
  const ColumnGrid grid(near, 2.0 * h, 3);
  std::vector<Vec3f> result(vertex.size());
#pragma omp parallel for schedule(dynamic, 1024)
  for (std::size_t k = 0; k < vertex.size(); ++k) {
    const Vec3d& v = vertex[k];
    Vec3d sum;
    double weight = 0.0;
    grid.for_each(v.x, v.y, v.z - 2.0 * h, v.z + 2.0 * h, [&](std::size_t s, double r2) {
      const double dz = v.z - grid.position(s).z;
      const double w = wendland_shape((r2 + dz * dz) / (h * h));
      sum += Vec3d(velocity[chosen[grid.index(s)]]) * w;
      weight += w;
    });
    if (weight > 0.0) result[k] = Vec3f(sum * (1.0 / weight));
  }
  return result;
}

}  // namespace

SurfaceMesh extract_surface(std::span<const Vec3d> position, std::span<const Vec3f> velocity,
                            const SurfaceOptions& options) {
  const auto grid = make_level_set(position, options, narrow);
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*grid, points, triangles, quads, 0.0, 0.0);
  SurfaceMesh mesh;
  mesh.vertex.reserve(points.size());
  mesh.triangle.reserve(triangles.size() + 2 * quads.size());
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
  const auto grid = make_level_set(position, options, standard);
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
