// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/water_fill.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/error.hpp"
#include "geometry/point_cells.hpp"

namespace gdesp::geometry {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double flat_clearance = 0.45;  // dp, of fluid from flat walls: half a spacing with room for rounding

std::string metres(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g m", v);
  return text;
}

std::string metres_at(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.10g m", v);
  return text;
}

/// Whether flat walls and box-shaped bodies leave room for a particle here.
bool is_clear(const Vec3d& p, const SceneParts& parts, const Lattice& lattice) {
  const double need = flat_clearance * lattice.dp;
  bool in_tank = true;
  for (const auto& w : parts.walls) {
    if (w.kind != WallPart::Kind::tank) continue;
    in_tank = tank_clearance(w, p) >= need;
    if (in_tank) break;
  }
  if (!in_tank) return false;
  for (const auto* list : {&parts.moving, &parts.floating}) {
    for (const auto& b : *list) {
      if (b.box && box_distance(*b.box, p, lattice.dimensions) < need) return false;
    }
  }
  return true;
}

/// Lattice points of the given intervals that lie in the domain and clear of flat walls.
std::vector<Vec3d> lattice_points(const ColumnIntervals& inside, const FillSpace& s, const SceneParts& parts) {
  std::vector<Vec3d> out;
  const ColumnGrid& grid = s.columns.grid;
  const std::int32_t low = s.lattice.first_at_or_above(2, s.domain.lower.z),
                     high = s.lattice.last_at_or_below(2, s.domain.upper.z);
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      const std::size_t c = grid.index(i, j);
      for (std::size_t k = inside.first[c]; k < inside.first[c + 1]; ++k) {
        // The bounds are compared exactly as the walls' inside test does: a point is in the water or in the wall, never both.
        const std::int32_t k0 =
            std::max(low, s.lattice.first_at_or_above(2, std::max(inside.interval[k].lower, s.domain.lower.z)));
        for (std::int32_t m = k0; m <= high && s.lattice.coordinate(2, m) < inside.interval[k].upper; ++m) {
          if (s.lattice.coordinate(2, m) < inside.interval[k].lower) continue;
          const Index3 at{s.columns.i0 + i, s.columns.j0 + j, m};
          if (is_clear(s.lattice.point(at), parts, s.lattice)) out.push_back(s.lattice.place(at));
        }
      }
    }
  }
  return out;
}

double cell_volume(const Lattice& lattice) { return std::pow(lattice.dp, lattice.dimensions); }

double column_volume(const ColumnIntervals& v, const Lattice& lattice) {
  double sum = 0.0;
  for (const auto& i : v.interval) sum += i.upper - i.lower;
  return sum * (lattice.dimensions == 2 ? lattice.dp : lattice.dp * lattice.dp);
}

/// Fill of a basin up to a level: which intervals of the open columns are connected to the seed.
class Basin {
 public:
  Basin(const FluidFill& fill, const FillSpace& space, const std::string& name) : fill_(fill), s_(space), name_(name) {
    ColumnIntervals below;
    const ColumnGrid& grid = s_.columns.grid;
    below.first.assign(grid.count() + 1, 0);
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        if (wanted(i, j)) below.interval.push_back({s_.domain.lower.z, fill.level});
        below.first[grid.index(i, j) + 1] = below.interval.size();
      }
    }
    open_ = subtract(below, s_.solid);
    reached_.assign(open_.interval.size(), false);
  }

  ColumnIntervals flood(FillReport& report) {
    std::vector<std::size_t> stack = {start()};
    std::vector<std::size_t> column_of(open_.interval.size());
    for (std::size_t c = 0; c + 1 < open_.first.size(); ++c) {
      for (std::size_t k = open_.first[c]; k < open_.first[c + 1]; ++k) column_of[k] = c;
    }
    reached_[stack.front()] = true;
    while (!stack.empty()) {
      const std::size_t k = stack.back();
      stack.pop_back();
      visit_neighbours(k, column_of[k], stack, report);
    }
    return connected(report);
  }

 private:
  bool wanted(int i, int j) const {
    return fill_.polygon.empty() || inside_polygon(fill_.polygon, s_.columns.grid.x(i), s_.columns.grid.y(j));
  }

  // Numbers for people are in the scene's own coordinates.
  std::string easting(double x) const { return metres_at(x + s_.offset.x); }
  std::string northing(double y) const { return metres_at(y + s_.offset.y); }
  std::string elevation(double z) const { return metres(z + s_.offset.z); }

  std::size_t start() const { return fill_.seed ? at_seed() : deepest(); }

  std::size_t at_seed() const {
    const ColumnGrid& grid = s_.columns.grid;
    const double fi = std::round((fill_.seed->x - grid.x0) / grid.spacing);
    const double fj = s_.lattice.dimensions == 2 ? 0.0 : std::round((fill_.seed->y - grid.y0) / grid.spacing);
    const std::string where = name_ + ".seed (x = " + easting(fill_.seed->x) + ", y = " + northing(fill_.seed->y) + ")";
    if (fi < 0 || fj < 0 || fi >= grid.nx || fj >= grid.ny) {
      throw Error(ErrorKind::input, where + " lies outside the domain and the terrain, x " + easting(grid.x(0)) +
                                        " to " + easting(grid.x(grid.nx - 1)) + ", y " + northing(grid.y(0)) + " to " +
                                        northing(grid.y(grid.ny - 1)));
    }
    const std::size_t c = grid.index(static_cast<int>(fi), static_cast<int>(fj));
    if (!wanted(static_cast<int>(fi), static_cast<int>(fj)))
      throw Error(ErrorKind::input, where + " lies outside " + name_ + ".polygon");
    if (open_.first[c] == open_.first[c + 1]) {
      const double ground = s_.ground[c];
      throw Error(
          ErrorKind::input,
          where + (std::isfinite(ground) ? " stands on ground at " + elevation(ground) + ", not below the level of " +
                                               elevation(fill_.level) + "; move it into the basin or raise the level"
                                         : " lies in a wall or where there is no terrain; move it into the basin"));
    }
    return open_.first[c + 1] - 1;
  }

  std::size_t deepest() const {
    std::size_t best = open_.interval.size();
    double lowest = infinity;
    for (std::size_t k = 0; k < open_.interval.size(); ++k) {
      if (open_.interval[k].lower < lowest - 1e-9) lowest = open_.interval[k].lower, best = k;
    }
    if (best == open_.interval.size()) {
      throw Error(ErrorKind::input,
                  name_ + ".level = " + elevation(fill_.level) + " is below the bed; " + lowest_ground_text());
    }
    return best;
  }

  std::string lowest_ground_text() const {
    const ColumnGrid& grid = s_.columns.grid;
    double lowest = infinity;
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        const double g = s_.ground[grid.index(i, j)];
        if (wanted(i, j) && g < lowest) lowest = g;
      }
    }
    if (lowest == infinity) return "there is no terrain inside its polygon and the domain";
    return "the lowest ground " + std::string(fill_.polygon.empty() ? "" : "inside its polygon ") + "lies at " +
           elevation(lowest);
  }

  void visit_neighbours(std::size_t k, std::size_t column, std::vector<std::size_t>& stack, FillReport& report) {
    const ColumnGrid& grid = s_.columns.grid;
    const int i = static_cast<int>(column % grid.nx), j = static_cast<int>(column / grid.nx);
    const int step[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    for (int d = 0; d < (s_.lattice.dimensions == 2 ? 2 : 4); ++d) {
      int a = i + step[d][0], b = j + step[d][1];
      if (s_.periodic[0]) a = (a + grid.nx) % grid.nx;
      if (s_.periodic[1]) b = (b + grid.ny) % grid.ny;
      const bool outside = a < 0 || b < 0 || a >= grid.nx || b >= grid.ny;
      if (!outside && wanted(a, b)) {
        flow_into(k, grid.index(a, b), stack);
        if (!missing(a, b)) continue;
      }
      if (!outside && !missing(a, b) && held(k, grid.index(a, b))) continue;
      if (open_.interval[k].upper - open_.interval[k].lower < s_.lattice.dp) continue;
      report.open_edge += s_.lattice.dp;
      report.open_edge_at = {grid.x(i), grid.y(j), open_.interval[k].lower};
    }
  }

  void flow_into(std::size_t k, std::size_t column, std::vector<std::size_t>& stack) {
    for (std::size_t m = open_.first[column]; m < open_.first[column + 1]; ++m) {
      if (reached_[m] || open_.interval[m].lower >= open_.interval[k].upper ||
          open_.interval[m].upper <= open_.interval[k].lower)
        continue;
      reached_[m] = true;
      stack.push_back(m);
    }
  }

  /// A column that is solid only because the terrain ends there holds no water.
  bool missing(int a, int b) const {
    const std::size_t c = s_.columns.grid.index(a, b);
    if (std::isfinite(s_.ground[c])) return false;
    return s_.solid.first[c + 1] - s_.solid.first[c] == 1 && s_.solid.interval[s_.solid.first[c]].lower == -infinity &&
           s_.solid.interval[s_.solid.first[c]].upper == infinity;
  }

  /// Whether the solid of a column outside the polygon stands in front of the whole interval.
  bool held(std::size_t k, std::size_t column) const {
    const Interval& w = open_.interval[k];
    for (std::size_t m = s_.solid.first[column]; m < s_.solid.first[column + 1]; ++m) {
      if (s_.solid.interval[m].lower <= w.lower && s_.solid.interval[m].upper >= w.upper - s_.lattice.dp) return true;
    }
    return false;
  }

  ColumnIntervals connected(FillReport& report) const {
    ColumnIntervals out;
    out.first.assign(open_.first.size(), 0);
    report.lowest_ground = infinity;
    std::size_t surface = 0;
    for (std::size_t c = 0; c + 1 < open_.first.size(); ++c) {
      for (std::size_t k = open_.first[c]; k < open_.first[c + 1]; ++k) {
        if (!reached_[k]) continue;
        out.interval.push_back(open_.interval[k]);
        if (open_.interval[k].lower < report.lowest_ground) {
          const ColumnGrid& grid = s_.columns.grid;
          report.lowest_ground = open_.interval[k].lower;
          report.lowest_at = {grid.x(static_cast<int>(c) % grid.nx), grid.y(static_cast<int>(c) / grid.nx),
                              report.lowest_ground};
        }
        surface += open_.interval[k].upper == fill_.level;
      }
      out.first[c + 1] = out.interval.size();
    }
    report.surface_area =
        static_cast<double>(surface) * (s_.lattice.dimensions == 2 ? s_.lattice.dp : s_.lattice.dp * s_.lattice.dp);
    return out;
  }

  const FluidFill& fill_;
  const FillSpace& s_;
  const std::string& name_;
  ColumnIntervals open_;
  std::vector<bool> reached_;
};

ColumnIntervals box_columns(const Box& box, const FillSpace& s) {
  ColumnIntervals out;
  const ColumnGrid& grid = s.columns.grid;
  const bool flat = s.lattice.dimensions == 2;
  out.first.assign(grid.count() + 1, 0);
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      const double x = grid.x(i), y = grid.y(j), e = 1e-9 * s.lattice.dp;
      const bool in =
          x > box.lower.x + e && x < box.upper.x - e && (flat || (y > box.lower.y + e && y < box.upper.y - e));
      if (in) out.interval.push_back({box.lower.z, box.upper.z});
      out.first[grid.index(i, j) + 1] = out.interval.size();
    }
  }
  return subtract(out, s.solid);
}

bool in_region(const PorousRegion& region, const Vec3d& p, const FillSpace& s) {
  const bool flat = s.lattice.dimensions == 2;
  if (region.box) return box_distance(*region.box, p, s.lattice.dimensions) == 0.0;
  const ColumnGrid& grid = s.columns.grid;
  const int i = static_cast<int>(std::lround((p.x - grid.x0) / grid.spacing));
  const int j = flat ? 0 : static_cast<int>(std::lround((p.y - grid.y0) / grid.spacing));
  return i >= 0 && j >= 0 && i < grid.nx && j < grid.ny && region.inside.contains(grid.index(i, j), p.z);
}

/// Numbers of points along each axis.
using Counts = std::array<int, 3>;

/// Spacings as near to `wanted` as whole numbers along each axis can be.
Counts nearest_counts(const Box& box, double wanted, int dimensions) {
  Counts n;
  for (int a = 0; a < 3; ++a) {
    const double length = box.upper[a] - box.lower[a];
    n[a] = dimensions == 2 && a == 1 ? 1 : std::max(1, static_cast<int>(std::lround(length / wanted)));
  }
  return n;
}

/// As many points in all as cells of the size `wanted` would be, from spacings that differ little: a box of a few spacings cannot have
/// both. Along z any number, along x and y one of the two nearest.
Counts volume_counts(const Box& box, double wanted, int dimensions) {
  const Vec3d length = box.upper - box.lower;
  const bool flat = dimensions == 2;
  const double cells = length.x / wanted * (flat ? 1.0 : length.y / wanted) * length.z / wanted;
  const auto below = [&](int a) { return static_cast<int>(std::floor(length[a] / wanted)); };
  Counts best{};
  double best_fault = infinity;
  for (int x = std::max(1, below(0)); x <= below(0) + 1; ++x) {
    for (int y = flat ? 1 : std::max(1, below(1)); y <= (flat ? 1 : below(1) + 1); ++y) {
      const int z = std::max(1, static_cast<int>(std::lround(cells / (x * y))));
      const double dx = length.x / x, dy = flat ? dx : length.y / y, dz = length.z / z;
      const double fault =
          std::abs(x * y * z / cells - 1.0) + 0.25 * (std::max({dx, dy, dz}) / std::min({dx, dy, dz}) - 1.0);
      if (fault < best_fault) {
        best = {x, y, z};
        best_fault = fault;
      }
    }
  }
  return best;
}

/// A lattice over a box, fitted to the box's faces; `use` gets each point.
template <class Use>
void fitted_lattice(const Box& box, const Counts& n, int dimensions, const Use& use) {
  Vec3d step;
  for (int a = 0; a < 3; ++a) step[a] = (box.upper[a] - box.lower[a]) / n[a];
  for (int i = 0; i < n[0]; ++i) {
    for (int j = 0; j < n[1]; ++j) {
      for (int k = 0; k < n[2]; ++k) {
        Vec3d p = box.lower + Vec3d{(i + 0.5) * step.x, (j + 0.5) * step.y, (k + 0.5) * step.z};
        if (dimensions == 2) p.y = 0.0;
        use(p);
      }
    }
  }
}

/// Whether the column nearest to p is solid at p.
bool in_solid(const Vec3d& p, const FillSpace& s) {
  const ColumnGrid& grid = s.columns.grid;
  const int i = static_cast<int>(std::lround((p.x - grid.x0) / grid.spacing));
  const int j = s.lattice.dimensions == 2 ? 0 : static_cast<int>(std::lround((p.y - grid.y0) / grid.spacing));
  return i < 0 || j < 0 || i >= grid.nx || j >= grid.ny || s.solid.contains(grid.index(i, j), p.z);
}

std::vector<Vec3d> box_points(const Box& box, const FillSpace& s, const SceneParts& parts) {
  std::vector<Vec3d> out;
  fitted_lattice(box, nearest_counts(box, s.lattice.dp, s.lattice.dimensions), s.lattice.dimensions,
                 [&](const Vec3d& p) {
                   if (in_solid(p, s) || !is_clear(p, parts, s.lattice)) return;
                   out.push_back(p + Vec3d{0.0, 0.0, s.lattice.shift_at(p.z)});
                 });
  return out;
}

}  // namespace

std::vector<Vec3d> fill_water(const FluidFill& fill, const SolidPart& mesh, const FillSpace& space,
                              const SceneParts& parts, const std::string& name, FillReport& report) {
  report.kind = fill.kind;
  ColumnIntervals water;
  std::vector<Vec3d> points;
  if (fill.kind == "level") {
    report.level = fill.level;
    water = Basin(fill, space, name).flood(report);
  } else if (fill.kind == "box") {
    report.level = fill.box->upper.z;
    water = box_columns(*fill.box, space);
    points = box_points(*fill.box, space, parts);
  } else {
    report.level = bounds(mesh.mesh).upper.z;
    water = subtract(solid_intervals(mesh.mesh, space.columns.grid), space.solid);
  }
  if (fill.kind != "box") points = lattice_points(water, space, parts);
  report.particles = points.size();
  report.volume = static_cast<double>(points.size()) * cell_volume(space.lattice);
  report.exact_volume = column_volume(water, space.lattice);
  if (points.empty()) {
    throw Error(ErrorKind::input, name + " (" + fill.kind +
                                      ") holds no particle at resolution.dp = " + metres(space.lattice.dp) +
                                      ": it lies outside the domain, inside a solid, or is thinner than dp");
  }
  return points;
}

void add_fill(std::vector<Vec3d>& fluid, std::vector<Vec3d> more, double dp) {
  if (fluid.empty()) {
    fluid = std::move(more);
    return;
  }
  const PointCells there(fluid, dp);
  for (const auto& p : more) {
    if (!there.any_within(p, 0.5 * dp)) fluid.push_back(p);
  }
}

void thin_to_pores(std::vector<Vec3d>& fluid, const std::vector<PorousRegion>& porous, const FillSpace& s) {
  for (const auto& region : porous) {
    std::vector<Vec3d> kept, replaced;
    for (const auto& p : fluid) (in_region(region, p, s) ? replaced : kept).push_back(p);
    if (replaced.empty()) continue;
    const PointCells wet(replaced, s.lattice.dp);
    const double wanted = s.lattice.dp / std::pow(region.porosity, 1.0 / s.lattice.dimensions);
    const Counts counts = volume_counts(region.bounds, wanted, s.lattice.dimensions);
    fitted_lattice(region.bounds, counts, s.lattice.dimensions, [&](const Vec3d& p) {
      if (in_region(region, p, s) && wet.any_within(p, 0.9 * s.lattice.dp)) kept.push_back(p);
    });
    fluid = std::move(kept);
  }
}

}  // namespace gdesp::geometry
