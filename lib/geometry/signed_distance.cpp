// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/signed_distance.hpp"

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <mutex>

#include "core/error.hpp"
#include "core/triangle.hpp"

namespace gdesp::geometry {
namespace {

/// A triangle, ready to be asked for its distance.
struct Facet {
  Vec3d a, ab, ac, bc, normal;
  double ab2, ac2, bc2, cross2, mixed;
  Box box;

  Facet(const Vec3d& a_, const Vec3d& b, const Vec3d& c) : a(a_), ab(b - a_), ac(c - a_), bc(c - b), box(empty_box()) {
    const Vec3d n = cross(ab, ac);
    const double length = norm(n);
    normal = length > 0.0 ? n * (1.0 / length) : Vec3d{};
    ab2 = dot(ab, ab), ac2 = dot(ac, ac), bc2 = dot(bc, bc), mixed = dot(ab, ac), cross2 = length * length;
    for (const auto& v : {a_, b, c}) extend(box, v);
  }

  /// Squared distance (m2) of p: to the plane where its foot lies inside, else to the nearest of the three edges.
  double squared_distance(const Vec3d& p) const {
    const Vec3d ap = p - a;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    const double v = ac2 * d1 - mixed * d2, w = ab2 * d2 - mixed * d1;
    if (v >= 0.0 && w >= 0.0 && v + w <= cross2 && cross2 > 0.0) {
      const double h = dot(normal, ap);
      return h * h;
    }
    const Vec3d bp = ap - ab;
    return std::min({to_edge(ap, ab, d1, ab2), to_edge(ap, ac, d2, ac2), to_edge(bp, bc, dot(bc, bp), bc2)});
  }

 private:
  static double to_edge(const Vec3d& from, const Vec3d& edge, double along, double length2) {
    const double t = length2 > 0.0 ? std::clamp(along / length2, 0.0, 1.0) : 0.0;
    const Vec3d d = from - edge * t;
    return dot(d, d);
  }
};

/// The nearest triangle of each lattice point of a block of 8 x 8 columns.
struct Block {
  std::int32_t i0 = 0, j0 = 0, k0 = 0, height = 0;  ///< first column and point; points per column
  std::vector<float> squared;                       ///< m2, of the nearest triangle; column by column
  std::vector<std::int32_t> nearest;                ///< -1: none within the band
  std::size_t at(int i, int j, std::int32_t k) const {
    return static_cast<std::size_t>((i - i0) * 8 + (j - j0)) * static_cast<std::size_t>(height) +
           static_cast<std::size_t>(k - k0);
  }
};

struct Range {
  std::int32_t first, last;
};

/// Lattice points along an axis within `reach` of [low, high], and within the box asked for.
Range range_of(const BandRequest& r, int axis, double low, double high, double reach) {
  if (r.lattice.dimensions == 2 && axis == 1) return {0, low - reach <= 0.0 && high + reach >= 0.0 ? 0 : -1};
  return {std::max(r.lower[axis], r.lattice.first_at_or_above(axis, low - reach)),
          std::min(r.upper[axis], r.lattice.last_at_or_below(axis, high + reach))};
}

/// Lets one triangle compete for the points of a block.
void visit_block(const Facet& f, std::int32_t triangle, const BandRequest& r, double reach, Block& block) {
  const Range is = range_of(r, 0, f.box.lower.x, f.box.upper.x, reach),
              js = range_of(r, 1, f.box.lower.y, f.box.upper.y, reach);
  const Range ks = range_of(r, 2, f.box.lower.z, f.box.upper.z, reach);
  for (int i = std::max(is.first, block.i0); i <= std::min(is.last, block.i0 + 7); ++i) {
    for (int j = std::max(js.first, block.j0); j <= std::min(js.last, block.j0 + 7); ++j) {
      const double x = r.lattice.coordinate(0, i), y = r.lattice.coordinate(1, j);
      // Of the column only what lies within reach of the triangle's plane.
      const double level = f.normal.x * (x - f.a.x) + f.normal.y * (y - f.a.y);
      Range k = ks;
      if (std::abs(f.normal.z) < 1e-9) {
        if (std::abs(level) > reach) continue;
      } else {
        const double middle = f.a.z - level / f.normal.z, half = reach / std::abs(f.normal.z);
        k.first = std::max(k.first, r.lattice.first_at_or_above(2, std::max(middle - half, f.box.lower.z - reach)));
        k.last = std::min(k.last, r.lattice.last_at_or_below(2, std::min(middle + half, f.box.upper.z + reach)));
      }
      for (std::int32_t m = k.first; m <= k.last; ++m) {
        const auto d2 = static_cast<float>(f.squared_distance({x, y, r.lattice.coordinate(2, m)}));
        const std::size_t at = block.at(i, j, m);
        if (d2 >= block.squared[at]) continue;
        block.squared[at] = d2;
        block.nearest[at] = triangle;
      }
    }
  }
}

/// Triangles by the blocks that their surroundings touch: those of block b are [first[b], first[b + 1]).
struct BlockLists {
  std::int32_t i0 = 0, j0 = 0, ni = 0, nj = 0;  ///< in blocks
  std::vector<std::size_t> first;
  std::vector<std::int32_t> triangle;
};

BlockLists list_blocks(const std::vector<Facet>& facets, const BandRequest& r, double reach) {
  BlockLists out;
  out.i0 = r.lower.x >> 3, out.j0 = r.lower.y >> 3;
  out.ni = std::max(0, (r.upper.x >> 3) - out.i0 + 1), out.nj = std::max(0, (r.upper.y >> 3) - out.j0 + 1);
  out.first.assign(static_cast<std::size_t>(out.ni) * static_cast<std::size_t>(out.nj) + 1, 0);
  const auto each = [&](const Facet& f, const auto& use) {
    const Range is = range_of(r, 0, f.box.lower.x, f.box.upper.x, reach),
                js = range_of(r, 1, f.box.lower.y, f.box.upper.y, reach);
    if (is.first > is.last || js.first > js.last) return;
    for (int i = is.first >> 3; i <= is.last >> 3; ++i) {
      for (int j = js.first >> 3; j <= js.last >> 3; ++j)
        use(static_cast<std::size_t>(i - out.i0) * static_cast<std::size_t>(out.nj) +
            static_cast<std::size_t>(j - out.j0));
    }
  };
  for (const auto& f : facets) each(f, [&](std::size_t b) { ++out.first[b + 1]; });
  for (std::size_t b = 0; b + 1 < out.first.size(); ++b) out.first[b + 1] += out.first[b];
  out.triangle.resize(out.first.back());
  std::vector<std::size_t> next(out.first.begin(), out.first.end() - 1);
  for (std::size_t t = 0; t < facets.size(); ++t)
    each(facets[t], [&](std::size_t b) { out.triangle[next[b]++] = static_cast<std::int32_t>(t); });
  return out;
}

Block fill_block(const BlockLists& lists, std::size_t b, const std::vector<Facet>& facets, const BandRequest& r,
                 double reach) {
  Block block;
  block.i0 = (lists.i0 + static_cast<std::int32_t>(b / static_cast<std::size_t>(lists.nj))) * 8;
  block.j0 = (lists.j0 + static_cast<std::int32_t>(b % static_cast<std::size_t>(lists.nj))) * 8;
  double low = 1e300, high = -1e300;
  for (std::size_t k = lists.first[b]; k < lists.first[b + 1]; ++k) {
    low = std::min(low, facets[static_cast<std::size_t>(lists.triangle[k])].box.lower.z);
    high = std::max(high, facets[static_cast<std::size_t>(lists.triangle[k])].box.upper.z);
  }
  if (low > high) return block;
  const Range ks = range_of(r, 2, low, high, reach);
  block.k0 = ks.first;
  block.height = std::max(0, ks.last - ks.first + 1);
  block.squared.assign(64 * static_cast<std::size_t>(block.height), static_cast<float>(reach * reach * (1.0 + 1e-6)));
  block.nearest.assign(block.squared.size(), -1);
  for (std::size_t k = lists.first[b]; k < lists.first[b + 1]; ++k) {
    visit_block(facets[static_cast<std::size_t>(lists.triangle[k])], lists.triangle[k], r, reach, block);
  }
  return block;
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

using FloatLeaf = openvdb::FloatTree::LeafNodeType;
using IntLeaf = openvdb::Int32Tree::LeafNodeType;

/// What one block of columns has become: points in the order (i, j, k), and the leaves of both grids.
struct Piece {
  std::vector<BandPoint> points;
  std::vector<std::unique_ptr<FloatLeaf>> distance;
  std::vector<std::unique_ptr<IntLeaf>> material;
};

void make_leaves(Piece& piece, float background) {
  std::map<std::int32_t, std::size_t> by_height;
  for (const auto& p : piece.points) {
    const openvdb::Coord at(p.at.x, p.at.y, p.at.z);
    const auto [found, fresh] = by_height.try_emplace(p.at.z >> 3, piece.distance.size());
    if (fresh) {
      piece.distance.push_back(std::make_unique<FloatLeaf>(at, background, false));
      piece.material.push_back(std::make_unique<IntLeaf>(at, 0, false));
    }
    piece.distance[found->second]->setValueOn(at, p.distance);
    piece.material[found->second]->setValueOn(at, p.material);
  }
}

Piece measure_block(const Block& block, const WallSurfaces& walls, const BandRequest& r, bool leaves) {
  Piece piece;
  const double limit = r.half_width * r.lattice.dp;
  for (std::size_t at = 0; at < block.nearest.size(); ++at) {
    if (block.nearest[at] < 0) continue;
    const auto column = static_cast<std::int32_t>(at / static_cast<std::size_t>(block.height));
    const Index3 where{block.i0 + column / 8, block.j0 + column % 8,
                       block.k0 + static_cast<std::int32_t>(at % static_cast<std::size_t>(block.height))};
    const BandPoint point = measure(walls, r, where, block.nearest[at]);
    if (std::abs(point.distance) <= limit) piece.points.push_back(point);
  }
  if (leaves) make_leaves(piece, static_cast<float>(limit));
  return piece;
}

/// All points ordered by (i, j, k): each column lies in one piece, so counting by column is enough.
std::vector<BandPoint> in_order(std::vector<Piece>& pieces) {
  Index3 low{INT32_MAX, INT32_MAX, 0}, high{INT32_MIN, INT32_MIN, 0};
  for (const auto& piece : pieces) {
    for (const auto& p : piece.points) {
      low.x = std::min(low.x, p.at.x), low.y = std::min(low.y, p.at.y);
      high.x = std::max(high.x, p.at.x), high.y = std::max(high.y, p.at.y);
    }
  }
  if (low.x > high.x) return {};
  const std::size_t ny = static_cast<std::size_t>(high.y - low.y) + 1,
                    columns = (static_cast<std::size_t>(high.x - low.x) + 1) * ny;
  const auto column = [&](const BandPoint& p) {
    return static_cast<std::size_t>(p.at.x - low.x) * ny + static_cast<std::size_t>(p.at.y - low.y);
  };
  std::vector<std::size_t> next(columns + 1, 0);
  for (const auto& piece : pieces) {
    for (const auto& p : piece.points) ++next[column(p) + 1];
  }
  for (std::size_t c = 0; c < columns; ++c) next[c + 1] += next[c];
  std::vector<BandPoint> out(next[columns]);
  for (auto& piece : pieces) {
    for (const auto& p : piece.points) out[next[column(p)]++] = p;
    piece.points = {};  // never all of it twice
  }
  return out;
}

void write_grids(const std::string& path, const openvdb::FloatGrid::Ptr& distance,
                 const openvdb::Int32Grid::Ptr& material, const Lattice& lattice, const Vec3d& offset) {
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

std::vector<BandPoint> signed_distance_band(const WallSurfaces& walls, const BandRequest& r,
                                            const std::string& vdb_path, const Vec3d& offset) {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
  std::vector<Facet> facets;
  facets.reserve(walls.mesh.triangle.size());
  for (const auto& t : walls.mesh.triangle)
    facets.emplace_back(walls.mesh.vertex[t.x], walls.mesh.vertex[t.y], walls.mesh.vertex[t.z]);
  const double reach = r.half_width * r.lattice.dp;
  const BlockLists lists = list_blocks(facets, r, reach);
  std::vector<Piece> pieces(lists.first.size() - 1);
  std::exception_ptr problem;  // nothing may leave a parallel loop
#pragma omp parallel for schedule(dynamic, 4)
  for (std::size_t b = 0; b < pieces.size(); ++b) {
    try {
      pieces[b] = measure_block(fill_block(lists, b, facets, r, reach), walls, r, !vdb_path.empty());
    } catch (...) {
#pragma omp critical(gdesp_signed_distance)
      problem = std::current_exception();
    }
  }
  if (problem) std::rethrow_exception(problem);
  if (!vdb_path.empty()) {
    const auto distance = openvdb::FloatGrid::create(static_cast<float>(reach));
    const auto material = openvdb::Int32Grid::create(0);
    for (auto& piece : pieces) {
      for (auto& leaf : piece.distance) distance->tree().addLeaf(leaf.release());
      for (auto& leaf : piece.material) material->tree().addLeaf(leaf.release());
    }
    write_grids(vdb_path, distance, material, r.lattice, offset);
  }
  return in_order(pieces);
}

}  // namespace gdesp::geometry
