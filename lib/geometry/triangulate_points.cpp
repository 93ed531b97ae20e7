// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "geometry/terrain_loader.hpp"

namespace gdesp::geometry {

TriangleMesh triangulate_points(const std::vector<Vec3d>& points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, Kernel>;
  using Triangulation = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase>>;
  std::vector<Vec3d> sorted = points;
  std::sort(sorted.begin(), sorted.end(), [](const Vec3d& a, const Vec3d& b) {
    return a.x != b.x ? a.x < b.x : (a.y != b.y ? a.y < b.y : a.z < b.z);
  });
  TriangleMesh mesh;
  std::size_t same = 0;
  for (const auto& p : sorted) {
    if (!mesh.vertex.empty() && mesh.vertex.back().x == p.x && mesh.vertex.back().y == p.y) {
      ++same;
      mesh.vertex.back().z += (p.z - mesh.vertex.back().z) / static_cast<double>(same + 1);
    } else {
      same = 0;
      mesh.vertex.push_back(p);
    }
  }
  std::vector<std::pair<Kernel::Point_2, std::int32_t>> input;
  input.reserve(mesh.vertex.size());
  for (std::size_t v = 0; v < mesh.vertex.size(); ++v) {
    input.push_back({{mesh.vertex[v].x, mesh.vertex[v].y}, static_cast<std::int32_t>(v)});
  }
  Triangulation triangulation;
  triangulation.insert(input.begin(), input.end());
  for (auto f = triangulation.finite_faces_begin(); f != triangulation.finite_faces_end(); ++f) {
    mesh.triangle.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  }
  return mesh;
}

}  // namespace gdesp::geometry
