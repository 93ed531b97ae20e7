// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface_union.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>

#include "geometry/boundary_layers.hpp"
#include "geometry/columns.hpp"
#include "geometry/solid_columns.hpp"

namespace gdesp::geometry {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

/// One solid's surface, as it is cut up.
struct Piece {
  std::string name;
  TriangleMesh mesh;
  Box box;
  std::int32_t material = 0;
  const WallPart* wall = nullptr;  ///< null: terrain
};

bool overlap(const Box& a, const Box& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a.lower[axis] > b.upper[axis] || b.lower[axis] > a.upper[axis]) return false;
  }
  return true;
}

/// Moves the triangles that meet `box` out of `mesh`.
TriangleMesh take_out(TriangleMesh& mesh, const Box& box) {
  TriangleMesh near = crop(mesh, box);
  std::erase_if(mesh.triangle, [&](const Triangle& t) {
    Box b = empty_box();
    for (int c = 0; c < 3; ++c) extend(b, mesh.vertex[t[c]]);
    return overlap(b, box);
  });
  return near;
}

bool to_surface(const TriangleMesh& mesh, Surface& out) {
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> faces;
  for (const auto& v : mesh.vertex) points.emplace_back(v.x, v.y, v.z);
  for (const auto& t : mesh.triangle)
    faces.push_back({static_cast<std::size_t>(t.x), static_cast<std::size_t>(t.y), static_cast<std::size_t>(t.z)});
  if (!pmp::is_polygon_soup_a_polygon_mesh(faces)) return false;
  pmp::polygon_soup_to_polygon_mesh(points, faces, out);
  return true;
}

TriangleMesh from_surface(const Surface& surface) {
  TriangleMesh m;
  std::vector<std::int32_t> index(surface.num_vertices() + surface.number_of_removed_vertices(), -1);
  for (const auto v : surface.vertices()) {
    index[v] = static_cast<std::int32_t>(m.vertex.size());
    const auto& p = surface.point(v);
    m.vertex.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : surface.faces()) {
    const auto h = surface.halfedge(f);
    m.triangle.push_back({index[surface.source(h)], index[surface.target(h)], index[surface.target(surface.next(h))]});
  }
  return m;
}

/// Splits both pieces along their intersection; only what lies near the other is touched. False when CGAL cannot.
bool split(Piece& a, Piece& b) {
  Box both;
  for (int axis = 0; axis < 3; ++axis) {
    both.lower[axis] = std::max(a.box.lower[axis], b.box.lower[axis]);
    both.upper[axis] = std::min(a.box.upper[axis], b.box.upper[axis]);
  }
  TriangleMesh rest_a = a.mesh, rest_b = b.mesh;
  const TriangleMesh near_a = take_out(rest_a, both), near_b = take_out(rest_b, both);
  if (near_a.empty() || near_b.empty()) return true;
  Surface p, q;
  if (!to_surface(near_a, p) || !to_surface(near_b, q)) return false;
  try {
    pmp::corefine(p, q, CGAL::parameters::throw_on_self_intersection(true),
                  CGAL::parameters::throw_on_self_intersection(true));
  } catch (const std::exception&) { return false; }
  append(rest_a, from_surface(p));
  append(rest_b, from_surface(q));
  a.mesh = std::move(rest_a);
  b.mesh = std::move(rest_b);
  return true;
}

std::vector<Vec3d> centres_of(const TriangleMesh& mesh) {
  std::vector<Vec3d> out;
  out.reserve(mesh.triangle.size());
  for (const auto& t : mesh.triangle)
    out.push_back((mesh.vertex[t.x] + mesh.vertex[t.y] + mesh.vertex[t.z]) * (1.0 / 3.0));
  return out;
}

/// Which of the points lie inside the solid of a wall or the terrain (of tanks: none; they are treated together).
void mark_inside(const TriangleMesh& solid, const std::vector<Vec3d>& points, std::vector<bool>& inside) {
  const Box box = bounds(solid);
  std::vector<Vec3d> near;
  std::vector<std::size_t> which;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3d& p = points[k];
    if (p.x < box.lower.x || p.y < box.lower.y || p.x > box.upper.x || p.y > box.upper.y || p.z > box.upper.z) continue;
    near.push_back(p);
    which.push_back(k);
  }
  const std::vector<int> w = windings(solid, near);
  for (std::size_t k = 0; k < w.size(); ++k) {
    if (w[k] > 0) inside[which[k]] = true;
  }
}

/// Drops the triangles whose centres lie in another solid.
void drop_buried(Piece& piece, const SceneParts& parts) {
  const std::vector<Vec3d> centres = centres_of(piece.mesh);
  std::vector<bool> buried(centres.size(), false), in_tank(centres.size(), false);
  if (piece.wall && !parts.terrain.empty()) mark_inside(parts.terrain, centres, buried);
  bool any_tank = false;
  for (const auto& w : parts.walls) {
    if (&w == piece.wall) continue;
    if (w.kind != WallPart::Kind::tank) {
      mark_inside(w.mesh, centres, buried);
      continue;
    }
    any_tank = true;
    for (std::size_t k = 0; k < centres.size(); ++k) in_tank[k] = in_tank[k] || tank_clearance(w, centres[k]) > 0.0;
  }
  const bool is_tank = piece.wall && piece.wall->kind == WallPart::Kind::tank;
  std::size_t n = 0;
  for (std::size_t k = 0; k < centres.size(); ++k) {
    // Of two tanks, a face of the one that stands in the other is open space; anything else outside every tank is buried.
    const bool hidden = buried[k] || (any_tank && (is_tank ? in_tank[k] : !in_tank[k]));
    if (!hidden) piece.mesh.triangle[n++] = piece.mesh.triangle[k];
  }
  piece.mesh.triangle.resize(n);
}

std::vector<Piece> pieces_of(const SceneParts& parts) {
  std::vector<Piece> pieces;
  if (!parts.terrain.empty()) pieces.push_back({"terrain", parts.terrain, bounds(parts.terrain), 1, nullptr});
  for (std::size_t k = 0; k < parts.walls.size(); ++k) {
    const WallPart& w = parts.walls[k];
    TriangleMesh mesh = w.kind == WallPart::Kind::tank ? tank_faces(w) : w.mesh;
    const Box box = bounds(mesh);
    pieces.push_back({"wall \"" + w.name + "\"", std::move(mesh), box, 2 + static_cast<std::int32_t>(k), &w});
  }
  return pieces;
}

}  // namespace

WallSurfaces exposed_surfaces(const SceneParts& parts, Notes& notes) {
  std::vector<Piece> pieces = pieces_of(parts);
  for (std::size_t a = 0; a < pieces.size(); ++a) {
    for (std::size_t b = a + 1; b < pieces.size(); ++b) {
      if (!overlap(pieces[a].box, pieces[b].box) || split(pieces[a], pieces[b])) continue;
      notes.warnings.push_back(pieces[a].name + " and " + pieces[b].name +
                               " overlap and cannot be cut along their intersection (one crosses itself): "
                               "whole triangles are kept or dropped there");
    }
  }
  WallSurfaces out;
  for (auto& p : pieces) {
    if (pieces.size() > 1) drop_buried(p, parts);
    append(out.mesh, p.mesh);
    out.material.resize(out.mesh.triangle.size(), p.material);
  }
  return out;
}

}  // namespace gdesp::geometry
