// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/terrain_loader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "geometry/columns.hpp"
#include "geometry/gdal_support.hpp"
#include "geometry/mesh_check.hpp"
#include "geometry/mesh_reader.hpp"
#include "geometry/misplaced.hpp"
#include "geometry/raster_reader.hpp"

namespace gdesp::geometry {
namespace {

RasterOptions raster_options(const Terrain& t, const std::string& target_crs) {
  RasterOptions o;
  o.scale = t.scale;
  o.vertical_scale = t.vertical_scale;
  o.vertical_offset = t.vertical_offset;
  o.crs = t.crs;
  o.target_crs = target_crs;
  return o;
}

double mean_spacing(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const auto& t : mesh.triangle) {
    const Vec3d n = cross(mesh.vertex[t.y] - mesh.vertex[t.x], mesh.vertex[t.z] - mesh.vertex[t.x]);
    area += 0.5 * std::abs(n.z);
  }
  return mesh.triangle.empty() ? 0.0 : std::sqrt(2.0 * area / static_cast<double>(mesh.triangle.size()));
}

TriangleMesh read_sheet_mesh(const std::string& path, const Terrain& t, Notes& notes) {
  TriangleMesh mesh = read_mesh(path);
  transform(mesh, {t.scale, t.scale, t.vertical_scale}, {0.0, 0.0, t.vertical_offset});
  if (t.vertical_scale < 0.0) flip(mesh);
  const MeshReport report = check_and_repair(mesh, MeshPurpose::sheet);
  if (report.verdict == MeshVerdict::refused)
    throw Error(ErrorKind::input, path + ": no terrain sheet: " + report.refusal);
  for (const auto& what : report.done) notes.done.push_back(path + ": " + what);
  const std::size_t turned = turn_up(mesh);
  if (turned > 0 && turned < mesh.triangle.size()) {
    notes.done.push_back(path + ": " + std::to_string(turned) + " of " + std::to_string(mesh.triangle.size()) +
                         " triangles turned to look up");
  }
  return mesh;
}

/// Extreme level up to which a node may count as lake bed: the highest water level, or no limit.
double wet_limit(const Scene& scene) {
  double level = -std::numeric_limits<double>::infinity();
  for (const auto& f : scene.fluid.fill) {
    if (f.kind == "level") level = std::max(level, f.level);
  }
  return std::isfinite(level) ? level + 0.5 : std::numeric_limits<double>::infinity();
}

bool touches_wet(const Heightfield& f, int i, int j, double limit) {
  for (int dj = -1; dj <= 1; ++dj) {
    for (int di = -1; di <= 1; ++di) {
      const int a = i + di, b = j + dj;
      if (a < 0 || b < 0 || a >= f.nx || b >= f.ny) continue;
      if (f.at(a, b) <= limit) return true;
    }
  }
  return false;
}

void pass_on(const Raster& raster, Notes& notes) {
  notes.warnings.insert(notes.warnings.end(), raster.warnings.begin(), raster.warnings.end());
}

std::vector<Vec3d> bathymetry_points(const Scene& scene, const std::string& crs, Notes& notes) {
  const Terrain& t = scene.terrain;
  RasterOptions o;
  o.vertical_scale = t.bathymetry_scale;
  o.vertical_offset = t.bathymetry_offset;
  o.crs = t.bathymetry_crs;
  o.target_crs = crs;
  const std::optional<Raster> raster = read_if_raster(t.bathymetry, o);
  if (!raster) return read_points(t.bathymetry, o);
  pass_on(*raster, notes);
  return to_mesh(raster->field).vertex;
}

/// Lake bed from the points, tied to the dry shore: only nodes at or below the water are changed.
void burn_bathymetry(Heightfield& f, const Scene& scene, const std::string& crs, Notes& notes) {
  std::vector<Vec3d> points = bathymetry_points(scene, crs, notes);
  const double limit = wet_limit(scene);
  const std::size_t given = points.size();
  Box lake = empty_box();
  std::size_t dry = 0;
  for (const auto& p : points) extend(lake, p), dry += p.z > limit;
  if (2 * dry > given) {
    notes.warnings.push_back(
        scene.terrain.bathymetry + ": " + std::to_string(dry) + " of its " + std::to_string(given) +
        " points lie above the water: check sign and datum (terrain.bathymetry_scale, terrain.bathymetry_offset)");
  }
  const double margin = 0.25 * std::max(extent(lake).x, extent(lake).y);
  for (int j = 0; j < f.ny; ++j) {
    for (int i = 0; i < f.nx; ++i) {
      const double x = f.x0 + i * f.dx, y = f.y0 + j * f.dy, z = f.at(i, j);
      if (!(z > limit) || x < lake.lower.x - margin || x > lake.upper.x + margin || y < lake.lower.y - margin ||
          y > lake.upper.y + margin || !touches_wet(f, i, j, limit)) {
        continue;
      }
      points.push_back({x, y, std::isfinite(limit) ? std::min(z, limit - 0.5) : z});
    }
  }
  const std::vector<double> bed = heights_on_grid(triangulate_points(points), f);
  std::size_t burned = 0;
  double deepest = 0.0;
  for (std::size_t k = 0; k < bed.size(); ++k) {
    if (!std::isfinite(bed[k]) || !(f.z[k] <= limit) || bed[k] >= f.z[k]) continue;
    deepest = std::max(deepest, f.z[k] - bed[k]);
    f.z[k] = bed[k];
    ++burned;
  }
  if (burned == 0) {
    throw Error(ErrorKind::input, scene.terrain.bathymetry + ": none of its " + std::to_string(given) +
                                      " points lowers the terrain; check terrain.bathymetry_crs, _scale and _offset");
  }
  notes.done.push_back(scene.terrain.bathymetry + ": " + std::to_string(given) + " points burned into " +
                       std::to_string(burned) + " terrain nodes, deepest cut " + std::to_string(deepest) + " m");
}

Heightfield regular_grid_of(const TriangleMesh& mesh, double spacing) {
  const Box b = bounds(mesh);
  Heightfield f;
  f.dx = f.dy = spacing;
  f.x0 = b.lower.x;
  f.y0 = b.lower.y;
  f.nx = static_cast<int>((b.upper.x - b.lower.x) / spacing) + 1;
  f.ny = static_cast<int>((b.upper.y - b.lower.y) / spacing) + 1;
  f.z = heights_on_grid(mesh, f);
  return f;
}

TerrainSheet from_meshes(const std::vector<std::string>& files, const Terrain& t, Notes& notes) {
  TerrainSheet sheet;
  for (const auto& file : files) append(sheet.mesh, read_sheet_mesh(file, t, notes));
  sheet.spacing = mean_spacing(sheet.mesh);
  if (sheet.spacing == 0.0) throw Error(ErrorKind::input, files.front() + ": seen from above the terrain has no area");
  if (!t.crs.empty()) sheet.crs = check_crs(t.crs, "terrain.crs");
  return sheet;
}

TerrainSheet from_points(const std::vector<std::string>& files, const Terrain& t, const std::string& target_crs) {
  std::vector<Vec3d> points;
  for (const auto& file : files) {
    const auto more = read_points(file, raster_options(t, target_crs));
    points.insert(points.end(), more.begin(), more.end());
  }
  TerrainSheet sheet;
  sheet.mesh = triangulate_points(points);
  if (sheet.mesh.empty()) throw Error(ErrorKind::input, files.front() + ": its points span no area");
  sheet.spacing = mean_spacing(sheet.mesh);
  sheet.crs = target_crs.empty() && !t.crs.empty() ? check_crs(t.crs, "terrain.crs") : target_crs;
  return sheet;
}

}  // namespace

std::size_t turn_up(TriangleMesh& mesh) {
  std::size_t turned = 0;
  for (auto& t : mesh.triangle) {
    const Vec3d n = cross(mesh.vertex[t.y] - mesh.vertex[t.x], mesh.vertex[t.z] - mesh.vertex[t.x]);
    if (n.z >= 0.0) continue;
    std::swap(t.y, t.z);
    ++turned;
  }
  return turned;
}

std::vector<double> heights_on_grid(const TriangleMesh& sheet, const Heightfield& grid) {
  TriangleMesh square = sheet;  // columns are square; stretch y instead
  const double stretch = grid.dx / grid.dy;
  for (auto& v : square.vertex) v.y = (v.y - grid.y0) * stretch;
  ColumnGrid columns{grid.x0, 0.0, grid.dx, grid.nx, grid.ny};
  return sheet_heights(square, columns, 0.0, nullptr);
}

TerrainSheet load_sheet(const std::string& path, const Terrain& t, const std::string& target_crs, Notes& notes) {
  if (is_mesh_name(path)) return from_meshes({path}, t, notes);
  const std::optional<Raster> raster = read_if_raster(path, raster_options(t, target_crs));
  if (!raster) return from_points({path}, t, target_crs);
  pass_on(*raster, notes);
  TerrainSheet sheet;
  sheet.mesh = to_mesh(raster->field);
  sheet.spacing = std::sqrt(raster->field.dx * raster->field.dy);
  sheet.crs = raster->crs;
  return sheet;
}

TerrainSheet load_terrain(const Scene& scene, Notes& notes) {
  const Terrain& t = scene.terrain;
  TerrainSheet sheet;
  const auto meshes = static_cast<std::size_t>(std::count_if(t.files.begin(), t.files.end(), is_mesh_name));
  if (meshes != 0 && meshes != t.files.size()) {
    throw Error(ErrorKind::input, "terrain.files: meshes and rasters cannot be mixed; give the one or the other");
  }
  if (std::optional<Raster> raster; meshes == 0 && (raster = read_tiles(t.files, raster_options(t, "")))) {
    pass_on(*raster, notes);
    Heightfield& field = raster->field;
    if (const std::size_t n = fill_small_gaps(field))
      notes.done.push_back(t.files.front() + ": " + std::to_string(n) +
                           " nodes without data, enclosed and few, filled from their rim");
    if (!t.bathymetry.empty()) burn_bathymetry(field, scene, raster->crs, notes);
    sheet.mesh = scene.domain ? to_mesh(field, &*scene.domain) : to_mesh(field);
    sheet.spacing = std::sqrt(field.dx * field.dy);
    sheet.crs = raster->crs;
    if (sheet.mesh.empty())
      throw Error(ErrorKind::input, t.files.front() + ": no elevation inside the domain (" +
                                        span_text(*scene.domain, {}) + "); the terrain spans " +
                                        span_text(bounds(field), {}));
    return sheet;
  }
  sheet = meshes ? from_meshes(t.files, t, notes) : from_points(t.files, t, "");
  if (!t.bathymetry.empty()) {
    Heightfield f = regular_grid_of(sheet.mesh, sheet.spacing);
    burn_bathymetry(f, scene, sheet.crs, notes);
    sheet.mesh = to_mesh(f);
  }
  return sheet;
}

}  // namespace gdesp::geometry
