// SPDX-License-Identifier: GPL-3.0-or-later
// Where a scene's case lies: offset, lattice, domain.
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.hpp"
#include "geometry/body_builder.hpp"
#include "geometry/case_builder.hpp"
#include "geometry/misplaced.hpp"
#include "geometry/surface_union.hpp"
#include "particles/surface_rows.hpp"

namespace gdesp::geometry {
namespace {

constexpr double layer_margin = boundary_layer_count + 0.5;  // dp around the walls' surfaces

bool has_tank(const SceneParts& parts) {
  return std::any_of(parts.walls.begin(), parts.walls.end(),
                     [](const WallPart& w) { return w.kind == WallPart::Kind::tank; });
}

/// Where a prescribed body comes to, until time.end.
void include_motion(Box& box, const Box& body, const PrescribedMotion& motion, double end) {
  for (std::size_t k = 0; k < motion.time.size(); ++k) {
    Vec3d d = motion.displacement[k];
    if (motion.time[k] > end) {
      if (k == 0 || motion.time[k - 1] > end) break;
      const double share = (end - motion.time[k - 1]) / (motion.time[k] - motion.time[k - 1]);
      d = motion.displacement[k - 1] + (d - motion.displacement[k - 1]) * share;
    }
    include(box, Box{body.lower + d, body.upper + d});
  }
}

Box surface_bounds(const SceneParts& parts, const Scene& scene) {
  Box box = bounds(parts);
  const Box still = box;
  for (std::size_t k = 0; k < parts.moving.size(); ++k) {
    include_motion(box, bounds(parts.moving[k].mesh), moving_body(scene.moving[k], norm(scene.gravity)).motion,
                   scene.time.end);
  }
  for (std::size_t k = 0; k < parts.slides.size(); ++k) {
    if (scene.slides[k].kind == "prescribed")
      include_motion(box, bounds(parts.slides[k].mesh), prescribed_slide(scene.slides[k]).motion, scene.time.end);
  }
  for (const auto& f : scene.fluid.fill) {
    if (f.box) include(box, *f.box);
  }
  box.upper.z += std::max(0.5 * extent(still).z, 10.0 * scene.dp);  // room for splashes
  return box;
}

/// User's domain, or the geometry's bounds, before the layers are added.
Box inner_domain(const SceneParts& parts, const Scene& scene) {
  if (scene.domain) return *scene.domain;
  const Box box = surface_bounds(parts, scene);
  if (is_empty(box)) throw Error(ErrorKind::input, "the scene is empty: no terrain, wall, body, slide or box of fluid");
  return box;
}

Box outer_domain(Box box, const Scene& scene) {
  for (int a = 0; a < 3; ++a) {
    if (is_periodic(scene, a)) continue;
    box.lower[a] -= layer_margin * scene.dp;
    box.upper[a] += layer_margin * scene.dp;
  }
  if (scene.dimensions == 2) {
    box.lower.y = -0.5 * scene.dp;
    box.upper.y = 0.5 * scene.dp;
  }
  return box;
}

/// Whether the rows of sph.surface-rows are at rest: where walls carry the water's own linear pressure on, and gravity points down.
bool rests_on_its_rows(const Scene& scene) {
  const bool on_lattice =
      scene.numerics.wall_layers != "fitted" || scene.dimensions == 3;  // walls beside the water (fitted_layers.hpp)
  return on_lattice && scene.numerics.walls == "extrapolated" && scene.gravity.x == 0.0 && scene.gravity.y == 0.0 &&
         scene.gravity.z < 0.0;
}

/// Still surface (m) that all the water has in common, where it is free.
std::optional<double> common_surface(const SceneParts& parts, const Scene& scene) {
  std::optional<double> surface;
  for (const FluidFill& f : scene.fluid.fill) {
    if (f.kind == "mesh") return std::nullopt;
    const double top = f.kind == "level" ? f.level : f.box->upper.z;
    if (surface && std::abs(top - *surface) > 1e-6 * scene.dp) return std::nullopt;
    surface = top;
  }
  const bool closed = std::any_of(parts.walls.begin(), parts.walls.end(), [&](const WallPart& w) {
    return w.kind == WallPart::Kind::tank && !is_open(w, "top") && surface && w.tank.upper.z < *surface + scene.dp;
  });
  return closed ? std::nullopt : surface;
}

Lattice choose_lattice(const SceneParts& parts, const Scene& scene, const Box& inner, std::optional<double> surface) {
  Lattice lattice;
  lattice.dp = scene.dp;
  lattice.dimensions = scene.dimensions;
  lattice.origin = inner.lower;
  bool anchored = false;
  for (const auto& w : parts.walls) {
    if (w.kind != WallPart::Kind::tank || anchored) continue;
    lattice.origin = w.tank.lower;
    anchored = true;
  }
  for (const auto& f : scene.fluid.fill) {
    if (anchored) break;
    if (f.kind == "box") lattice.origin = f.box->lower, anchored = true;
    if (f.kind != "level") continue;
    lattice.origin.z = f.level;
    anchored = true;
    if (!surface) surface = f.level;  // of several lakes the first one's
  }
  if (surface && rests_on_its_rows(scene)) {
    const double rows = (*surface - lattice.origin.z) / scene.dp;
    if (std::abs(rows - std::round(rows)) < 1e-6) {
      lattice.surface = static_cast<std::int32_t>(std::lround(rows));
      lattice.row_shift = surface_row_shifts(scene.numerics.smoothing_ratio, scene.dimensions);
    }
  }
  if (scene.dimensions == 2) lattice.origin.y = -0.5 * scene.dp;
  return lattice;
}

void warn_of_odd_tanks(const SceneParts& parts, const Scene& scene, Notes& notes) {
  for (const auto& w : parts.walls) {
    if (w.kind != WallPart::Kind::tank) continue;
    for (int a = 0; a < 3; ++a) {
      if (scene.dimensions == 2 && a == 1) continue;
      if (a == 2 && is_open(w, "top")) continue;
      const double n = (w.tank.upper[a] - w.tank.lower[a]) / scene.dp;
      if (std::abs(n - std::round(n)) < 0.02) continue;
      notes.warnings.push_back("wall \"" + w.name + "\": its inner " + "xyz"[a] + " length is " + std::to_string(n) +
                               " particle spacings; a whole number fits the walls exactly");
    }
  }
}

}  // namespace

Vec3d choose_offset(const Box& box, int dimensions) {
  const Vec3d size = extent(box);
  const double length = std::max({size.x, dimensions == 2 ? 0.0 : size.y, size.z});
  Vec3d offset;
  if (!(length > 0.0)) return offset;
  const double unit = std::pow(10.0, std::floor(std::log10(length)));
  for (int a = 0; a < 3; ++a) {
    if (dimensions == 2 && a == 1) continue;
    if (std::max(std::abs(box.lower[a]), std::abs(box.upper[a])) > 2.0 * length)
      offset[a] = std::floor(box.lower[a] / unit) * unit;
  }
  return offset;
}

Layout lay_out(const Scene& scene, Notes& notes) {
  Layout out;
  out.parts = load_parts(scene, notes);
  Box all = bounds(out.parts);
  for (const auto& f : scene.fluid.fill) {
    if (f.box) include(all, *f.box);
  }
  out.offset = choose_offset(scene.domain ? *scene.domain : all, scene.dimensions);
  if (scene.dimensions == 2 && !out.parts.terrain.empty()) {
    const Box t = bounds(out.parts.terrain);
    if (t.lower.y > 0.0 || t.upper.y < 0.0) {
      out.offset.y = 0.5 * (t.lower.y + t.upper.y);
      notes.done.push_back("two dimensions: the terrain is cut at y = " + std::to_string(out.offset.y) + " m");
    }
  }
  shift(out.parts, out.offset);
  out.scene = shifted(scene, out.offset);
  const Box inner = inner_domain(out.parts, out.scene);
  out.domain = outer_domain(inner, out.scene);
  out.surface = common_surface(out.parts, out.scene);
  out.lattice = choose_lattice(out.parts, out.scene, inner, out.surface);
  if (!out.parts.terrain.empty()) {
    Box keep = out.domain;
    keep.lower.z = -1e300;
    keep.upper.z = 1e300;
    if (scene.dimensions == 2) keep.lower.y = -4.0 * scene.dp, keep.upper.y = 4.0 * scene.dp;
    const Box whole = bounds(out.parts.terrain);
    out.parts.terrain = crop(out.parts.terrain, keep);
    if (out.parts.terrain.empty()) {
      throw Error(ErrorKind::input, "domain (" + span_text(out.domain, out.offset) +
                                        "): no terrain lies inside it, which spans " + span_text(whole, out.offset) +
                                        "; are both in the same coordinates?");
    }
  }
  out.walls = exposed_surfaces(out.parts, notes);
  if (has_tank(out.parts)) warn_of_odd_tanks(out.parts, out.scene, notes);
  return out;
}

}  // namespace gdesp::geometry
