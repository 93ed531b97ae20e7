// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh_topology.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <unordered_map>

#include "geometry/columns.hpp"

namespace gdesp::geometry {
namespace {

/// Edges by number of triangles, and by direction of use.
struct EdgeUse {
  int forward = 0, backward = 0;
};

/// Whether two triangles on the same corners go round them the same way.
bool same_turn(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
  for (int c = 0; c < 3; ++c) {
    if (a[0] == b[c]) return a[1] == b[(c + 1) % 3];
  }
  return false;
}

}  // namespace

EdgeCounts count_edges(const TriangleMesh& mesh) {
  std::unordered_map<std::uint64_t, EdgeUse> use;
  use.reserve(mesh.triangle.size() * 2);
  for (const auto& t : mesh.triangle) {
    for (int c = 0; c < 3; ++c) {
      const auto a = static_cast<std::uint64_t>(t[c]), b = static_cast<std::uint64_t>(t[(c + 1) % 3]);
      if (a == b) continue;
      EdgeUse& e = use[std::min(a, b) << 32 | std::max(a, b)];
      ++(a < b ? e.forward : e.backward);
    }
  }
  EdgeCounts out;
  for (const auto& [key, e] : use) {
    const int n = e.forward + e.backward;
    out.border += n == 1;
    out.inconsistent += n == 2 && e.forward != 1;
    if (n <= 2) continue;
    const Vec3d middle = (mesh.vertex[key >> 32] + mesh.vertex[key & 0xffffffffu]) * 0.5;
    if (out.non_manifold == 0 || middle.x < out.non_manifold_at.x) out.non_manifold_at = middle;
    ++out.non_manifold;
  }
  return out;
}

bool is_plain_sheet(const TriangleMesh& mesh) {
  std::vector<std::uint64_t> edges;  // directed, by the smaller end; the lowest bit tells the direction
  edges.reserve(3 * mesh.triangle.size());
  for (const auto& t : mesh.triangle) {
    if (!(cross(mesh.vertex[t.y] - mesh.vertex[t.x], mesh.vertex[t.z] - mesh.vertex[t.x]).z > 0.0)) return false;
    for (int c = 0; c < 3; ++c) {
      const auto a = static_cast<std::uint64_t>(t[c]), b = static_cast<std::uint64_t>(t[(c + 1) % 3]);
      edges.push_back((std::min(a, b) << 33 | std::max(a, b) << 1) | (a < b ? 0u : 1u));
    }
  }
  std::sort(edges.begin(), edges.end());
  std::unordered_map<std::uint64_t, std::uint64_t> next;  // along the rim
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const std::uint64_t edge = edges[k] >> 1, a = edge >> 32, b = edge & 0xffffffffu;
    if (k + 1 < edges.size() && edges[k + 1] >> 1 == edge) {
      if (edges[k] == edges[k + 1] || (k + 2 < edges.size() && edges[k + 2] >> 1 == edge)) return false;
      ++k;
    } else if (!next.emplace(edges[k] & 1 ? b : a, edges[k] & 1 ? a : b).second) {
      return false;
    }
  }
  if (next.empty()) return false;
  std::size_t length = 0;
  const std::uint64_t start = next.begin()->first;
  for (std::uint64_t at = start; length == 0 || at != start; ++length) {
    const auto step = next.find(at);
    if (step == next.end() || length > next.size()) return false;
    at = step->second;
  }
  if (length != next.size()) return false;
  const Box box = bounds(mesh);
  const double widest = std::max(extent(box).x, extent(box).y);
  std::size_t folded = 0;
  sheet_heights(mesh, covering_columns(box, widest / 400.0), 1e-6 * widest, &folded);
  return folded == 0;
}

std::size_t remove_flaps(TriangleSoup& triangles) {
  using Key = std::array<std::size_t, 3>;
  std::vector<std::pair<Key, std::size_t>> order;
  order.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Key key{triangles[t][0], triangles[t][1], triangles[t][2]};
    std::sort(key.begin(), key.end());
    order.push_back({key, t});
  }
  std::sort(order.begin(), order.end());
  std::map<Key, std::array<std::size_t, 2>> same;
  for (std::size_t k = 0, next = 0; k < order.size(); k = next) {
    while (next < order.size() && order[next].first == order[k].first) ++next;
    if (next - k == 2) same[order[k].first] = {order[k].second, order[k + 1].second};
  }
  if (same.empty()) return 0;
  std::map<std::pair<std::size_t, std::size_t>, int> uses;  // of edges, by triangles that are not doubled
  for (const auto& t : triangles) {
    Key key{t[0], t[1], t[2]};
    std::sort(key.begin(), key.end());
    if (same.count(key)) continue;
    for (int c = 0; c < 3; ++c) ++uses[std::minmax(t[c], t[(c + 1) % 3])];
  }
  std::vector<bool> gone(triangles.size(), false);
  std::size_t pairs = 0;
  for (const auto& [key, pair] : same) {
    if (same_turn(triangles[pair[0]], triangles[pair[1]])) continue;
    int odd = 0;
    for (int c = 0; c < 3; ++c) odd += uses[{key[c == 2 ? 0 : c], key[c == 2 ? 2 : c + 1]}] % 2;
    if (odd > 1) continue;
    gone[pair[0]] = gone[pair[1]] = true;
    ++pairs;
  }
  std::size_t n = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!gone[t]) triangles[n++] = triangles[t];
  }
  triangles.resize(n);
  return pairs;
}

}  // namespace gdesp::geometry
