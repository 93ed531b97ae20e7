// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/triangle_mesh.hpp"

#include <algorithm>
#include <limits>
#include <unordered_map>

namespace gdesp::geometry {

Box empty_box() {
  const double inf = std::numeric_limits<double>::infinity();
  return {{inf, inf, inf}, {-inf, -inf, -inf}};
}

void extend(Box& box, const Vec3d& p) {
  for (int a = 0; a < 3; ++a) {
    box.lower[a] = std::min(box.lower[a], p[a]);
    box.upper[a] = std::max(box.upper[a], p[a]);
  }
}

void include(Box& box, const Box& other) {
  if (is_empty(other)) return;
  extend(box, other.lower);
  extend(box, other.upper);
}

bool is_empty(const Box& box) { return !(box.lower.x <= box.upper.x); }

Vec3d extent(const Box& box) { return is_empty(box) ? Vec3d{} : box.upper - box.lower; }

Box bounds(const TriangleMesh& mesh) {
  Box box = empty_box();
  for (const auto& v : mesh.vertex) extend(box, v);
  return box;
}

double signed_volume(const TriangleMesh& mesh) {
  if (mesh.vertex.empty()) return 0.0;
  const Vec3d o = mesh.vertex.front();
  double six = 0.0;
  for (const auto& t : mesh.triangle) {
    six += dot(mesh.vertex[t.x] - o, cross(mesh.vertex[t.y] - o, mesh.vertex[t.z] - o));
  }
  return six / 6.0;
}

double surface_area(const TriangleMesh& mesh) {
  double twice = 0.0;
  for (const auto& t : mesh.triangle) {
    twice += norm(cross(mesh.vertex[t.y] - mesh.vertex[t.x], mesh.vertex[t.z] - mesh.vertex[t.x]));
  }
  return twice / 2.0;
}

MassProperties mass_properties(const TriangleMesh& mesh) {
  MassProperties m;
  if (mesh.vertex.empty()) return m;
  const Vec3d o = mesh.vertex.front();
  // Second moments: for a tetrahedron 0abc the integral of x_i x_j is V/20 (sum_s s_i s_j + S_i S_j), S = a+b+c.
  double second[3][3] = {};
  Vec3d first;
  for (const auto& t : mesh.triangle) {
    const Vec3d corner[3] = {mesh.vertex[t.x] - o, mesh.vertex[t.y] - o, mesh.vertex[t.z] - o};
    const double v = dot(corner[0], cross(corner[1], corner[2])) / 6.0;
    const Vec3d sum = corner[0] + corner[1] + corner[2];
    m.volume += v;
    first += sum * (v / 4.0);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        double s = sum[i] * sum[j];
        for (const auto& c : corner) s += c[i] * c[j];
        second[i][j] += v / 20.0 * s;
      }
    }
  }
  if (m.volume == 0.0) return m;
  const Vec3d centre = first * (1.0 / m.volume);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) second[i][j] -= m.volume * centre[i] * centre[j];
  }
  const double trace = second[0][0] + second[1][1] + second[2][2];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m.inertia_per_density[3 * i + j] = (i == j ? trace : 0.0) - second[i][j];
  }
  m.centre = centre + o;
  return m;
}

TriangleMesh box_mesh(const Box& b) {
  TriangleMesh m;
  for (int k = 0; k < 8; ++k) {
    m.vertex.push_back({k & 1 ? b.upper.x : b.lower.x, k & 2 ? b.upper.y : b.lower.y, k & 4 ? b.upper.z : b.lower.z});
  }
  const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    m.triangle.push_back({q[0], q[1], q[2]});
    m.triangle.push_back({q[0], q[2], q[3]});
  }
  return m;
}

void transform(TriangleMesh& mesh, const Vec3d& scale, const Vec3d& shift) {
  for (auto& v : mesh.vertex) v = Vec3d{v.x * scale.x, v.y * scale.y, v.z * scale.z} + shift;
  if (scale.x * scale.y * scale.z < 0.0) flip(mesh);
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto base = static_cast<std::int32_t>(mesh.vertex.size());
  mesh.vertex.insert(mesh.vertex.end(), other.vertex.begin(), other.vertex.end());
  mesh.triangle.reserve(mesh.triangle.size() + other.triangle.size());
  for (const auto& t : other.triangle) mesh.triangle.push_back({t.x + base, t.y + base, t.z + base});
}

TriangleMesh crop(const TriangleMesh& mesh, const Box& box) {
  TriangleMesh out;
  std::vector<std::int32_t> index(mesh.vertex.size(), -1);
  for (const auto& t : mesh.triangle) {
    Box b = empty_box();
    for (int c = 0; c < 3; ++c) extend(b, mesh.vertex[t[c]]);
    bool meets = true;
    for (int a = 0; a < 3; ++a) meets = meets && b.lower[a] <= box.upper[a] && b.upper[a] >= box.lower[a];
    if (!meets) continue;
    Triangle n;
    for (int c = 0; c < 3; ++c) {
      auto& i = index[t[c]];
      if (i < 0) {
        i = static_cast<std::int32_t>(out.vertex.size());
        out.vertex.push_back(mesh.vertex[t[c]]);
      }
      n[c] = i;
    }
    out.triangle.push_back(n);
  }
  return out;
}

void flip(TriangleMesh& mesh) {
  for (auto& t : mesh.triangle) std::swap(t.y, t.z);
}

std::size_t border_edges(const TriangleMesh& mesh) {
  std::unordered_map<std::uint64_t, int> count;
  count.reserve(mesh.triangle.size() * 2);
  for (const auto& t : mesh.triangle) {
    for (int c = 0; c < 3; ++c) {
      const auto a = static_cast<std::uint64_t>(t[c]);
      const auto b = static_cast<std::uint64_t>(t[(c + 1) % 3]);
      ++count[std::min(a, b) << 32 | std::max(a, b)];
    }
  }
  std::size_t border = 0;
  for (const auto& [edge, n] : count) border += n == 1;
  return border;
}

}  // namespace gdesp::geometry
