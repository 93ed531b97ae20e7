// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/signed_distance.hpp"

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
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

/// One leaf of the band: its voxels, and what became of them.
struct Leaf {
  openvdb::FloatTree::LeafNodeType* distance;
  openvdb::Int32Tree::LeafNodeType* nearest;
  std::vector<BandPoint> points;
};

/// Fills in distance and material of a leaf's voxels; those that lie outside the box or the band are switched off.
void measure_leaf(Leaf& leaf, const WallSurfaces& walls, const BandRequest& r) {
  const double limit = r.half_width * r.lattice.dp;
  const auto background = static_cast<float>(limit);
  for (auto v = leaf.distance->beginValueOn(); v; ++v) {
    const openvdb::Coord c = v.getCoord();
    const Index3 at{c.x(), c.y(), c.z()};
    const std::int32_t triangle = leaf.nearest->getValue(v.pos());
    const bool known = triangle >= 0 && static_cast<std::size_t>(triangle) < walls.mesh.triangle.size();
    if (known && within(at, r.lower, r.upper)) {
      const BandPoint point = measure(walls, r, at, triangle);
      if (std::abs(point.distance) <= limit) {
        v.setValue(point.distance);
        leaf.nearest->setValueOn(v.pos(), point.material);
        leaf.points.push_back(point);
        continue;
      }
    }
    v.setValue(background);
    v.setValueOff();
  }
  leaf.nearest->setValueMask(leaf.distance->getValueMask());
  for (auto v = leaf.nearest->beginValueOff(); v; ++v) v.setValue(0);
}

/// Ordered by (i, j, k). Leaves come in an order in which those above one another ascend, so counting by column is enough.
std::vector<BandPoint> in_order(std::vector<Leaf>& leaves) {
  Index3 low{INT32_MAX, INT32_MAX, 0}, high{INT32_MIN, INT32_MIN, 0};
  for (const auto& leaf : leaves) {
    for (const auto& p : leaf.points) {
      low.x = std::min(low.x, p.at.x), low.y = std::min(low.y, p.at.y);
      high.x = std::max(high.x, p.at.x), high.y = std::max(high.y, p.at.y);
    }
  }
  if (low.x > high.x) return {};
  const std::size_t ny = static_cast<std::size_t>(high.y - low.y) + 1, columns = (static_cast<std::size_t>(high.x - low.x) + 1) * ny;
  const auto column = [&](const BandPoint& p) { return static_cast<std::size_t>(p.at.x - low.x) * ny + static_cast<std::size_t>(p.at.y - low.y); };
  std::vector<std::size_t> next(columns + 1, 0);
  for (const auto& leaf : leaves) {
    for (const auto& p : leaf.points) ++next[column(p) + 1];
  }
  for (std::size_t c = 0; c < columns; ++c) next[c + 1] += next[c];
  std::vector<BandPoint> out(next[columns]);
  for (auto& leaf : leaves) {
    for (const auto& p : leaf.points) out[next[column(p)]++] = p;
    leaf.points = {};   // never all of it twice
  }
  return out;
}

void write_grids(const std::string& path, const openvdb::FloatGrid::Ptr& distance, const openvdb::Int32Grid::Ptr& material, const Lattice& lattice, const Vec3d& offset) {
  auto transform = openvdb::math::Transform::createLinearTransform(lattice.dp);
  const Vec3d first = lattice.point({0, 0, 0});
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
  auto distance = openvdb::FloatGrid::create(static_cast<float>(r.half_width * r.lattice.dp));
  const auto nearest = openvdb::Int32Grid::create(openvdb::util::INVALID_IDX);
  std::vector<Leaf> leaves;
  if (!walls.mesh.empty()) {
    const IndexSpaceMesh mesh(walls.mesh, r.lattice);
    const auto transform = openvdb::math::Transform::createLinearTransform(r.lattice.dp);
    const auto width = static_cast<float>(r.half_width);
    distance = openvdb::tools::meshToVolume<openvdb::FloatGrid>(mesh, *transform, width, width, openvdb::tools::UNSIGNED_DISTANCE_FIELD, nearest.get());
    for (auto leaf = distance->tree().beginLeaf(); leaf; ++leaf) leaves.push_back({leaf.getLeaf(), nearest->tree().touchLeaf(leaf->origin()), {}});
#pragma omp parallel for schedule(dynamic, 16)
    for (std::size_t k = 0; k < leaves.size(); ++k) measure_leaf(leaves[k], walls, r);
  }
  if (!vdb_path.empty()) {
    openvdb::tools::changeBackground(nearest->tree(), 0);
    openvdb::tools::pruneInactive(distance->tree());
    openvdb::tools::pruneInactive(nearest->tree());
    write_grids(vdb_path, distance, nearest, r.lattice, offset);
  }
  return in_order(leaves);
}

}  // namespace gdesp::geometry
