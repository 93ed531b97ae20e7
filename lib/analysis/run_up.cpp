// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/run_up.hpp"

#include <algorithm>
#include <cmath>

namespace gdesp::analysis {

bool point_in_polygon(const std::vector<Point2>& polygon, double x, double y) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Point2 &a = polygon[i], &b = polygon[j];
    if ((a.y > y) != (b.y > y) && x < (b.x - a.x) * (y - a.y) / (b.y - a.y) + a.x) inside = !inside;
  }
  return inside;
}

bool BankRegion::contains(double x, double y) const {
  if (side_of && side_axis.x * (y - side_of->y) - side_axis.y * (x - side_of->x) < 0.0) return false;
  return polygon.empty() || point_in_polygon(polygon, x, y);
}

namespace {

template <class Visit>
void visit_near(const ColumnGrid& grid, std::size_t s, double distance, const Visit& visit) {
  const Vec3d p = grid.position(s);
  grid.for_each(p.x, p.y, p.z - distance, p.z + distance, [&](std::size_t t, double r2) {
    const double dz = grid.position(t).z - p.z;
    if (t != s && r2 + dz * dz < distance * distance) visit(t);
  });
}

/// Whether particle s lies on a wall with no other water over it.
bool is_single_layer(const ColumnGrid& grid, std::size_t s, double dp, const WallSurface& walls) {
  if (!walls.nearest(grid.position(s), dp)) return false;
  bool single = true;
  visit_near(grid, s, 1.5 * dp,
             [&](std::size_t t) { single = single && walls.nearest(grid.position(t), dp).has_value(); });
  return single;
}

/// Per slot: the water that counts, the main body and the film that its edge has thinned to (run_up.hpp).
std::vector<std::uint8_t> main_body_and_film(const ColumnGrid& grid, const ConnectedWater& water, const BankContact& at,
                                             const WallSurface& walls) {
  std::vector<std::uint8_t> counts(grid.size());
  std::vector<std::size_t> edge;
  for (std::size_t s = 0; s < grid.size(); ++s) counts[s] = water.main[grid.index(s)];
  if (walls.empty()) return counts;
  const auto is_above = [&](std::size_t s) { return grid.position(s).z + 0.5 * at.dp > at.still_water_level; };
  for (std::size_t s = 0; s < grid.size(); ++s) {
    if (!counts[s] && !water.torn[grid.index(s)] && is_above(s) && is_single_layer(grid, s, at.dp, walls))
      edge.push_back(s);
  }
  const int needed = grid.dimensions() == 2 ? 1 : 3;
  for (std::size_t before = edge.size() + 1; before > edge.size();) {
    before = edge.size();
    std::vector<std::size_t> joined;  // all that join in this round, so that their order is without effect
    std::erase_if(edge, [&](std::size_t s) {
      int neighbours = 0;
      visit_near(grid, s, at.contact, [&](std::size_t t) { neighbours += counts[t]; });
      if (neighbours >= needed) joined.push_back(s);
      return neighbours >= needed;
    });
    for (const std::size_t s : joined) counts[s] = 1;
  }
  return counts;
}

std::vector<BankParticle> find_bank_particles(const ColumnGrid& grid, const std::vector<std::uint8_t>& counts,
                                              const BankContact& at, const WallSurface& walls) {
  std::vector<BankParticle> result;
#pragma omp parallel
  {
    std::vector<BankParticle> mine;
#pragma omp for schedule(static) nowait
    for (std::size_t s = 0; s < grid.size(); ++s) {
      const Vec3d& p = grid.position(s);
      const double height = p.z + 0.5 * at.dp - at.still_water_level;
      if (height <= 0.0 || !counts[s]) continue;
      if (!walls.empty()) {
        const std::optional<Vec3d> bank = walls.nearest(p, at.contact);
        if (!bank || bank->z < at.still_water_level - at.dp) continue;
      }
      mine.push_back({p, height});
    }
#pragma omp critical
    result.insert(result.end(), mine.begin(), mine.end());
  }
  std::sort(result.begin(), result.end(), [](const BankParticle& a, const BankParticle& b) {
    if (a.height != b.height) return a.height > b.height;
    return a.position.x != b.position.x ? a.position.x < b.position.x : a.position.y < b.position.y;
  });
  return result;
}

}  // namespace

RunUpFrame measure_run_up(const ColumnGrid& grid, const ConnectedWater& water, const BankContact& at,
                          const WallSurface& walls, std::span<const BankRegion> regions) {
  RunUpFrame frame;
  const std::vector<std::uint8_t> counts = main_body_and_film(grid, water, at, walls);
  frame.on_bank = find_bank_particles(grid, counts, at, walls);
  frame.region.resize(regions.size());
  for (std::size_t k = 0; k < regions.size(); ++k) {
    for (const BankParticle& p : frame.on_bank) {  // highest first
      if (!regions[k].contains(p.position.x, p.position.y)) continue;
      frame.region[k].height = p.height;
      frame.region[k].at = p.position;
      frame.region[k].climbs = true;
      break;
    }
  }
  for (std::size_t s = 0; s < grid.size(); ++s) {
    if (counts[s]) continue;
    const Vec3d& p = grid.position(s);
    for (std::size_t k = 0; k < regions.size(); ++k) {
      const double height = p.z + 0.5 * at.dp - at.still_water_level;
      if (height > frame.region[k].splash && regions[k].contains(p.x, p.y)) frame.region[k].splash = height;
    }
  }
  return frame;
}

ShoreProfile::ShoreProfile(Point2 from, Point2 to, double width) : from_(from), width_(width) {
  length_ = std::hypot(to.x - from.x, to.y - from.y);
  direction_ = {(to.x - from.x) / length_, (to.y - from.y) / length_};
  bins_.resize(static_cast<std::size_t>(std::ceil(length_ / width)));
  for (std::size_t k = 0; k < bins_.size(); ++k) bins_[k].distance = (static_cast<double>(k) + 0.5) * width;
}

void ShoreProfile::add(double time, std::span<const BankParticle> particles, const BankRegion& region) {
  for (const BankParticle& p : particles) {
    if (!region.contains(p.position.x, p.position.y)) continue;
    const double s = (p.position.x - from_.x) * direction_.x + (p.position.y - from_.y) * direction_.y;
    const double k = std::floor(s / width_);
    if (k < 0.0 || k >= static_cast<double>(bins_.size())) continue;
    Bin& bin = bins_[static_cast<std::size_t>(k)];
    if (bin.any && p.height <= bin.height) continue;
    bin.height = p.height;
    bin.time = time;
    bin.at = p.position;
    bin.any = true;
  }
}

LongAxis find_long_axis(std::span<const Vec3d> position) {
  LongAxis axis;
  if (position.empty()) return axis;
  double sx = 0, sy = 0;
  for (const Vec3d& p : position) sx += p.x, sy += p.y;
  const double n = static_cast<double>(position.size());
  axis.centre = {sx / n, sy / n};
  double xx = 0, yy = 0, xy = 0;
  for (const Vec3d& p : position) {
    const double dx = p.x - axis.centre.x, dy = p.y - axis.centre.y;
    xx += dx * dx, yy += dy * dy, xy += dx * dy;
  }
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  axis.direction = {std::cos(angle), std::sin(angle)};
  double low = 0, high = 0;
  for (const Vec3d& p : position) {
    const double s = (p.x - axis.centre.x) * axis.direction.x + (p.y - axis.centre.y) * axis.direction.y;
    low = std::min(low, s);
    high = std::max(high, s);
  }
  axis.from = {axis.centre.x + low * axis.direction.x, axis.centre.y + low * axis.direction.y};
  axis.to = {axis.centre.x + high * axis.direction.x, axis.centre.y + high * axis.direction.y};
  return axis;
}

}  // namespace gdesp::analysis
