// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/run_info.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "io/case.hpp"

namespace gdesp::analysis {
namespace {

void find_extent(RunInfo& info, const std::vector<Vec3d>& position) {
  info.fluid_count = position.size();
  if (position.empty()) return;
  info.fluid_lower = info.fluid_upper = position[0];
  for (const Vec3d& p : position) {
    for (int axis = 0; axis < 3; ++axis) {
      info.fluid_lower[axis] = std::min(info.fluid_lower[axis], p[axis]);
      info.fluid_upper[axis] = std::max(info.fluid_upper[axis], p[axis]);
    }
  }
  info.lake = find_long_axis(position);
}

std::optional<Vec3d> centre_of_slide(const Case& c) {
  Vec3d sum;
  if (!c.grains.position.empty()) {
    for (const Vec3d& p : c.grains.position) sum += p;
    return sum * (1.0 / static_cast<double>(c.grains.position.size()));
  }
  for (const Slide& slide : c.scene.slides) {
    for (std::size_t k = 0; k < c.bodies.size(); ++k) {
      if (c.bodies[k].name != slide.name) continue;
      std::size_t count = 0;
      for (std::size_t t = 0; t < c.walls.triangle.size(); ++t) {
        if (t >= c.walls.body.size() || c.walls.body[t] != static_cast<std::int32_t>(k) + 1) continue;
        sum += c.walls.vertex[c.walls.triangle[t].x];
        ++count;
      }
      if (count > 0) return sum * (1.0 / static_cast<double>(count));
    }
  }
  return std::nullopt;
}

}  // namespace

RunInfo read_run_info(const std::string& case_path) {
  Case c = read_case(case_path);
  RunInfo info;
  info.case_path = case_path;
  info.has_case = true;
  info.offset = c.offset;
  info.domain = c.domain;
  info.dimensions = c.scene.dimensions;
  info.dp = c.scene.dp;
  if (!c.fluid.position.empty()) info.still_water_level = c.still_water_level;
  find_extent(info, c.fluid.position);
  info.slide_centre = centre_of_slide(c);
  info.walls = std::move(c.walls);
  info.scene = std::move(c.scene);
  return info;
}

void complete_from_fluid(RunInfo& info, const FluidTable& fluid) {
  find_extent(info, fluid.position);
  if (info.dimensions == 0) { info.dimensions = info.fluid_upper.y - info.fluid_lower.y < 0.5 * info.dp ? 2 : 3; }
  info.domain = {info.fluid_lower, info.fluid_upper};
}

std::vector<BankRegion> bank_regions(const RunInfo& info) {
  std::vector<BankRegion> regions{{"all", {}, {}, {}}};
  for (const Region& r : info.scene.regions) {
    BankRegion region{r.name, r.polygon, {}, {}};
    for (Point2& p : region.polygon) p.x -= info.offset.x, p.y -= info.offset.y;
    regions.push_back(std::move(region));
  }
  if (regions.size() > 1 || info.dimensions == 2 || !info.slide_centre || info.fluid_count == 0) return regions;
  // No region in the scene: the two sides of the lake's long axis, the slide's own and the one it faces.
  const Point2 d = info.lake.direction, c = info.lake.centre;
  const double side = d.x * (info.slide_centre->y - c.y) - d.y * (info.slide_centre->x - c.x);
  const Point2 to_slide = side >= 0.0 ? d : Point2{-d.x, -d.y};
  regions.push_back({"near bank", {}, c, to_slide});
  regions.push_back({"far bank", {}, c, Point2{-to_slide.x, -to_slide.y}});
  return regions;
}

std::vector<Section> sections_in_case(const RunInfo& info) {
  std::vector<Section> sections = info.scene.sections;
  for (Section& s : sections) {
    s.from.x -= info.offset.x, s.from.y -= info.offset.y;
    s.to.x -= info.offset.x, s.to.y -= info.offset.y;
  }
  return sections;
}

Section find_section(const RunInfo& info, const std::string& name) {
  std::string known;
  for (const Section& s : sections_in_case(info)) {
    if (s.name == name) return s;
    known += (known.empty() ? "" : ", ") + s.name;
  }
  throw Error(ErrorKind::usage, "--section " + name + ": the scene has " +
                                    (known.empty() ? "no sections; give --line x1,y1,x2,y2" : "the sections " + known));
}

}  // namespace gdesp::analysis
