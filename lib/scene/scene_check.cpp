// SPDX-License-Identifier: GPL-3.0-or-later
// Checks that concern several keys at once.
#include <algorithm>
#include <set>

#include "core/error.hpp"
#include "scene/formula.hpp"
#include "scene/scene_visitor.hpp"

namespace gdesp::scene_detail {
namespace {

[[noreturn]] void fail(const KeySources& sources, const std::string& key, const std::string& what) {
  throw Error(ErrorKind::input, sources.where(key) + ": " + key + ": " + what);
}

void check_box(const KeySources& sources, const std::string& key, const std::optional<Box>& box, int dimensions) {
  if (!box) return;
  for (const int axis : {0, 1, 2}) {
    if (axis == 1 && dimensions == 2) continue;
    if (box->lower[axis] < box->upper[axis]) continue;
    fail(sources, key,
         std::string("lower.") + "xyz"[axis] + " = " + std::to_string(box->lower[axis]) + " m is not below upper." +
             "xyz"[axis] + " = " + std::to_string(box->upper[axis]) + " m");
  }
}

void check_polygon(const KeySources& sources, const std::string& key, const std::vector<Point2>& polygon) {
  if (!polygon.empty() && polygon.size() < 3)
    fail(sources, key, std::to_string(polygon.size()) + " points; a polygon needs at least 3");
}

void check_shape(const KeySources& sources, const std::string& key, const Shape& s, int dimensions) {
  const bool layered = !s.surface_below.empty() || !s.surface_above.empty();
  const int ways = (s.box ? 1 : 0) + (s.mesh.empty() ? 0 : 1) + (layered ? 1 : 0) + (s.polygon.empty() ? 0 : 1);
  const std::string valid =
      "give exactly one of: box; mesh; surface_below and surface_above; polygon with thickness or uniform_thickness";
  if (ways != 1) fail(sources, key, (ways == 0 ? "no shape: " : "more than one shape: ") + valid);
  if (layered && (s.surface_below.empty() || s.surface_above.empty()))
    fail(sources, key,
         "surface_below and surface_above come together; " +
             std::string(s.surface_below.empty() ? "surface_below" : "surface_above") + " is missing");
  const bool thick = !s.thickness.empty(), uniform = s.uniform_thickness > 0.0;
  if (!s.polygon.empty() && thick == uniform)
    fail(sources, key, "a polygon needs either thickness (a raster, m) or uniform_thickness > 0 (m)");
  if (s.polygon.empty() && (thick || uniform))
    fail(sources, key, std::string(thick ? "thickness" : "uniform_thickness") + " without polygon");
  check_box(sources, key + ".box", s.box, dimensions);
  check_polygon(sources, key + ".polygon", s.polygon);
}

void check_fill(const KeySources& sources, const std::string& key, FluidFill& fill, int dimensions) {
  if (!sources.given(key + ".kind")) fill.kind = fill.box ? "box" : (fill.mesh.empty() ? "level" : "mesh");
  const bool level = fill.kind == "level";
  if (level && !sources.given(key + ".level")) fail(sources, key, "kind \"level\" needs level (m)");
  if (fill.kind == "box" && !fill.box) fail(sources, key, "kind \"box\" needs box = {lower = [...], upper = [...]}");
  if (fill.kind == "mesh" && fill.mesh.empty()) fail(sources, key, "kind \"mesh\" needs mesh (a closed surface)");
  if (fill.box && fill.kind != "box") fail(sources, key + ".box", "only with kind \"box\"");
  if (!fill.mesh.empty() && fill.kind != "mesh") fail(sources, key + ".mesh", "only with kind \"mesh\"");
  if (!level && (fill.seed || !fill.polygon.empty()))
    fail(sources, key, "seed and polygon are only for kind \"level\"");
  check_box(sources, key + ".box", fill.box, dimensions);
  check_polygon(sources, key + ".polygon", fill.polygon);
}

void check_wall(const KeySources& sources, const std::string& key, const Wall& wall, int dimensions) {
  if (wall.tank.has_value() == !wall.mesh.empty())
    fail(sources, key, "give exactly one of: tank = {lower = [...], upper = [...]}; mesh");
  if (!wall.tank && !wall.open.empty()) fail(sources, key + ".open", "only with tank");
  if (wall.open.size() >= 6) fail(sources, key + ".open", "all faces are left out");
  if (!wall.tank && !wall.symmetry.empty()) fail(sources, key + ".symmetry", "only with tank");
  for (const std::string& face : wall.symmetry) {
    if (std::find(wall.open.begin(), wall.open.end(), face) != wall.open.end())
      fail(sources, key + ".symmetry",
           "\"" + face + "\" is left out (open): a plane of symmetry is a face of the tank");
  }
  check_box(sources, key + ".tank", wall.tank, dimensions);
}

void check_slide(const KeySources& sources, const std::string& key, const Slide& s, int dimensions) {
  check_shape(sources, key, s.shape, dimensions);
  if (s.kind == "granular") {
    if (s.sieve.empty() && s.diameter <= 0.0)
      fail(sources, key, "kind \"granular\" needs diameter > 0 (m), or [[slide.sieve]]");
    if (s.diameter_deviation > 0.0 && s.diameter_deviation >= s.diameter / 3.0)
      fail(sources, key + ".diameter_deviation",
           "must be below a third of diameter, or diameters would reach zero: give a sieve instead");
    if (s.diameter_half_width > 0.0 && s.diameter_half_width >= s.diameter)
      fail(sources, key + ".diameter_half_width", "must be below diameter, or diameters would reach zero");
    if (s.diameter_half_width > 0.0 && s.diameter_deviation > 0.0)
      fail(sources, key + ".diameter_half_width",
           "a uniform distribution, and diameter_deviation a normal one: give one of them");
    if (s.porosity < 0.2 || s.porosity > 0.95)
      fail(sources, key + ".porosity", std::to_string(s.porosity) + " cannot be packed; valid: 0.2 to 0.95");
  }
  if (s.kind == "prescribed" && s.motion_csv.empty())
    fail(sources, key, "kind \"prescribed\" needs motion_csv (a file of t,dx,dy,dz)");
  if (s.kind != "prescribed" && !s.motion_csv.empty())
    fail(sources, key + ".motion_csv", "only with kind \"prescribed\"");
}

void check_far_lake(const KeySources& sources, const std::string& key, const MovingBody& body, const Scene& scene) {
  const FarLakeKeys& lake = body.far_lake;
  if (!sources.given(key + ".far_lake") || body.kind != "piston") return;
  if (!(lake.length > 0.0) && !(lake.depth > 0.0) && lake.columns == 0) return;  // none, as a case says it
  if (!(lake.length > 0.0) || !(lake.depth > 0.0))
    fail(sources, key + ".far_lake", "needs length > 0 and depth > 0 (m)");
  if (lake.columns > 0 && lake.columns < 2)
    fail(sources, key + ".far_lake.columns", "1 column; a far lake needs at least 2");
  if (!body.shape.box)
    fail(sources, key,
         "with far_lake the piston is a box, whose face towards the particles' water is the wall between them");
  if (body.wave.kind != "none" || !body.motion_csv.empty() || norm(body.velocity) > 0.0 || body.remove_at >= 0.0)
    fail(sources, key, "with far_lake the water moves the piston: no wave, velocity, motion_csv or remove_at");
  if (scene.gravity.x != 0.0 || scene.gravity.y != 0.0 || !(scene.gravity.z < 0.0))
    fail(sources, key + ".far_lake", "needs gravity along -z");
  for (const std::string& axis : scene.periodic)
    if (axis == "x") fail(sources, key + ".far_lake", "not in a domain that is periodic along x");
}

void check_moving(const KeySources& sources, const std::string& key, const MovingBody& body, int dimensions) {
  check_shape(sources, key, body.shape, dimensions);
  if (!body.motion_csv.empty() && sources.given(key + ".velocity") && norm(body.velocity) > 0.0)
    fail(sources, key, "give either velocity or motion_csv");
  if (body.wave.kind != "none") {
    if (!(body.wave.height > 0.0) || !(body.wave.depth > 0.0))
      fail(sources, key + ".wave", "needs height > 0 and depth > 0 (m)");
    if (!(norm(body.wave.direction) > 0.0)) fail(sources, key + ".wave.direction", "is no direction");
    if (!body.motion_csv.empty() || norm(body.velocity) > 0.0)
      fail(sources, key, "give one of wave, velocity and motion_csv");
  }
  if (body.stop < body.start)
    fail(sources, key + ".stop",
         std::to_string(body.stop) + " s is before start = " + std::to_string(body.start) + " s");
}

/// Gives unnamed items a name; refuses names used twice or that would not do as part of a file name.
template <class Items>
void check_names(const KeySources& sources, const std::string& table, Items& items) {
  std::set<std::string> seen;
  std::size_t i = 0;
  for (auto& item : items) {
    const std::string key = table + "." + std::to_string(i++) + ".name";
    if (item.name.empty()) item.name = table + std::to_string(i);
    for (const char c : item.name)
      if (c == '/' || c == '\\' || static_cast<unsigned char>(c) < 0x20)
        fail(sources, key, "\"" + item.name + "\": a name holds no '/', '\\' or control character");
    if (item.name.size() > 64) fail(sources, key, "a name is at most 64 characters long");
    if (!seen.insert(item.name).second) fail(sources, key, "the name \"" + item.name + "\" is used twice");
  }
}

void check_moving_bodies(Scene& scene, const KeySources& sources) {
  for (const char* kind : {"gate", "piston", "body"}) {
    std::vector<MovingBody> bodies;
    for (const MovingBody& body : scene.moving)
      if (body.kind == kind) bodies.push_back(body);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const std::string key = std::string(kind) + "." + std::to_string(i);
      check_moving(sources, key, bodies[i], scene.dimensions);
      check_far_lake(sources, key, bodies[i], scene);
    }
    check_names(sources, kind, bodies);
    std::size_t next = 0;
    for (MovingBody& body : scene.moving)
      if (body.kind == kind) body.name = bodies[next++].name;
  }
}

/// Slides share one default name: the second and later get a number.
void name_slides(Scene& scene, const KeySources& sources) {
  for (std::size_t i = 1; i < scene.slides.size(); ++i)
    if (!sources.given("slide." + std::to_string(i) + ".name")) scene.slides[i].name += std::to_string(i + 1);
  check_names(sources, "slide", scene.slides);
}

void check_start_velocity(const Fluid& fluid, const KeySources& sources) {
  const std::pair<const char*, const std::string*> formulas[] = {{"fluid.velocity_x", &fluid.velocity_x},
                                                                 {"fluid.velocity_y", &fluid.velocity_y},
                                                                 {"fluid.velocity_z", &fluid.velocity_z}};
  for (const auto& [key, text] : formulas) {
    if (text->empty()) continue;
    try {
      Formula formula(*text);
    } catch (const Error& error) { fail(sources, key, error.what()); }
  }
}

void check_domain(const Scene& scene, const KeySources& sources) {
  const bool lower = sources.given("domain.lower"), upper = sources.given("domain.upper");
  if (lower != upper)
    fail(sources, "domain",
         std::string("lower and upper come together; ") + (lower ? "upper" : "lower") + " is missing");
  check_box(sources, "domain", scene.domain, scene.dimensions);
  if (scene.dimensions == 2)
    for (const std::string& axis : scene.periodic)
      if (axis == "y") fail(sources, "domain.periodic", "\"y\" has no meaning with dimensions = 2");
}

}  // namespace

void check_scene(Scene& scene, const KeySources& sources) {
  const auto item = [](const char* table, std::size_t i) { return std::string(table) + "." + std::to_string(i); };
  const int dimensions = scene.dimensions;
  check_domain(scene, sources);
  check_start_velocity(scene.fluid, sources);
  if (scene.terrain.vertical_scale == 0.0) fail(sources, "terrain.vertical_scale", "must not be 0");
  if (scene.terrain.bathymetry_scale == 0.0) fail(sources, "terrain.bathymetry_scale", "must not be 0");
  for (std::size_t i = 0; i < scene.fluid.fill.size(); ++i)
    check_fill(sources, item("fluid.fill", i), scene.fluid.fill[i], dimensions);
  for (std::size_t i = 0; i < scene.walls.size(); ++i) check_wall(sources, item("wall", i), scene.walls[i], dimensions);
  for (std::size_t i = 0; i < scene.slides.size(); ++i)
    check_slide(sources, item("slide", i), scene.slides[i], dimensions);
  for (std::size_t i = 0; i < scene.floating.size(); ++i)
    check_shape(sources, item("floating", i), scene.floating[i].shape, dimensions);
  for (std::size_t i = 0; i < scene.regions.size(); ++i)
    check_polygon(sources, item("region", i) + ".polygon", scene.regions[i].polygon);
  check_moving_bodies(scene, sources);
  name_slides(scene, sources);
  check_names(sources, "wall", scene.walls);
  check_names(sources, "floating", scene.floating);
  check_names(sources, "gauge", scene.gauges);
  check_names(sources, "section", scene.sections);
  check_names(sources, "region", scene.regions);
  if (scene.time.output_interval > scene.time.end)
    fail(sources, "time.output_interval",
         std::to_string(scene.time.output_interval) + " s is past time.end = " + std::to_string(scene.time.end) + " s");
}

}  // namespace gdesp::scene_detail
