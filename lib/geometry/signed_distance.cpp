// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/signed_distance.hpp"

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/error.hpp"

namespace gdesp::geometry {
namespace {

/// The mesh in the lattice's index space, as openvdb::tools::meshToVolume wants it.
class IndexSpaceMesh {
 public:
  IndexSpaceMesh(const TriangleMesh& mesh, const Lattice& lattice) : mesh_(mesh), lattice_(lattice) {}
  std::size_t polygonCount() const { return mesh_.triangle.size(); }
  std::size_t pointCount() const { return mesh_.vertex.size(); }
  std::size_t vertexCount(std::size_t) const { return 3; }
  void getIndexSpacePoint(std::size_t t, std::size_t c, openvdb::Vec3d& p) const {
    const Vec3d& v = mesh_.vertex[mesh_.triangle[t][static_cast<int>(c)]];
    const double inverse = 1.0 / lattice_.dp;
    p = {(v.x - lattice_.origin.x) * inverse - 0.5, (v.y - lattice_.origin.y) * inverse - 0.5,
         (v.z - lattice_.origin.z) * inverse - 0.5};
  }

 private:
  const TriangleMesh& mesh_;
  const Lattice& lattice_;
};

bool within(const Index3& a, const Index3& lower, const Index3& upper) {
  return a.x >= lower.x && a.y >= lower.y && a.z >= lower.z && a.x <= upper.x && a.y <= upper.y && a.z <= upper.z;
}

bool is_solid(const BandRequest& r, const Index3& at) {
  const int i = at.x - r.columns.i0, j = at.y - r.columns.j0;
  if (i < 0 || j < 0 || i >= r.columns.grid.nx || j >= r.columns.grid.ny) return false;
  return r.solid->contains(r.columns.grid.index(i, j), r.lattice.coordinate(2, at.z));
}

/// Distance, normal and sign at one lattice point from its nearest triangle.
BandPoint measure(const WallSurfaces& walls, const BandRequest& r, const Index3& at, std::int32_t triangle) {
  const auto& t = walls.mesh.triangle[triangle];
  const Vec3d &a = walls.mesh.vertex[t.x], &b = walls.mesh.vertex[t.y], &c = walls.mesh.vertex[t.z];
  const Vec3d p = r.lattice.point(at), away = p - closest_point(p, a, b, c);
  const double distance = norm(away), sign = is_solid(r, at) ? -1.0 : 1.0;
  Vec3d normal = away * (sign / std::max(distance, 1e-300));
  if (distance < 1e-6 * r.lattice.dp) {
    const Vec3d n = cross(b - a, c - a);
    normal = n * (1.0 / std::max(norm(n), 1e-300));
  }
  // A point on the surface itself keeps the side that the columns gave it.
  const double apart = std::max(distance, 1e-6 * r.lattice.dp);
  return {at, static_cast<float>(sign * apart), static_cast<Vec3f>(normal), walls.material[triangle]};
}

void write_grids(const std::string& path, const std::vector<BandPoint>& band, const BandRequest& r, const Vec3d& offset) {
  const auto background = static_cast<float>(r.half_width * r.lattice.dp);
  auto distance = openvdb::FloatGrid::create(background);
  auto material = openvdb::Int32Grid::create(0);
  {
    auto d = distance->getAccessor();
    auto m = material->getAccessor();
    for (const auto& b : band) {
      d.setValue({b.at.x, b.at.y, b.at.z}, b.distance);
      m.setValue({b.at.x, b.at.y, b.at.z}, b.material);
    }
  }
  auto transform = openvdb::math::Transform::createLinearTransform(r.lattice.dp);
  const Vec3d first = r.lattice.point({0, 0, 0});
  transform->postTranslate({first.x, first.y, first.z});
  distance->setTransform(transform);
  material->setTransform(transform->copy());
  distance->setName("signed_distance");
  distance->setGridClass(openvdb::GRID_LEVEL_SET);
  distance->insertMeta("offset", openvdb::Vec3DMetadata({offset.x, offset.y, offset.z}));
  material->setName("material");
  try {
    openvdb::io::File file(path);
    file.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK);
    file.write({distance, material});
    file.close();
  } catch (const openvdb::Exception& e) {
    throw Error(ErrorKind::resource, path + ": cannot be written (" + e.what() + ")");
  }
}

}  // namespace

std::vector<BandPoint> signed_distance_band(const WallSurfaces& walls, const BandRequest& r, const std::string& vdb_path,
                                            const Vec3d& offset) {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
  std::vector<BandPoint> band;
  if (!walls.mesh.empty()) {
    const IndexSpaceMesh mesh(walls.mesh, r.lattice);
    const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
    openvdb::Int32Grid nearest(openvdb::util::INVALID_IDX);
    const auto width = static_cast<float>(r.half_width);
    const auto grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        mesh, *transform, width, width, openvdb::tools::UNSIGNED_DISTANCE_FIELD, &nearest);
    auto index = nearest.getConstAccessor();
    band.reserve(grid->activeVoxelCount());
    for (auto v = grid->cbeginValueOn(); v; ++v) {
      const openvdb::Coord c = v.getCoord();
      const Index3 at{c.x(), c.y(), c.z()};
      if (!within(at, r.lower, r.upper)) continue;
      const std::int32_t triangle = index.getValue(c);
      if (triangle < 0 || static_cast<std::size_t>(triangle) >= walls.mesh.triangle.size()) continue;
      const BandPoint point = measure(walls, r, at, triangle);
      if (std::abs(point.distance) <= r.half_width * r.lattice.dp) band.push_back(point);
    }
    std::sort(band.begin(), band.end(), [](const BandPoint& a, const BandPoint& b) {
      return a.at.x != b.at.x ? a.at.x < b.at.x : (a.at.y != b.at.y ? a.at.y < b.at.y : a.at.z < b.at.z);
    });
  }
  if (!vdb_path.empty()) write_grids(vdb_path, band, r, offset);
  return band;
}

}  // namespace gdesp::geometry
