// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem/wall_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <unordered_map>

#include "core/error.hpp"
#include "dem/wall_strips.hpp"

namespace gdesp::dem {
namespace {

using Triangle = Vec3<std::int32_t>;

// Places nearer than the weld length become one vertex. Cells are much wider than that, so most places need one look.
class Welder {
 public:
  explicit Welder(double length) : weld_(length), inverse_(1.0 / (64.0 * length)) {}
  std::int32_t vertex(const Vec3d& p, std::int32_t body) {
    Key low, high;
    for (int axis = 0; axis < 3; ++axis) {
      low[static_cast<std::size_t>(axis)] = cell(p[axis] - weld_);
      high[static_cast<std::size_t>(axis)] = cell(p[axis] + weld_);
    }
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          const auto range = cells_.equal_range(Key{x, y, z, body});
          for (auto it = range.first; it != range.second; ++it) {
            if (norm(points[static_cast<std::size_t>(it->second)] - p) <= weld_) return it->second;
          }
        }
      }
    }
    const auto number = static_cast<std::int32_t>(points.size());
    points.push_back(p);
    cells_.emplace(Key{cell(p.x), cell(p.y), cell(p.z), body}, number);
    return number;
  }
  std::vector<Vec3d> points;

 private:
  using Key = std::array<std::int64_t, 4>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::uint64_t h = 1469598103934665603ull;
      for (std::int64_t k : key) h = ((h ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15ull) ^ (h >> 29);
      return static_cast<std::size_t>(h);
    }
  };
  std::int64_t cell(double x) const { return static_cast<std::int64_t>(std::floor(x * inverse_)); }
  double weld_, inverse_;
  std::unordered_multimap<Key, std::int32_t, Hash> cells_;
};

struct Surface {
  std::vector<Vec3d> point;
  std::vector<Triangle> triangle;
  std::vector<std::int32_t> body, smooth;
};

void check_indices(const TriangleTable& table) {
  for (std::size_t t = 0; t < table.triangle.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::int32_t v = table.triangle[t][k];
      if (v < 0 || static_cast<std::size_t>(v) >= table.vertex.size()) {
        throw Error(ErrorKind::input, "walls: triangle " + std::to_string(t) + " names vertex " + std::to_string(v) +
                                          "; there are " + std::to_string(table.vertex.size()));
      }
    }
  }
}

Surface weld_surface(const TriangleTable& table, double weld) {
  Welder welder(weld);
  Surface surface;
  std::vector<std::int64_t> made(table.vertex.size(), -1);  // body and number of the welded vertex
  for (std::size_t t = 0; t < table.triangle.size(); ++t) {
    const std::int32_t body = table.body.empty() ? 0 : table.body[t];
    Triangle welded;
    for (int k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(table.triangle[t][k]);
      if (made[v] < 0 || (made[v] >> 32) != body) {
        made[v] = (static_cast<std::int64_t>(body) << 32) | welder.vertex(table.vertex[v], body);
      }
      welded[k] = static_cast<std::int32_t>(made[v] & 0xffffffff);
    }
    const Vec3d a = welder.points[static_cast<std::size_t>(welded.x)];
    const Vec3d area = cross(welder.points[static_cast<std::size_t>(welded.y)] - a,
                             welder.points[static_cast<std::size_t>(welded.z)] - a);
    if (welded.x == welded.y || welded.y == welded.z || welded.z == welded.x || norm(area) <= weld * weld) continue;
    surface.triangle.push_back(welded);
    surface.body.push_back(body);
    surface.smooth.push_back(table.smooth.empty() ? 0 : table.smooth[t]);
  }
  surface.point = std::move(welder.points);
  return surface;
}

Vec3d unit(const Vec3d& a) { return (1.0 / norm(a)) * a; }

struct Builder {
  const Surface& surface;
  WallMesh& mesh;

  Vec3d corner(std::size_t t, int k) const {
    return surface.point[static_cast<std::size_t>(surface.triangle[t][k % 3])];
  }
  Vec3d normal(std::size_t t) const { return unit(cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0))); }
  Vec3d inside(std::size_t t, int k) const { return cross(normal(t), unit(corner(t, k + 1) - corner(t, k))); }
  float length(std::size_t t, int k) const { return static_cast<float>(norm(corner(t, k + 1) - corner(t, k))); }

  void frames() {
    for (std::size_t t = 0; t < surface.triangle.size(); ++t) {
      mesh.frame.push_back({Vec3f(normal(t)), length(t, 0), Vec3f(inside(t, 0)), length(t, 1), Vec3f(inside(t, 1)),
                            length(t, 2), Vec3f(inside(t, 2)), surface.body[t]});
      mesh.corners.push_back({corner(t, 0), corner(t, 1), corner(t, 2)});
    }
    mesh.vertex = surface.triangle;
    mesh.smooth = surface.smooth;
  }

  // Half edges sorted by their vertices; two of opposite direction are one inner edge.
  void edges() {
    struct Half {
      std::int64_t key;
      std::size_t edge;
      bool forward;
    };
    std::vector<Half> halves;
    for (std::size_t t = 0; t < surface.triangle.size(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const std::int64_t from = surface.triangle[t][k], to = surface.triangle[t][(k + 1) % 3];
        halves.push_back(
            {(std::min(from, to) << 32) | std::max(from, to), 3 * t + static_cast<std::size_t>(k), from < to});
      }
    }
    std::sort(halves.begin(), halves.end(),
              [](const Half& a, const Half& b) { return a.key != b.key ? a.key < b.key : a.edge < b.edge; });
    mesh.edge.assign(halves.size(), EdgeSide{});
    for (std::size_t h = 0; h < halves.size();) {
      std::size_t end = h;
      while (end < halves.size() && halves[end].key == halves[h].key) ++end;
      if (end - h == 2 && halves[h].forward != halves[h + 1].forward) {
        join(halves[h].edge, halves[h + 1].edge);
        join(halves[h + 1].edge, halves[h].edge);
      }
      h = end;
    }
  }
  void join(std::size_t edge, std::size_t other) {
    mesh.edge[edge] = {Vec3f(inside(other / 3, static_cast<int>(other % 3))),
                       Vec3f(normal(edge / 3) + normal(other / 3)), 0};
  }

  void rings() {
    mesh.ring_of.assign(surface.point.size(), VertexRing{});
    struct Spoke {
      std::int32_t from, to;
    };
    std::vector<Spoke> spokes;
    std::vector<Vec3d> outward(surface.point.size());
    for (std::size_t t = 0; t < surface.triangle.size(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const std::int32_t here = surface.triangle[t][k], next = surface.triangle[t][(k + 1) % 3];
        spokes.push_back({here, next});
        spokes.push_back({next, here});
        const auto v = static_cast<std::size_t>(here);
        const Vec3d e = unit(corner(t, k + 1) - corner(t, k)), f = unit(corner(t, k + 2) - corner(t, k));
        outward[v] += std::acos(std::clamp(dot(e, f), -1.0, 1.0)) * normal(t);
        if (mesh.edge[3 * t + static_cast<std::size_t>(k)].open) {
          mesh.ring_of[v].open = 1;
          mesh.ring_of[static_cast<std::size_t>(next)].open = 1;
        }
      }
    }
    std::sort(spokes.begin(), spokes.end(),
              [](const Spoke& a, const Spoke& b) { return a.from != b.from ? a.from < b.from : a.to < b.to; });
    for (std::size_t s = 0; s < spokes.size(); ++s) {
      const auto v = static_cast<std::size_t>(spokes[s].from);
      if (s > 0 && spokes[s].from == spokes[s - 1].from && spokes[s].to == spokes[s - 1].to) continue;
      VertexRing& ring = mesh.ring_of[v];
      if (ring.end == 0) ring.begin = static_cast<Index>(mesh.ring.size());
      mesh.ring.push_back(Vec3f(unit(surface.point[static_cast<std::size_t>(spokes[s].to)] - surface.point[v])));
      ring.end = static_cast<Index>(mesh.ring.size());
      ring.outward = Vec3f(outward[v]);
    }
  }
};

struct TreeBuilder {
  WallMesh& mesh;
  std::vector<Vec3d> lower, upper;  // of each triangle
  std::vector<Index> order;         // triangles, to be sorted so that leaves are contiguous
  Vec3d middle;

  void bounds(Index begin, Index end, Vec3d& low, Vec3d& high) const {
    constexpr double far = std::numeric_limits<double>::max();
    low = {far, far, far};
    high = {-far, -far, -far};
    for (Index k = begin; k < end; ++k) {
      const auto t = static_cast<std::size_t>(order[static_cast<std::size_t>(k)]);
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], lower[t][axis]);
        high[axis] = std::max(high[axis], upper[t][axis]);
      }
    }
  }
  void fill(Index number, Index begin, Index end) {
    Vec3d low, high;
    bounds(begin, end, low, high);
    const double widen = 2.0e-7 * (norm(low - middle) + norm(high - middle));
    const Vec3d margin{widen, widen, widen};
    WallNode node{Vec3f(low - middle - margin), Vec3f(high - middle + margin), begin, end - begin};
    mesh.node[static_cast<std::size_t>(number)] = node;
    if (end - begin <= 4) return;
    const Vec3d size = high - low;
    const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const Index half = begin + (end - begin) / 2;
    std::nth_element(order.begin() + begin, order.begin() + half, order.begin() + end, [&](Index a, Index b) {
      const auto s = static_cast<std::size_t>(a), t = static_cast<std::size_t>(b);
      const double x = lower[s][axis] + upper[s][axis], y = lower[t][axis] + upper[t][axis];
      return x != y ? x < y : a < b;
    });
    const auto child = static_cast<Index>(mesh.node.size());
    mesh.node.resize(mesh.node.size() + 2);
    mesh.node[static_cast<std::size_t>(number)].first = child;
    mesh.node[static_cast<std::size_t>(number)].count = 0;
    fill(child, begin, half);
    fill(child + 1, half, end);
  }
};

// Triangles of a body stand together (they are sorted by body); the tree reorders them within.
void build_trees(Surface& surface, WallMesh& mesh) {
  const auto count = surface.triangle.size();
  std::int32_t bodies = 0;
  for (std::int32_t b : surface.body) bodies = std::max(bodies, b);
  mesh.body.assign(static_cast<std::size_t>(bodies) + 1, WallBody{});
  TreeBuilder tree{mesh, std::vector<Vec3d>(count), std::vector<Vec3d>(count), std::vector<Index>(count), {}};
  std::iota(tree.order.begin(), tree.order.end(), 0);
  std::stable_sort(tree.order.begin(), tree.order.end(), [&](Index a, Index b) {
    return surface.body[static_cast<std::size_t>(a)] < surface.body[static_cast<std::size_t>(b)];
  });
  for (std::size_t t = 0; t < count; ++t) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = [&](int k) { return surface.point[static_cast<std::size_t>(surface.triangle[t][k])][axis]; };
      tree.lower[t][axis] = std::min({at(0), at(1), at(2)});
      tree.upper[t][axis] = std::max({at(0), at(1), at(2)});
    }
  }
  for (std::size_t begin = 0; begin < count;) {
    const std::int32_t body = surface.body[static_cast<std::size_t>(tree.order[begin])];
    std::size_t end = begin;
    while (end < count && surface.body[static_cast<std::size_t>(tree.order[end])] == body) ++end;
    Vec3d low, high;
    tree.bounds(static_cast<Index>(begin), static_cast<Index>(end), low, high);
    tree.middle = 0.5 * (low + high);
    mesh.body[static_cast<std::size_t>(body)] = {static_cast<Index>(mesh.node.size()), tree.middle,
                                                 0.5 * norm(high - low)};
    mesh.node.push_back({});
    tree.fill(static_cast<Index>(mesh.node.size()) - 1, static_cast<Index>(begin), static_cast<Index>(end));
    begin = end;
  }
  Surface sorted;
  sorted.point = surface.point;
  for (Index t : tree.order) {
    sorted.triangle.push_back(surface.triangle[static_cast<std::size_t>(t)]);
    sorted.body.push_back(surface.body[static_cast<std::size_t>(t)]);
    sorted.smooth.push_back(surface.smooth[static_cast<std::size_t>(t)]);
  }
  surface = std::move(sorted);
}

}  // namespace

WallMesh make_wall_mesh(const TriangleTable& table, double weld, int dimensions, double half_width) {
  check_indices(table);
  Surface surface = weld_surface(dimensions == 2 ? make_wall_strips(table, weld, half_width) : table, weld);
  WallMesh mesh;
  build_trees(surface, mesh);
  Builder builder{surface, mesh};
  builder.frames();
  builder.edges();
  builder.rings();
  return mesh;
}

}  // namespace gdesp::dem
