// SPDX-License-Identifier: GPL-3.0-or-later
// The one file of the analysis that includes OpenVDB.
#include "analysis/surface_mesh.hpp"

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/FastSweeping.h>
#include <openvdb/tools/Filter.h>
#include <openvdb/tools/ParticlesToLevelSet.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <algorithm>
#include <filesystem>

#include "analysis/column_grid.hpp"
#include "analysis/free_surface.hpp"
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

// The fluid fraction at every particle tells the two layers next to a surface (below 0.985) from the inside.
struct Parts { std::vector<Vec3d> shell, inside; };

Parts split(std::span<const Vec3d> position, double dp) {
  const FluidSampler sampler(position, {}, dp, 3);
  const ColumnGrid& grid = sampler.grid();
  std::vector<std::uint8_t> deep(position.size());
#pragma omp parallel for schedule(dynamic, 1024)
  for (std::size_t s = 0; s < position.size(); ++s) deep[s] = sampler.fluid_fraction(grid.position(s)) > 0.985;
  Parts parts;
  for (std::size_t s = 0; s < position.size(); ++s) (deep[s] ? parts.inside : parts.shell).push_back(grid.position(s));
  return parts;
}

// Everything around a particle of the inside is water, far from any surface: no balls, no narrow band there.
void fill_inside(openvdb::FloatGrid& grid, const std::vector<Vec3d>& inside, double dp) {
  auto voxels = grid.getAccessor();
  const double reach = 0.75 * dp / grid.voxelSize()[0];
  const auto corner = [](const openvdb::Vec3d& c) {  // the first voxel at or above
    return openvdb::Coord(openvdb::math::Ceil(c.x()), openvdb::math::Ceil(c.y()), openvdb::math::Ceil(c.z()));
  };
  for (const Vec3d& p : inside) {
    const openvdb::Vec3d c = grid.worldToIndex(openvdb::Vec3d(p.x, p.y, p.z));
    const openvdb::Coord low = corner(c - openvdb::Vec3d(reach)), end = corner(c + openvdb::Vec3d(reach));
    for (int x = low.x(); x < end.x(); ++x) {
      for (int y = low.y(); y < end.y(); ++y) {
        for (int z = low.z(); z < end.z(); ++z) voxels.setValueOff({x, y, z}, -grid.background());
      }
    }
  }
}

openvdb::FloatGrid::Ptr make_level_set(std::span<const Vec3d> position, const SurfaceOptions& options) {
  openvdb::initialize();
  const double voxel = options.voxel > 0.0 ? options.voxel : 0.5 * options.dp;
  auto grid = openvdb::createLevelSet<openvdb::FloatGrid>(voxel, half_width);
  if (position.empty()) return grid;
  const Parts parts = split(position, options.dp);
  openvdb::tools::ParticlesToLevelSet<openvdb::FloatGrid> raster(*grid);
  raster.setRmin(0.5);
  raster.rasterizeSpheres(ParticleList{parts.shell}, ball * options.dp);
  raster.finalize(false);
  fill_inside(*grid, parts.inside, options.dp);
  openvdb::tools::pruneLevelSet(grid->tree());
  // Inside, the least distance to a ball's surface is not the distance to the union's: made so by fast sweeping
  // (Zhao 2005, Math. Comput. 74, 603, doi 10.1090/S0025-5718-04-01678-3), so that moving inwards closes gaps.
  grid = openvdb::tools::sdfToSdf(*grid, 0.0f, 1);
  openvdb::tools::Filter<openvdb::FloatGrid>(*grid).mean(1);
  // Inwards: every value grows by the same length; beyond the band it stays the band's end.
  const float inwards = static_cast<float>((ball - 0.5) * options.dp), end = grid->background();
  openvdb::tools::foreach(grid->beginValueOn(), [=](const openvdb::FloatGrid::ValueOnIter& it) {
    it.setValue(std::clamp(*it + inwards, -end, end));
  });
  grid->setName("surface");
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
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
