// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/scene_parts.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "geometry/layered_body.hpp"
#include "geometry/mesh_check.hpp"
#include "geometry/mesh_reader.hpp"
#include "geometry/terrain_loader.hpp"

namespace gdesp::geometry {
namespace {

/// In two dimensions a body spans the plane y = 0 generously.
Box widened(Box box, const Scene& scene) {
  if (scene.dimensions == 2) {
    const double half = 0.5 * std::max(box.upper.x - box.lower.x, box.upper.z - box.lower.z) + 10.0 * scene.dp;
    box.lower.y = -half;
    box.upper.y = half;
  }
  return box;
}

SolidPart solid_of(const Shape& shape, const std::string& name, const Scene& scene, TerrainSheet& terrain,
                   Notes& notes) {
  SolidPart part;
  part.name = name;
  if (shape.box) {
    part.box = widened(*shape.box, scene);
    part.mesh = box_mesh(*part.box);
  } else if (!shape.mesh.empty()) {
    part.mesh =
        read_mesh(shape.mesh, {shape.mesh_size > 0.0 ? shape.mesh_size : 2.0 * scene.dp, shape.scale, shape.translate});
    require_solid(part.mesh, shape.mesh, notes.done);
  } else {
    part.mesh = layered_body(shape, name, scene, terrain, notes);
  }
  return part;
}

WallPart wall_of(const Wall& wall, const Scene& scene, Notes& notes) {
  WallPart part;
  part.name = wall.name;
  part.no_slip = wall.condition == "no-slip";
  if (wall.tank) {
    part.kind = WallPart::Kind::tank;
    part.tank = widened(*wall.tank, scene);
    part.open = wall.open;
    part.symmetry = wall.symmetry;
    if (scene.dimensions == 2) part.open.insert(part.open.end(), {"y-", "y+"});
    return part;
  }
  part.mesh =
      read_mesh(wall.mesh, {wall.mesh_size > 0.0 ? wall.mesh_size : 2.0 * scene.dp, wall.scale, wall.translate});
  TriangleMesh mended = part.mesh;
  const MeshReport report = check_and_repair(mended, MeshPurpose::any);
  if (report.verdict == MeshVerdict::refused || (!report.closed && !report.sheet)) {
    throw Error(ErrorKind::input, wall.mesh +
                                      ": is neither a closed solid nor a sheet that can be made solid downwards: " +
                                      (report.refusal.empty() ? "it is open and folded" : report.refusal));
  }
  part.mesh = std::move(mended);
  part.kind = report.closed ? WallPart::Kind::solid : WallPart::Kind::sheet;
  for (const auto& d : report.done) notes.done.push_back(wall.mesh + ": " + d);
  if (part.kind == WallPart::Kind::sheet) {
    turn_up(part.mesh);
    notes.done.push_back(wall.mesh + ": an open sheet, taken as solid below");
  }
  return part;
}

void list_shape(const Shape& s, std::vector<std::string>& files) {
  for (const auto* f : {&s.mesh, &s.surface_below, &s.surface_above, &s.thickness}) {
    if (!f->empty()) files.push_back(*f);
  }
}

std::vector<std::string> all_files(const Scene& scene) {
  std::vector<std::string> files = scene.terrain.files;
  if (!scene.terrain.bathymetry.empty()) files.push_back(scene.terrain.bathymetry);
  for (const auto& w : scene.walls)
    if (!w.mesh.empty()) files.push_back(w.mesh);
  for (const auto& f : scene.fluid.fill)
    if (!f.mesh.empty()) files.push_back(f.mesh);
  for (const auto& s : scene.slides) {
    list_shape(s.shape, files);
    if (!s.motion_csv.empty()) files.push_back(s.motion_csv);
  }
  for (const auto& m : scene.moving) {
    list_shape(m.shape, files);
    if (!m.motion_csv.empty()) files.push_back(m.motion_csv);
  }
  for (const auto& f : scene.floating) list_shape(f.shape, files);
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

void shift_box(std::optional<Box>& box, const Vec3d& offset) {
  if (!box) return;
  box->lower -= offset;
  box->upper -= offset;
}

void shift_points(std::vector<Point2>& polygon, const Vec3d& offset) {
  for (auto& p : polygon) p = {p.x - offset.x, p.y - offset.y};
}

void shift_shape(Shape& shape, const Vec3d& offset) {
  shift_box(shape.box, offset);
  shift_points(shape.polygon, offset);
}

void shift_part(SolidPart& part, const Vec3d& offset) {
  transform(part.mesh, {1, 1, 1}, -offset);
  shift_box(part.box, offset);
}

}  // namespace

SceneParts load_parts(const Scene& scene, Notes& notes) {
  SceneParts parts;
  parts.files = all_files(scene);
  TerrainSheet terrain;
  if (!scene.terrain.files.empty()) terrain = load_terrain(scene, notes);
  for (const auto& s : scene.slides)
    parts.slides.push_back(solid_of(s.shape, "slide \"" + s.name + "\"", scene, terrain, notes));
  for (const auto& m : scene.moving) {
    parts.moving.push_back(solid_of(m.shape, m.kind + " \"" + m.name + "\"", scene, terrain, notes));
    parts.moving.back().no_slip = m.condition == "no-slip";
  }
  for (const auto& f : scene.floating)
    parts.floating.push_back(solid_of(f.shape, "floating \"" + f.name + "\"", scene, terrain, notes));
  for (const auto& w : scene.walls) parts.walls.push_back(wall_of(w, scene, notes));
  for (std::size_t k = 0; k < scene.fluid.fill.size(); ++k) {
    SolidPart part;
    part.name = "fluid.fill." + std::to_string(k);
    if (scene.fluid.fill[k].kind == "mesh") {
      part.mesh = read_mesh(scene.fluid.fill[k].mesh);
      require_solid(part.mesh, scene.fluid.fill[k].mesh, notes.done);
    }
    parts.fluid.push_back(std::move(part));
  }
  parts.terrain = std::move(terrain.mesh);
  parts.terrain_spacing = terrain.spacing;
  parts.terrain_crs = terrain.crs;
  parts.terrain_no_slip = scene.terrain.condition == "no-slip";
  return parts;
}

Box bounds(const SceneParts& parts) {
  Box box = bounds(parts.terrain);
  for (const auto& w : parts.walls) include(box, w.kind == WallPart::Kind::tank ? w.tank : bounds(w.mesh));
  for (const auto* list : {&parts.moving, &parts.slides, &parts.floating, &parts.fluid}) {
    for (const auto& p : *list) include(box, bounds(p.mesh));
  }
  return box;
}

void shift(SceneParts& parts, const Vec3d& offset) {
  transform(parts.terrain, {1, 1, 1}, -offset);
  for (auto& w : parts.walls) {
    transform(w.mesh, {1, 1, 1}, -offset);
    w.tank.lower -= offset;
    w.tank.upper -= offset;
  }
  for (auto* list : {&parts.moving, &parts.slides, &parts.floating, &parts.fluid}) {
    for (auto& p : *list) shift_part(p, offset);
  }
}

Scene shifted(const Scene& scene, const Vec3d& offset) {
  Scene s = scene;
  shift_box(s.domain, offset);
  for (auto& f : s.fluid.fill) {
    f.level -= offset.z;
    if (f.seed) f.seed = Point2{f.seed->x - offset.x, f.seed->y - offset.y};
    shift_points(f.polygon, offset);
    shift_box(f.box, offset);
  }
  for (auto& w : s.walls) shift_box(w.tank, offset);
  for (auto& x : s.slides) shift_shape(x.shape, offset);
  for (auto& x : s.moving) shift_shape(x.shape, offset);
  for (auto& x : s.floating) shift_shape(x.shape, offset);
  return s;
}

bool inside_polygon(const std::vector<Point2>& polygon, double x, double y) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Point2 &a = polygon[i], &b = polygon[j];
    if ((a.y > y) != (b.y > y) && x < a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

}  // namespace gdesp::geometry
