// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/case_builder.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/error.hpp"
#include "geometry/body_builder.hpp"
#include "geometry/checksum.hpp"
#include "geometry/fitted_layers.hpp"
#include "geometry/misplaced.hpp"
#include "geometry/slide_builder.hpp"
#include "geometry/symmetry_planes.hpp"
#include "geometry/thin_walls.hpp"
#include "geometry/water_reach.hpp"
#include "geometry/water_relaxation.hpp"
#include "scene/formula.hpp"

namespace gdesp::geometry {
namespace {

/// Names stages as they begin and keeps their times.
class Stages {
 public:
  Stages(BuildReport& report, const std::function<void(const std::string&)>& on_stage)
      : report_(report), on_stage_(on_stage) {}
  ~Stages() { close(); }
  void begin(const std::string& name) {
    close();
    name_ = name;
    start_ = std::chrono::steady_clock::now();
    if (on_stage_) on_stage_(name);
  }

 private:
  void close() {
    if (!name_.empty())
      report_.seconds.push_back(
          {name_, std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count()});
    name_.clear();
  }
  BuildReport& report_;
  const std::function<void(const std::string&)>& on_stage_;
  std::string name_;
  std::chrono::steady_clock::time_point start_;
};

FillSpace fill_space(const Layout& layout, ColumnIntervals& walls) {
  FillSpace space;
  space.lattice = layout.lattice;
  space.columns = lattice_columns(layout.lattice, layout.domain);
  walls = static_solid(layout.parts, space.columns.grid, &space.ground);
  space.solid = unite(walls, body_solid(layout.parts, layout.scene, space.columns.grid));
  space.domain = layout.domain;
  for (int a = 0; a < 2; ++a) space.periodic[a] = is_periodic(layout.scene, a);
  space.offset = layout.offset;
  return space;
}

/// Unset: everywhere.
std::optional<WaterReach> wanted_walls(const Layout& layout, const FillSpace& space, const ColumnIntervals& walls,
                                       const std::vector<Vec3d>& water, BuildReport& report) {
  if (layout.scene.wall_particles == "all" || !layout.scene.periodic.empty())
    return std::nullopt;  // what leaves at one side comes in at the other
  const double run_up =
      layout.scene.run_up > 0.0 ? layout.scene.run_up : default_run_up(layout.scene, layout.parts, water);
  std::optional<WaterReach> reach = reach_of_water(space, walls, water, run_up);
  if (!reach || reach->share > 0.999) return std::nullopt;
  char text[200];
  std::snprintf(text, sizeof text,
                "wall particles where water can climb to, up to %.6g m (run-up of %.4g m above the water): %.3g %% of "
                "the ground; domain.run_up, domain.wall_particles",
                reach->head + layout.offset.z, run_up, 100.0 * reach->share);
  report.notes.done.push_back(text);
  return reach;
}

void keep_reachable(std::vector<BandPoint>& band, const FillSpace& space, const WaterReach& reach) {
  std::erase_if(band, [&](const BandPoint& b) {
    const int i = b.at.x - space.columns.i0, j = b.at.y - space.columns.j0;
    return i >= 0 && j >= 0 && i < space.columns.grid.nx && j < space.columns.grid.ny &&
           !reach.column[space.columns.grid.index(i, j)];
  });
}

std::vector<BandPoint> wall_band(const Layout& layout, const WallSurfaces& surfaces, const FillSpace& space,
                                 const ColumnIntervals& walls, double half_width, const std::string& vdb_path) {
  BandRequest request;
  request.lattice = layout.lattice;
  request.columns = space.columns;
  request.solid = &walls;
  for (int a = 0; a < 3; ++a) {
    const bool flat = layout.scene.dimensions == 2 && a == 1;
    request.lower[a] = flat ? 0 : layout.lattice.first_at_or_above(a, layout.domain.lower[a]);
    request.upper[a] = flat ? 0 : layout.lattice.last_at_or_below(a, layout.domain.upper[a]);
  }
  request.half_width = half_width;
  return signed_distance_band(surfaces, request, vdb_path, layout.offset);
}

std::vector<PorousRegion> porous_regions(const Layout& layout, const FillSpace& space) {
  std::vector<PorousRegion> out;
  for (std::size_t k = 0; k < layout.parts.slides.size(); ++k) {
    if (layout.scene.slides[k].kind != "granular") continue;
    const SolidPart& part = layout.parts.slides[k];
    PorousRegion region;
    region.box = part.box;
    region.bounds = bounds(part.mesh);
    region.porosity = layout.scene.slides[k].porosity;
    if (!part.box) region.inside = solid_intervals(part.mesh, space.columns.grid);
    out.push_back(std::move(region));
  }
  return out;
}

/// Formulas are of the scene's own coordinates.
void set_start_velocity(const Layout& layout, Case& out) {
  const Fluid& fluid = layout.scene.fluid;
  const std::string* const text[3] = {&fluid.velocity_x, &fluid.velocity_y, &fluid.velocity_z};
  if (text[0]->empty() && text[1]->empty() && text[2]->empty()) return;
  out.fluid.velocity.assign(out.fluid.position.size(), Vec3f{});
  for (int a = 0; a < 3; ++a) {
    if (text[a]->empty() || (layout.scene.dimensions == 2 && a == 1)) continue;
    const Formula formula(*text[a]);
    for (std::size_t i = 0; i < out.fluid.position.size(); ++i) {
      const double v = formula(out.fluid.position[i] + layout.offset);
      if (!std::isfinite(v))
        throw Error(ErrorKind::input, "fluid.velocity_" + std::string(1, "xyz"[a]) + " = \"" + *text[a] +
                                          "\" has no finite value everywhere in the water");
      out.fluid.velocity[i][a] = static_cast<float>(v);
    }
  }
}

/// Where a fill without seed began, and where nothing holds it.
void say_of_fill(const Layout& layout, const FillSpace& space, std::size_t k, const FillReport& fill, Notes& notes) {
  const FluidFill& asked = layout.scene.fluid.fill[k];
  char text[300];
  if (asked.kind == "level" && !asked.seed && asked.polygon.empty() && !layout.parts.terrain.empty()) {
    std::snprintf(
        text, sizeof text,
        "fluid.fill.%zu: without seed or polygon the water is that over the lowest ground (x = %.10g m, y = %.10g m)",
        k, fill.lowest_at.x + layout.offset.x, fill.lowest_at.y + layout.offset.y);
    notes.done.push_back(text);
  }
  if (fill.open_edge > 0.0) {
    std::snprintf(text, sizeof text,
                  "fluid.fill.%zu: along %.4g m no wall holds the water (edge of the polygon, the domain or the "
                  "terrain; e.g. at x = %.10g m, "
                  "y = %.10g m): it will run out there",
                  k, fill.open_edge, fill.open_edge_at.x + layout.offset.x, fill.open_edge_at.y + layout.offset.y);
    notes.warnings.push_back(text + level_hint(space, fill.level));
  }
}

void fill_fluid(const Layout& layout, const FillSpace& space, Case& out, BuildReport& report) {
  double level = -1e300;
  for (std::size_t k = 0; k < layout.scene.fluid.fill.size(); ++k) {
    FillReport fill;
    add_fill(out.fluid.position,
             fill_water(layout.scene.fluid.fill[k], layout.parts.fluid[k], space, layout.parts,
                        "fluid.fill." + std::to_string(k), fill),
             layout.lattice.dp);
    level = std::max(level, fill.level);
    say_of_fill(layout, space, k, fill, report.notes);
    report.fills.push_back(fill);
  }
  out.still_water_level = out.fluid.position.empty() ? layout.domain.lower.z : level;
}

void warn_of_thin_walls(const Layout& layout, const FillSpace& space, const ColumnIntervals& walls,
                        const std::vector<Vec3d>& water, BuildReport& report) {
  const std::optional<ThinWall> thin = thinnest_wall(space, walls, layout.parts, water);
  if (!thin) return;
  const double dp = layout.lattice.dp;
  char text[400];
  std::snprintf(text, sizeof text,
                "a wall between water and open space is only %.3g m thick (%.2g dp; about %.3g m of such walls, the "
                "thinnest found at x = %.8g m, y = %.8g m, "
                "z = %.6g m): water sees through walls thinner than %g dp and may not stay still; resolution.dp = %.3g "
                "m or finer holds it",
                thin->thickness, thin->thickness / dp, static_cast<double>(thin->places) * dp,
                thin->at.x + layout.offset.x, thin->at.y + layout.offset.y, thin->at.z + layout.offset.z,
                least_wall_spacings, thin->thickness / least_wall_spacings);
  report.notes.warnings.push_back(text);
}

/// The lattice column nearest to p, or (i, j) beside it; the nearest one where there are no more.
std::size_t column_of(const FillSpace& space, const Vec3d& p, int i, int j) {
  const ColumnGrid& grid = space.columns.grid;
  const auto along = [&](double x, double x0, int n, int more) {
    return std::clamp(static_cast<int>(std::lround((x - x0) / grid.spacing)) + more, 0, n - 1);
  };
  return grid.index(along(p.x, grid.x0, grid.nx, i), along(p.y, grid.y0, grid.ny, j));
}

/// Highest water of each lattice column (m); -1e300: none.
std::vector<double> column_tops(const FillSpace& space, const std::vector<Vec3d>& water) {
  std::vector<double> top(space.columns.grid.count(), -1e300);
  for (const Vec3d& p : water) {
    const std::size_t c = column_of(space, p, 0, 0);
    top[c] = std::max(top[c], p.z);
  }
  return top;
}

/// Hydrostatic pressure (Pa) under the surface that all the water has in common; without one, of water that has left its lattice column, under
/// the highest water there was in the column where it is now, or beside it.
void set_start_pressure(const Layout& layout, const FillSpace& space, const std::vector<double>& top,
                        FluidTable& fluid) {
  const double half = 0.5 * layout.lattice.dp, weight = -layout.scene.gravity.z * layout.scene.fluid.density;
  for (const Vec3d& p : fluid.position) {
    if (layout.surface) {
      fluid.pressure.push_back(static_cast<float>(weight * std::max(0.0, *layout.surface - p.z)));
      continue;
    }
    double level = top[column_of(space, p, 0, 0)];
    for (int i = -1; i <= 1 && level < p.z - half; ++i) {
      for (int j = -1; j <= 1; ++j) level = std::max(level, top[column_of(space, p, i, j)]);
    }
    if (level > -1e299) level -= layout.lattice.shift(layout.lattice.nearest(2, level));
    fluid.pressure.push_back(static_cast<float>(weight * std::max(0.0, level + half - p.z)));
  }
}

void add_body(const Layout& layout, const SolidPart& part, Body body, Case& out) {
  out.bodies.push_back(std::move(body));
  const auto number = static_cast<std::int32_t>(out.bodies.size());
  bool endless[3];
  for (int a = 0; a < 3; ++a) {
    const bool spans =
        part.box && part.box->lower[a] <= layout.domain.lower[a] && part.box->upper[a] >= layout.domain.upper[a];
    endless[a] = spans && is_periodic(layout.scene, a);
  }
  add_body_layers(part, number, layout.lattice, endless, out.boundary);
  const auto base = static_cast<std::int32_t>(out.walls.vertex.size());
  out.walls.vertex.insert(out.walls.vertex.end(), part.mesh.vertex.begin(), part.mesh.vertex.end());
  for (const auto& t : part.mesh.triangle) {
    out.walls.triangle.push_back({t.x + base, t.y + base, t.z + base});
    out.walls.body.push_back(number);
  }
}

/// All triangles are kept whose plan lies in the domain, and vertices without a triangle dropped.
Box grown_domain(const Layout& layout) {
  Box box = layout.domain;
  box.lower.z = -1e300;
  box.upper.z = 1e300;
  if (layout.scene.dimensions == 2) box.lower.y = -1e300, box.upper.y = 1e300;
  return box;
}

void add_walls(const Layout& layout, Case& out) {
  const TriangleMesh walls = crop(layout.walls.mesh, grown_domain(layout));
  out.walls.vertex = walls.vertex;
  out.walls.triangle = walls.triangle;
  out.walls.body.assign(out.walls.triangle.size(), 0);
}

SlideReport add_solid_slide(const Layout& layout, std::size_t k, Case& out, Notes& notes) {
  const Slide& slide = layout.scene.slides[k];
  const SolidPart& part = layout.parts.slides[k];
  SlideReport report;
  report.name = slide.name;
  report.kind = slide.kind;
  report.volume = free_volume(layout, part);
  const double whole = signed_volume(part.mesh) / (layout.scene.dimensions == 2 ? extent(bounds(part.mesh)).y : 1.0);
  report.mass = slide.density * whole;
  check_room(layout, k, report.volume, whole, notes);
  Body body = slide.kind == "prescribed"
                  ? prescribed_slide(slide)
                  : free_body(slide.name, part, slide.density, slide.velocity, layout.scene.dimensions);
  if (slide.kind == "rigid") hold(body, slide.release_at, slide.fixed);
  add_body(layout, part, std::move(body), out);
  return report;
}

void add_bodies_and_slides(const Layout& layout, Case& out, BuildReport& report, const BuildOptions& options) {
  for (std::size_t k = 0; k < layout.parts.moving.size(); ++k) {
    const SolidPart& part = layout.parts.moving[k];
    Body body = moving_body(layout.scene.moving[k], norm(layout.scene.gravity));
    if (body.kind == BodyKind::far_lake)
      body.far_lake =
          far_lake_behind(layout.scene.moving[k], *part.box, out.fluid, layout.lattice.dp, layout.scene.dimensions);
    add_body(layout, part, std::move(body), out);
  }
  for (std::size_t k = 0; k < layout.parts.slides.size(); ++k) {
    const Slide& slide = layout.scene.slides[k];
    if (slide.kind != "granular") {
      report.slides.push_back(add_solid_slide(layout, k, out, report.notes));
    } else {
      report.slides.push_back(add_granular_slide(layout, k, options, out.grains, report.notes));
    }
  }
  for (std::size_t k = 0; k < layout.parts.floating.size(); ++k) {
    const FloatingBody& f = layout.scene.floating[k];
    Body body = free_body(f.name, layout.parts.floating[k], f.density, f.velocity, layout.scene.dimensions);
    hold(body, f.release_at, f.fixed);
    add_body(layout, layout.parts.floating[k], std::move(body), out);
  }
}

/// The domain never cuts a particle off: it grows where layers or grains reach further.
void grow_domain(Case& out, double dp) {
  Box box = out.domain;
  for (const auto* list : {&out.fluid.position, &out.boundary.position, &out.grains.position}) {
    for (const auto& p : *list) extend(box, p);
  }
  for (int a = 0; a < 3; ++a) {
    if (box.lower[a] < out.domain.lower[a]) out.domain.lower[a] = box.lower[a] - 0.5 * dp;
    if (box.upper[a] > out.domain.upper[a]) out.domain.upper[a] = box.upper[a] + 0.5 * dp;
  }
}

}  // namespace

Case build_case(const Scene& scene, BuildReport& report, const BuildOptions& options) {
  Stages stages(report, options.on_stage);
  Case out;
  stages.begin("reading and checking geometry");
  const Layout layout = lay_out(scene, report.notes);
  refuse_slides_elsewhere(layout);
  refuse_slides_beyond_a_period(layout);
  warn_of_measures_outside(layout, report.notes);
  out.scene = scene;
  out.offset = layout.offset;
  out.domain = layout.domain;
  for (const auto& f : layout.parts.files) out.sources.push_back({f, sha256_of_file(f)});
  stages.begin("finding what is solid");
  ColumnIntervals walls;
  const FillSpace space = fill_space(layout, walls);
  stages.begin("filling water");
  fill_fluid(layout, space, out, report);
  name_dry_gauges(layout, out.fluid.position, report.notes);
  warn_of_thin_walls(layout, space, walls, out.fluid.position, report);
  stages.begin("placing walls");
  const std::optional<WaterReach> reach = wanted_walls(layout, space, walls, out.fluid.position, report);
  const WallSurfaces surfaces = reach ? within_reach(layout.walls, *reach, space) : layout.walls;
  const bool fitted = scene.numerics.wall_layers != "lattice";
  const bool everywhere = scene.numerics.wall_layers == "fitted" && scene.dimensions == 2;
  std::vector<BandPoint> band =
      wall_band(layout, surfaces, space, walls, fitted ? fitted_band : boundary_layer_count, options.vdb_path);
  if (reach) keep_reachable(band, space, *reach);
  report.band_voxels = band.size();
  add_tank_layers(layout.parts, layout.lattice, out.boundary);
  const std::size_t first = out.boundary.position.size();
  if (fitted) {
    LayerRequest request{&surfaces.mesh, layout.lattice, layout.domain, {}, {}, 0.0};
    if (!everywhere)
      request.wet = out.fluid.position, request.wet_reach = (2.0 * scene.numerics.smoothing_ratio + 1.5) * scene.dp;
    add_fitted_layers(band, layout.parts, std::move(request), out.boundary);
  } else {
    add_band_layers(band, layout.parts, layout.lattice, out.boundary);
  }
  const std::size_t last = out.boundary.position.size();
  add_walls(layout, out);
  stages.begin("placing bodies and slides");
  add_bodies_and_slides(layout, out, report, options);
  mark_symmetry_planes(layout.parts, 1.0e-4 * scene.dp, out.walls);
  const std::vector<double> top = column_tops(space, out.fluid.position);
  const bool moves = everywhere && first < last;
  if (moves)
    relax_water(out.fluid.position, out.boundary, first, last, space, scene.numerics.smoothing_ratio * scene.dp);
  thin_to_pores(out.fluid.position, porous_regions(layout, space), space);
  if (moves || !layout.lattice.row_shift.empty()) set_start_pressure(layout, space, top, out.fluid);
  set_start_velocity(layout, out);
  const Box ground = bounds(layout.parts.terrain), all = bounds(layout.parts);
  out.terrain_top = is_empty(ground) ? (is_empty(all) ? 0.0 : all.upper.z) : ground.upper.z;
  grow_domain(out, scene.dp);
  return out;
}

}  // namespace gdesp::geometry
