// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/misplaced.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.hpp"

namespace gdesp::geometry {
namespace {

constexpr double nothing = 1e-6;  // of the volume
constexpr double worth_a_word = 0.02;
constexpr double nearly_all = 0.9;  // of the ground, below a level

std::string number(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", v);
  return text;
}

std::string percent(double share) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g %%", 100.0 * share);
  return text;
}

bool apart(const Box& a, const Box& b, int dimensions) {
  for (int axis = 0; axis < (dimensions == 2 ? 1 : 2); ++axis) {
    if (a.upper[axis] < b.lower[axis] || a.lower[axis] > b.upper[axis]) return true;
  }
  return false;
}

Box around(const std::vector<Vec3d>& points) {
  Box box = empty_box();
  for (const Vec3d& p : points) extend(box, p);
  return box;
}

std::string slide_text(const Layout& layout, std::size_t slide) {
  return "slide \"" + layout.scene.slides[slide].name + "\" (" +
         span_text(bounds(layout.parts.slides[slide].mesh), layout.offset, true) + ")";
}

}  // namespace

std::string span_text(const Box& box, const Vec3d& offset, bool heights) {
  std::string text;
  for (int a = 0; a < (heights ? 3 : 2); ++a) {
    const std::string low = number(box.lower[a] + offset[a]), high = number(box.upper[a] + offset[a]);
    text +=
        (a == 0 ? "" : ", ") + std::string(1, "xyz"[a]) + " " + low + " m" + (low == high ? "" : " to " + high + " m");
  }
  return text;
}

void warn_of_measures_outside(const Layout& layout, Notes& notes) {
  const Box domain{layout.domain.lower + layout.offset,
                   layout.domain.upper + layout.offset};  // measures stay in the scene's coordinates
  const auto look = [&](const std::string& what, const Box& box) {
    if (!apart(box, domain, layout.scene.dimensions)) return;
    notes.warnings.push_back(what + " (" + span_text(box, {}) + ") lies outside the domain (" + span_text(domain, {}) +
                             "): it will read nothing");
  };
  for (const Gauge& g : layout.scene.gauges) look("gauge \"" + g.name + "\"", {g.at, g.at});
  for (const Section& s : layout.scene.sections)
    look("section \"" + s.name + "\"", around({{s.from.x, s.from.y, 0.0}, {s.to.x, s.to.y, 0.0}}));
  for (const Region& r : layout.scene.regions) {
    std::vector<Vec3d> corner;
    for (const Point2& p : r.polygon) corner.push_back({p.x, p.y, 0.0});
    if (!corner.empty()) look("region \"" + r.name + "\"", around(corner));
  }
}

void name_dry_gauges(const Layout& layout, const std::vector<Vec3d>& water, Notes& notes) {
  const bool plane = layout.scene.dimensions == 2;
  const double reach = layout.lattice.dp;  // a lattice column is nearer than that wherever there is one
  const Box domain{layout.domain.lower + layout.offset, layout.domain.upper + layout.offset};
  for (const Gauge& g : layout.scene.gauges) {
    const Vec3d at = g.at - layout.offset;
    const bool wet = std::any_of(water.begin(), water.end(), [&](const Vec3d& p) {
      return std::abs(p.x - at.x) < reach && (plane || std::abs(p.y - at.y) < reach);
    });
    if (wet || apart({g.at, g.at}, domain, layout.scene.dimensions)) continue;
    notes.done.push_back("gauge \"" + g.name + "\" (" + span_text({g.at, g.at}, {}) +
                         ") stands on dry ground, or in water shallower than half a particle spacing: it reads nothing "
                         "until a wave comes");
  }
}

void refuse_slides_elsewhere(const Layout& layout) {
  const Box ground = bounds(layout.parts.terrain);
  if (is_empty(ground)) return;
  for (std::size_t k = 0; k < layout.parts.slides.size(); ++k) {
    if (!apart(bounds(layout.parts.slides[k].mesh), ground, layout.scene.dimensions)) continue;
    throw Error(ErrorKind::input,
                slide_text(layout, k) + " lies outside the terrain (" + span_text(ground, layout.offset, true) +
                    "); are both in the same coordinates and the same unit (slide.scale, slide.translate)?");
  }
}

void refuse_slides_beyond_a_period(const Layout& layout) {
  for (std::size_t k = 0; k < layout.parts.slides.size(); ++k) {
    const Box box = bounds(layout.parts.slides[k].mesh);
    for (int a = 0; a < 3; ++a) {
      const double low = layout.domain.lower[a], high = layout.domain.upper[a], near = 1e-6 * (high - low);
      if (!is_periodic(layout.scene, a) || (box.lower[a] >= low - near && box.upper[a] <= high + near)) continue;
      throw Error(ErrorKind::input, slide_text(layout, k) + " reaches out of the period of the domain along " +
                                        "xyz"[a] + ", " + number(low + layout.offset[a]) + " m to " +
                                        number(high + layout.offset[a]) +
                                        " m (domain.periodic): cut its mesh to the period, or widen domain");
    }
  }
}

void check_room(const Layout& layout, std::size_t slide, double free, double whole, Notes& notes) {
  const std::string what = slide_text(layout, slide);
  const Box ground = bounds(layout.parts.terrain);
  const double share = whole > 0.0 ? free / whole : 0.0;
  if (share < nothing) {
    throw Error(ErrorKind::input,
                what + " has no room: all of it lies inside the terrain, a wall or a body" +
                    (is_empty(ground) ? "" : "; the terrain spans " + span_text(ground, layout.offset, true)));
  }
  if (share < 1.0 - worth_a_word) {
    notes.warnings.push_back(
        what + ": " + percent(1.0 - share) +
        " of its volume lies inside the terrain, a wall or a body, or where there is no terrain, and is left out");
  }
}

std::string level_hint(const FillSpace& space, double level) {
  std::size_t known = 0, below = 0;
  double highest = -1e300;
  for (const double g : space.ground) {
    if (!std::isfinite(g)) continue;
    ++known;
    below += g < level;
    highest = std::max(highest, g);
  }
  const double share = known > 0 ? static_cast<double>(below) / static_cast<double>(known) : 0.0;
  if (share < nearly_all) return {};
  return "; the level of " + number(level + space.offset.z) + " m stands above " + percent(share) +
         " of the ground, whose highest point is at " + number(highest + space.offset.z) +
         " m: are level and terrain in one unit and datum (terrain.vertical_scale, terrain.vertical_offset)?";
}

}  // namespace gdesp::geometry
