// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/file_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.hpp"
#include "geometry/mesh_reader.hpp"
#include "geometry/raster_reader.hpp"
#include "geometry/terrain_loader.hpp"

namespace gdesp::geometry {
namespace {

std::string number(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.7g", v);
  return text;
}

void add_box(FileReport& r, const Box& b) {
  const char* const name[2][3] = {{"x_min", "y_min", "z_min"}, {"x_max", "y_max", "z_max"}};
  for (int a = 0; a < 3; ++a) {
    r.numbers.push_back({name[0][a], b.lower[a]});
    r.numbers.push_back({name[1][a], b.upper[a]});
  }
}

/// The power of ten that all coordinates of an axis are multiples of, when that is coarse against the mesh's edges: the mark of a
/// file written with too few digits.
void find_rounding(FileReport& r, const TriangleMesh& mesh) {
  if (mesh.vertex.size() < 100) return;  // a few corners on round numbers are drawn, not measured
  const double edge = std::sqrt(surface_area(mesh) / std::max<std::size_t>(1, mesh.triangle.size()));
  const Vec3d size = extent(bounds(mesh));
  double quantum[2] = {0.0, 0.0};
  for (int a = 0; a < 2; ++a) {
    for (int power = static_cast<int>(std::ceil(std::log10(std::clamp(size[a], 1e-300, 1e300))));
         std::pow(10.0, power) > 1e-3 * edge; --power) {
      const double q = std::pow(10.0, power);
      const bool all = std::all_of(mesh.vertex.begin(), mesh.vertex.end(),
                                   [&](const Vec3d& v) { return std::abs(v[a] / q - std::round(v[a] / q)) < 1e-6; });
      if (!all) continue;
      quantum[a] = q;
      break;
    }
  }
  for (int a = 0; a < 2; ++a) {
    if (quantum[a] < 0.05 * edge || quantum[a] <= 5.0 * quantum[1 - a]) continue;
    r.found.push_back(std::string("all ") + "xy"[a] + " coordinates are multiples of " + number(quantum[a]) +
                      " m (the other axis: finer), mean edge " + number(edge) +
                      " m: the file was written with too few digits, and positions are off by up to half of that");
  }
}

void add_count(FileReport& r, const char* name, std::size_t n, const char* words) {
  r.numbers.push_back({name, static_cast<double>(n)});
  if (n > 0 && words) r.found.push_back(std::to_string(n) + " " + words);
}

void check_mesh(FileReport& r) {
  MeshOptions options;
  TriangleMesh mesh;
  try {
    mesh = read_mesh(r.path, options);
  } catch (const Error& e) {
    if (std::string(e.what()).find("mesh_size") == std::string::npos) throw;
    options.mesh_size = 0.05;  // judged at a twentieth of the unit; the scene states its own
    mesh = read_mesh(r.path, options);
  }
  find_rounding(r, mesh);
  const MeshReport m = check_and_repair(mesh, MeshPurpose::any);
  r.verdict = m.verdict;
  r.kind = m.verdict == MeshVerdict::refused ? "" : (m.closed ? "solid" : "sheet");
  add_count(r, "vertices", m.vertices, nullptr);
  add_count(r, "triangles", m.triangles, nullptr);
  add_count(r, "components", m.components, nullptr);
  add_count(r, "duplicate_vertices", m.duplicate_vertices, "duplicate vertices");
  add_count(r, "duplicate_triangles", m.duplicate_triangles, "duplicate triangles");
  add_count(r, "degenerate_triangles", m.degenerate_triangles, "degenerate triangles");
  add_count(r, "border_edges", m.border_edges, m.sheet ? nullptr : "border edges");
  add_count(r, "non_manifold_edges", m.non_manifold_edges, "edges with more than two triangles");
  add_count(r, "inconsistent_edges", m.inconsistent_edges, "edges whose triangles disagree in orientation");
  add_count(r, "holes", m.holes, m.sheet ? nullptr : "holes");
  add_count(r, "self_intersections", m.self_intersections, "pairs of triangles that cross");
  add_box(r, m.box);
  r.numbers.push_back({"area", m.area});
  r.numbers.push_back({"volume", m.volume});
  r.repair = m.done;
  r.refusal = m.refusal;
}

void check_raster(FileReport& r, Raster raster) {
  r.kind = "raster";
  for (const std::string& w : raster.warnings) r.found.push_back(w.substr(r.path.size() + 2));
  std::size_t missing = 0;
  for (const double z : raster.field.z) missing += !std::isfinite(z);
  r.numbers = {
      {"columns", raster.field.nx}, {"rows", raster.field.ny}, {"dx", raster.field.dx}, {"dy", raster.field.dy}};
  add_count(r, "missing_nodes", missing, "nodes without data");
  add_box(r, bounds(raster.field));
  if (const std::size_t n = fill_small_gaps(raster.field)) {
    r.verdict = MeshVerdict::repaired;
    r.repair.push_back(std::to_string(n) +
                       " of them, enclosed and few, filled from their rim where the raster is a terrain");
  }
  if (raster.crs.empty()) r.found.push_back("the coordinate system is not stated; give terrain.crs where it matters");
}

void check_points(FileReport& r) {
  const std::vector<Vec3d> points = read_points(r.path, {});
  const TriangleMesh mesh = triangulate_points(points);
  r.numbers = {{"points", static_cast<double>(points.size())}};
  add_box(r, bounds(mesh));
  if (mesh.empty()) {
    r.verdict = MeshVerdict::refused;
    Box box = empty_box();
    for (const auto& p : points) extend(box, p);
    const int flat = extent(box).x == 0.0 ? 0 : 1;
    r.refusal = "its points span no area: the first three columns are taken as x y z, and " +
                std::string(flat == 0 ? "x" : "y") + " is " + number(box.lower[flat]) + " throughout" +
                (flat == 0 ? " (is the first column a number of the line or ring?)" : "");
    return;
  }
  r.kind = "points";
  if (points.size() > mesh.vertex.size())
    r.found.push_back(std::to_string(points.size() - mesh.vertex.size()) +
                      " points at the place of others (the mean height is taken)");
}

}  // namespace

const char* verdict_name(MeshVerdict v) {
  return v == MeshVerdict::usable ? "usable" : (v == MeshVerdict::repaired ? "repairable" : "refused");
}

FileReport check_file(const std::string& path) {
  FileReport r;
  r.path = path;
  try {
    if (is_mesh_name(path)) {
      check_mesh(r);
    } else if (std::optional<Raster> raster = read_if_raster(path, {})) {
      check_raster(r, std::move(*raster));
    } else {
      check_points(r);
    }
  } catch (const Error& e) {
    r.verdict = MeshVerdict::refused;
    r.kind.clear();
    r.refusal = e.what();
    if (r.refusal.rfind(path + ": ", 0) == 0) r.refusal.erase(0, path.size() + 2);
  }
  return r;
}

std::string describe(const FileReport& r) {
  std::string text = r.path + ": " + verdict_name(r.verdict) + (r.kind.empty() ? "" : " as " + r.kind) + "\n ";
  for (const auto& [name, value] : r.numbers) text += " " + name + " " + number(value);
  text += "\n";
  for (const auto& f : r.found) text += "  found: " + f + "\n";
  for (const auto& f : r.repair) text += "  repair: " + f + "\n";
  if (!r.refusal.empty()) text += "  refused: " + r.refusal + "\n";
  return text;
}

}  // namespace gdesp::geometry
