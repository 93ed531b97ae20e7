// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh_check.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_mesh_to_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/helpers.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.hpp"
#include "geometry/columns.hpp"
#include "geometry/mesh_topology.hpp"

namespace gdesp::geometry {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;

std::string at(const Vec3d& p) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.8g, %.8g, %.8g)", p.x, p.y, p.z);
  return text;
}

Vec3d vec(const Point& p) { return {p.x(), p.y(), p.z()}; }

std::string plural(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

std::size_t count_degenerate(const TriangleMesh& mesh) {
  std::size_t n = 0;
  for (const auto& t : mesh.triangle) {
    const Vec3d &a = mesh.vertex[t.x], &b = mesh.vertex[t.y], &c = mesh.vertex[t.z];
    n += CGAL::collinear(Point(a.x, a.y, a.z), Point(b.x, b.y, b.z), Point(c.x, c.y, c.z));
  }
  return n;
}

MeshReport plain_sheet_report(const TriangleMesh& mesh) {
  MeshReport r;
  r.sheet = true;
  r.vertices = mesh.vertex.size();
  r.triangles = mesh.triangle.size();
  r.components = r.holes = 1;
  r.box = bounds(mesh);
  r.area = surface_area(mesh);
  return r;
}

class Repair {
 public:
  Repair(TriangleMesh& mesh, MeshPurpose purpose, const RepairLimits& limits)
      : mesh_(mesh), purpose_(purpose), limits_(limits) {}

  MeshReport run() {
    describe();
    clean_soup();
    if (triangles_.empty()) return refuse("nothing is left without its degenerate triangles");
    if (!orient()) return report_;
    // A sheet needs no closing; whether it is one is seen before holes are touched.
    if (purpose_ != MeshPurpose::solid && report_.holes > 0 && is_sheet()) return accept_sheet();
    if (purpose_ == MeshPurpose::sheet) return refuse(sheet_refusal());
    if (!close_holes()) return report_;
    if (!CGAL::is_closed(surface_)) return refuse("stays open after closing what can be closed");
    if (!intersections_bearable()) return report_;
    turn_outward();
    return accept_solid();
  }

 private:
  MeshReport refuse(const std::string& why) {
    report_.verdict = MeshVerdict::refused;
    report_.refusal = why;
    report_.done.clear();
    return report_;
  }

  void did(const std::string& what) {
    report_.done.push_back(what);
    report_.verdict = MeshVerdict::repaired;
  }

  void describe() {
    report_.vertices = mesh_.vertex.size();
    report_.triangles = mesh_.triangle.size();
    report_.box = bounds(mesh_);
    report_.area = surface_area(mesh_);
    report_.degenerate_triangles = count_degenerate(mesh_);
  }

  /// Joins equal vertices, drops double and degenerate triangles.
  void clean_soup() {
    for (const auto& v : mesh_.vertex) points_.emplace_back(v.x, v.y, v.z);
    for (const auto& t : mesh_.triangle) {
      triangles_.push_back(
          {static_cast<std::size_t>(t.x), static_cast<std::size_t>(t.y), static_cast<std::size_t>(t.z)});
    }
    report_.duplicate_vertices = pmp::merge_duplicate_points_in_polygon_soup(points_, triangles_);
    const EdgeCounts edges = count_edges(from_soup());
    report_.border_edges = edges.border;
    report_.non_manifold_edges = edges.non_manifold;
    report_.inconsistent_edges = edges.inconsistent;
    non_manifold_at_ = edges.non_manifold_at;
    if (report_.duplicate_vertices)
      did(plural(report_.duplicate_vertices, "vertex at the place of another joined with it",
                 "vertices at the places of others joined with them"));
    const std::size_t before = triangles_.size();
    triangles_.erase(
        std::remove_if(triangles_.begin(), triangles_.end(),
                       [](const TriangleSoup::value_type& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }),
        triangles_.end());
    if (const std::size_t n = before - triangles_.size())
      did(plural(n, "triangle without area removed", "triangles without area removed"));
    if (const std::size_t n = remove_flaps(triangles_))
      did(plural(n, "pair", "pairs") + " of triangles back to back, with nothing between them, removed");
    report_.duplicate_triangles = pmp::merge_duplicate_polygons_in_polygon_soup(
        points_, triangles_, CGAL::parameters::require_same_orientation(false));
    if (report_.duplicate_triangles)
      did(plural(report_.duplicate_triangles, "double triangle removed", "double triangles removed"));
    report_.unused_vertices = pmp::remove_isolated_points_in_polygon_soup(points_, triangles_);
    if (report_.unused_vertices)
      did(plural(report_.unused_vertices, "unused vertex dropped", "unused vertices dropped"));
  }

  TriangleMesh from_soup() const {
    TriangleMesh m;
    for (const auto& p : points_) m.vertex.push_back(vec(p));
    for (const auto& t : triangles_) {
      m.triangle.push_back(
          {static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]), static_cast<std::int32_t>(t[2])});
    }
    return m;
  }

  /// One orientation for every connected part. Edges with more than two triangles are only cut apart when what results is
  /// closed by itself: two bodies that touch.
  bool orient() {
    const std::size_t flipped = report_.inconsistent_edges;
    pmp::orient_polygon_soup(points_, triangles_);
    if (!pmp::is_polygon_soup_a_polygon_mesh(triangles_)) {
      refuse("the facets around " + at(non_manifold_at_) + " cannot be oriented");
      return false;
    }
    pmp::polygon_soup_to_polygon_mesh(points_, triangles_, surface_);
    if (const std::size_t n = pmp::stitch_borders(surface_))
      did(plural(n, "pair of border edges sewn together", "pairs of border edges sewn together"));
    if (flipped) did("facets of mixed orientation turned (" + plural(flipped, "edge", "edges") + " disagreed)");
    count_parts();
    if (report_.non_manifold_edges > 0) {
      if (!CGAL::is_closed(surface_)) {
        refuse(plural(report_.non_manifold_edges, "edge is shared", "edges are shared") +
               " by more than two triangles, e.g. near " + at(non_manifold_at_) +
               ", and cutting there leaves open parts: which side is solid would be a guess");
        return false;
      }
      did(plural(report_.non_manifold_edges, "edge", "edges") +
          " with more than two triangles cut apart into closed parts");
    }
    return true;
  }

  void count_parts() {
    auto part = surface_.add_property_map<Surface::Face_index, std::size_t>("f:part").first;
    report_.components = pmp::connected_components(surface_, part);
    std::vector<Surface::Halfedge_index> borders;
    pmp::extract_boundary_cycles(surface_, std::back_inserter(borders));
    report_.holes = borders.size();
    if (purpose_ == MeshPurpose::sheet) return;  // what counts there is that no vertical line meets it twice
    std::vector<std::pair<Surface::Face_index, Surface::Face_index>> pairs;
    pmp::self_intersections<CGAL::Parallel_if_available_tag>(surface_, std::back_inserter(pairs));
    report_.self_intersections = pairs.size();
    if (!pairs.empty()) {
      const auto first = std::min_element(pairs.begin(), pairs.end());
      intersection_at_ = vec(surface_.point(surface_.target(surface_.halfedge(first->first))));
    }
  }

  /// Open, and no vertical line meets it twice: seen from above no two triangles overlap.
  bool is_sheet() {
    TriangleMesh m = to_mesh();
    double up = 0.0, all = 0.0;
    for (const auto& t : m.triangle) {
      const Vec3d n = cross(m.vertex[t.y] - m.vertex[t.x], m.vertex[t.z] - m.vertex[t.x]);
      up += n.z;
      all += std::abs(n.z);
    }
    if (all == 0.0) return false;
    const Vec3d size = extent(report_.box);
    const ColumnGrid columns = covering_columns(report_.box, std::max(size.x, size.y) / 400.0);
    std::size_t folded = 0;
    const std::vector<double> heights = sheet_heights(m, columns, 1e-6 * std::max(size.x, size.y), &folded, &fold_at_);
    std::size_t covered = 0;
    for (const double h : heights) covered += std::isfinite(h);
    folds_ = covered ? static_cast<double>(folded) / static_cast<double>(covered) : 1.0;
    return covered > 0 && folds_ < 0.002 && std::abs(up) > 0.99 * all;
  }

  std::string sheet_refusal() {
    if (report_.holes == 0) return "is closed, not an open sheet: give it as a wall, or cut its top surface out";
    char text[200];
    std::snprintf(text, sizeof text,
                  "folds over itself seen from above (%.2g %% of its area, e.g. at %s): heights there would be a guess",
                  100.0 * folds_, at(fold_at_).c_str());
    return text;
  }

  struct Hole {
    Surface::Halfedge_index border;
    Vec3d place;
    double width = 0.0;
    std::size_t edges = 0;
  };

  /// Widest first.
  std::vector<Hole> measure_holes(const std::vector<Surface::Halfedge_index>& borders) const {
    std::vector<Hole> holes;
    for (const auto border : borders) {
      Box box = empty_box();
      Hole hole;
      hole.border = border;
      for (const auto h : CGAL::halfedges_around_face(border, surface_)) {
        extend(box, vec(surface_.point(surface_.target(h))));
        ++hole.edges;
      }
      const Vec3d w = extent(box);
      hole.width = std::max({w.x, w.y, w.z});
      hole.place = (box.lower + box.upper) * 0.5;
      holes.push_back(hole);
    }
    std::stable_sort(holes.begin(), holes.end(), [](const Hole& a, const Hole& b) { return a.width > b.width; });
    return holes;
  }

  bool close_holes() {
    std::vector<Surface::Halfedge_index> borders;
    pmp::extract_boundary_cycles(surface_, std::back_inserter(borders));
    const Vec3d size = extent(report_.box);
    const double widest = limits_.hole_share * std::max({size.x, size.y, size.z});
    const std::vector<Hole> holes = measure_holes(borders);
    for (const auto& hole : holes) {
      if (hole.width <= widest && hole.edges <= limits_.hole_edges) continue;
      char text[240];
      std::snprintf(text, sizeof text,
                    "is open: the %s around %s is %.4g m wide (%zu edges); holes up to %.4g m and %zu edges are "
                    "closed, wider ones would be a guess",
                    holes.size() == 1 ? "hole" : ("widest of its " + std::to_string(holes.size()) + " holes").c_str(),
                    at(hole.place).c_str(), hole.width, hole.edges, widest, limits_.hole_edges);
      refuse(text);
      return false;
    }
    for (const auto& hole : holes) {
      std::vector<Surface::Face_index> patch;
      pmp::triangulate_hole(surface_, hole.border, std::back_inserter(patch));
      if (!patch.empty()) continue;
      refuse("the hole around " + at(hole.place) + " cannot be closed by triangles");
      return false;
    }
    const double largest = holes.empty() ? 0.0 : holes.front().width;
    if (!borders.empty()) {
      char text[96];
      std::snprintf(text, sizeof text, "%s closed (widest %.4g m)", plural(borders.size(), "hole", "holes").c_str(),
                    largest);
      did(text);
    }
    return true;
  }

  /// Crossing facets are borne where winding numbers still tell inside from outside: few of them, or whole shells that overlap.
  bool intersections_bearable() {
    if (report_.self_intersections == 0) return true;
    const double share = static_cast<double>(report_.self_intersections) / static_cast<double>(report_.triangles);
    if (report_.components == 1 && share > 0.25) {
      refuse(plural(report_.self_intersections, "pair", "pairs") + " of facets cross each other, e.g. near " +
             at(intersection_at_) + ": a surface that crosses itself over most of its extent has no inside");
      return false;
    }
    did(plural(report_.self_intersections, "pair", "pairs") + " of crossing facets kept (e.g. near " +
        at(intersection_at_) + "): inside is where the winding number is positive");
    return true;
  }

  void turn_outward() {
    if (report_.components > 1) {
      // Shells are turned outward one by one, so that nested and overlapping ones unite.
      auto part = surface_.property_map<Surface::Face_index, std::size_t>("f:part").first;
      const std::size_t n = pmp::connected_components(surface_, part);
      std::vector<double> volume(n, 0.0);
      const Point o = surface_.point(*surface_.vertices().begin());
      for (const auto f : surface_.faces()) {
        const auto h = surface_.halfedge(f);
        volume[part[f]] += CGAL::volume(o, surface_.point(surface_.source(h)), surface_.point(surface_.target(h)),
                                        surface_.point(surface_.target(surface_.next(h))));
      }
      std::vector<Surface::Face_index> inward;
      for (const auto f : surface_.faces()) {
        if (volume[part[f]] < 0.0) inward.push_back(f);
      }
      const auto shells =
          static_cast<std::size_t>(std::count_if(volume.begin(), volume.end(), [](double v) { return v < 0.0; }));
      if (shells == 0) return;
      pmp::reverse_face_orientations(inward, surface_);
      did(plural(shells, "shell", "shells") + " turned inside out");
      return;
    }
    if (signed_volume(to_mesh()) >= 0.0) return;
    pmp::reverse_face_orientations(surface_);
    did("turned inside out (its normals looked inward)");
  }

  TriangleMesh to_mesh() const {
    TriangleMesh m;
    std::vector<std::int32_t> index(surface_.num_vertices() + surface_.number_of_removed_vertices(), -1);
    for (const auto v : surface_.vertices()) {
      index[v] = static_cast<std::int32_t>(m.vertex.size());
      m.vertex.push_back(vec(surface_.point(v)));
    }
    for (const auto f : surface_.faces()) {
      const auto h = surface_.halfedge(f);
      m.triangle.push_back(
          {index[surface_.source(h)], index[surface_.target(h)], index[surface_.target(surface_.next(h))]});
    }
    return m;
  }

  /// Holes inside a sheet are closed when they are small beside it; larger ones stay, and are told.
  void close_sheet_holes() {
    std::vector<Surface::Halfedge_index> borders;
    pmp::extract_boundary_cycles(surface_, std::back_inserter(borders));
    const Vec3d size = extent(report_.box);
    const double widest = 0.2 * limits_.hole_share * std::max(size.x, size.y);
    double largest = 0.0;
    std::size_t closed = 0;
    const std::vector<Hole> holes = measure_holes(borders);
    for (std::size_t k = 1; k < holes.size(); ++k) {  // the first is the outer rim
      const Hole& hole = holes[k];
      if (hole.width > widest || hole.edges > limits_.hole_edges) continue;
      std::vector<Surface::Face_index> patch;
      pmp::triangulate_hole(surface_, hole.border, std::back_inserter(patch));
      if (patch.empty()) continue;
      largest = std::max(largest, hole.width);
      ++closed;
    }
    if (closed == 0) return;
    char text[96];
    std::snprintf(text, sizeof text, "%s in the sheet closed (widest %.4g m)", plural(closed, "hole", "holes").c_str(),
                  largest);
    did(text);
  }

  MeshReport accept_sheet() {
    close_sheet_holes();
    report_.sheet = true;
    mesh_ = to_mesh();
    return report_;
  }

  MeshReport accept_solid() {
    TriangleMesh solid = to_mesh();
    report_.volume = signed_volume(solid);
    const Vec3d size = extent(report_.box);
    if (!(report_.volume > 1e-9 * size.x * size.y * size.z) || size.x == 0.0 || size.y == 0.0 || size.z == 0.0) {
      return refuse("encloses no volume");
    }
    report_.closed = true;
    mesh_ = std::move(solid);
    return report_;
  }

  TriangleMesh& mesh_;
  const MeshPurpose purpose_;
  const RepairLimits& limits_;
  MeshReport report_;
  std::vector<Point> points_;
  TriangleSoup triangles_;
  Surface surface_;
  Vec3d non_manifold_at_, intersection_at_, fold_at_;
  double folds_ = 0.0;
};

}  // namespace

MeshReport check_and_repair(TriangleMesh& mesh, MeshPurpose purpose, const RepairLimits& limits) {
  if (purpose == MeshPurpose::sheet && is_plain_sheet(mesh)) return plain_sheet_report(mesh);
  TriangleMesh copy = mesh;
  try {
    MeshReport report = Repair(copy, purpose, limits).run();
    if (report.verdict != MeshVerdict::refused) mesh = std::move(copy);
    return report;
  } catch (const std::exception& e) {
    MeshReport report;
    report.verdict = MeshVerdict::refused;
    report.vertices = mesh.vertex.size();
    report.triangles = mesh.triangle.size();
    report.refusal = std::string("cannot be processed: ") + e.what();
    return report;
  }
}

void require_solid(TriangleMesh& mesh, const std::string& path, std::vector<std::string>& done) {
  const MeshReport report = check_and_repair(mesh, MeshPurpose::solid);
  if (report.verdict == MeshVerdict::refused)
    throw Error(ErrorKind::input, path + ": no closed solid: " + report.refusal);
  for (const auto& d : report.done) done.push_back(path + ": " + d);
}

}  // namespace gdesp::geometry
