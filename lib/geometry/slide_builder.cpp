// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/slide_builder.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/error.hpp"
#include "geometry/misplaced.hpp"
#include "geometry/sphere_packing.hpp"

namespace gdesp::geometry {
namespace {

constexpr double soft = 0.05;  // of a diameter, overlap of grains at rest that is warned of

Box grown(Box box, double by) {
  box.lower -= Vec3d{by, by, by};
  box.upper += Vec3d{by, by, by};
  return box;
}

/// Everything that bounds the grains: the shape from inside, and the walls and bodies around it.
TriangleMesh bounding_surfaces(const Layout& layout, const SolidPart& shape, double reach) {
  const Box near = grown(bounds(shape.mesh), reach);
  TriangleMesh out = shape.mesh;
  flip(out);
  append(out, crop(layout.walls.mesh, near));
  for (const auto* list : {&layout.parts.moving, &layout.parts.floating}) {
    for (const auto& b : *list) append(out, crop(b.mesh, near));
  }
  return out;
}

std::vector<bool> in_space(const Layout& layout, const SolidPart& shape, const std::vector<Vec3d>& points) {
  std::vector<bool> in(points.size());
  const std::vector<int> inside = windings(shape.mesh, points);
  const std::vector<int> below = windings(layout.parts.terrain, points);
  for (std::size_t k = 0; k < points.size(); ++k) in[k] = inside[k] > 0 && below[k] <= 0;
  bool any_tank = false;
  std::vector<bool> in_tank(points.size(), false);
  for (const auto& w : layout.parts.walls) {
    if (w.kind == WallPart::Kind::tank) {
      any_tank = true;
      for (std::size_t k = 0; k < points.size(); ++k) in_tank[k] = in_tank[k] || tank_clearance(w, points[k]) > 0.0;
      continue;
    }
    const std::vector<int> solid = windings(w.mesh, points);
    for (std::size_t k = 0; k < points.size(); ++k) in[k] = in[k] && solid[k] <= 0;
  }
  for (const auto* list : {&layout.parts.moving, &layout.parts.floating}) {
    for (const auto& b : *list) {
      const std::vector<int> solid = windings(b.mesh, points);
      for (std::size_t k = 0; k < points.size(); ++k) in[k] = in[k] && solid[k] <= 0;
    }
  }
  for (std::size_t k = 0; k < points.size(); ++k) in[k] = in[k] && (!any_tank || in_tank[k]);
  return in;
}

PackingRequest request_of(const Layout& layout, std::size_t index) {
  const Slide& slide = layout.scene.slides[index];
  const SolidPart& shape = layout.parts.slides[index];
  PackingRequest r;
  r.space = [&layout, &shape](const ColumnGrid& columns) {
    const ColumnIntervals inside =
        shape.box ? solid_intervals(box_mesh(*shape.box), columns) : solid_intervals(shape.mesh, columns);
    return subtract(subtract(inside, static_solid(layout.parts, columns)),
                    body_solid(layout.parts, layout.scene, columns));
  };
  r.contains = [&layout, &shape](const std::vector<Vec3d>& points) { return in_space(layout, shape, points); };
  r.body = shape.mesh;
  r.box = bounds(shape.mesh);
  r.diameter = slide.diameter;
  r.deviation = slide.diameter_deviation;
  r.half_width = slide.diameter_half_width;
  r.sieve = slide.sieve;
  r.walls = bounding_surfaces(layout, shape, 2.0 * grain_sizes(r).largest);
  r.porosity = slide.porosity;
  r.seed = slide.seed;
  r.name = "slide \"" + slide.name + "\"";
  r.dimensions = layout.scene.dimensions;
  return r;
}

void warn_of_packing(const Packing& packing, const Slide& slide, Notes& notes) {
  const std::string name = "slide \"" + slide.name + "\": ";
  if (std::abs(packing.porosity - slide.porosity) > 0.01) {
    notes.warnings.push_back(
        name + "porosity " + std::to_string(packing.porosity) + " reached where " + std::to_string(slide.porosity) +
        " was asked: the body is too thin for the grains, or the porosity too low for a random packing");
  }
  if (packing.left_out > 0) {
    notes.warnings.push_back(name + std::to_string(packing.left_out) +
                             " grains found no room without overlap and were left out");
  }
}

SettledBed settle(const PackingRequest& request, const Slide& slide, const GrainSettler& settler, Packing& packing,
                  Notes& notes) {
  const std::string name = "slide \"" + slide.name + "\": ";
  if (!settler) throw Error(ErrorKind::usage, name + "relaxation \"gravity\" needs the solver, which is not here");
  const std::size_t left_out = packing.left_out;
  const SettledBed bed = settle_packing(request, slide.density, settler, packing);
  if (packing.left_out > left_out) {
    notes.warnings.push_back(name + std::to_string(packing.left_out - left_out) +
                             " grains slipped out of its shape while they settled and were left out");
  }
  if (!bed.settlement.at_rest) {
    notes.warnings.push_back(name + "not at rest after " + std::to_string(bed.settlement.time) + " s of settling: " +
                             std::to_string(bed.settlement.speed) + " m/s root mean square is left");
  }
  if (packing.largest_overlap > soft) {
    notes.warnings.push_back(
        name + "its own weight presses grains " + std::to_string(100.0 * packing.largest_overlap) +
        " % of a diameter into each other: the contact is too soft for it (contact.youngs_modulus, contact.stiffness)");
  }
  return bed;
}

}  // namespace

SlideReport add_granular_slide(const Layout& layout, std::size_t index, const BuildOptions& how, GrainTable& grains,
                               Notes& notes) {
  const auto start = std::chrono::steady_clock::now();
  const Slide& slide = layout.scene.slides[index];
  const SolidPart& shape = layout.parts.slides[index];
  const double thickness = layout.scene.dimensions == 2 ? extent(bounds(shape.mesh)).y : 1.0;
  PackingRequest request = request_of(layout, index);
  request.volume = space_volume(request);
  check_room(layout, index, request.volume, signed_volume(shape.mesh) / thickness, notes);
  const bool packed = how.scope == BuildScope::everything, settles = slide.relaxation == "gravity";
  Packing packing = packed ? pack_spheres(request) : scatter_spheres(request);
  if (packed) warn_of_packing(packing, slide, notes);
  SlideReport report;
  if (packed && settles) report.settled = settle(request, slide, how.settler, packing, notes);
  if (!packed && settles)
    notes.done.push_back("slide \"" + slide.name +
                         "\": its packing settles under gravity before the case is written (relaxation)");
  report.name = slide.name;
  report.kind = slide.kind;
  report.grains = packing.position.size();
  report.volume = packing.volume;
  report.porosity = packing.porosity;
  report.largest_overlap = packing.largest_overlap;
  for (std::size_t k = 0; k < packing.position.size(); ++k) {
    report.mass += slide.density * grain_volume(packing.diameter[k], layout.scene.dimensions);
    grains.position.push_back(packing.position[k]);
    grains.diameter.push_back(packing.diameter[k]);
    grains.density.push_back(static_cast<float>(slide.density));
    grains.velocity.push_back(static_cast<Vec3f>(slide.velocity));
    grains.group.push_back(static_cast<std::int32_t>(index));
  }
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

double free_volume(const Layout& layout, const SolidPart& body) {
  const Box box = bounds(body.mesh);
  const Vec3d size = extent(box);
  const bool flat = layout.scene.dimensions == 2;
  ColumnGrid columns = covering_columns(box, (flat ? size.x : std::max(size.x, size.y)) / 800.0);
  if (flat) columns.y0 = 0.0, columns.ny = 1;
  const ColumnIntervals whole = solid_intervals(body.mesh, columns);
  const double all = volume(whole, columns),
               part = volume(subtract(whole, static_solid(layout.parts, columns)), columns);
  return all > 0.0 ? signed_volume(body.mesh) / (flat ? size.y : 1.0) * part / all : 0.0;
}

}  // namespace gdesp::geometry
