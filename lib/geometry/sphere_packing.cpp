// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/sphere_packing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/error.hpp"
#include "geometry/packing_relaxation.hpp"
#include "geometry/random.hpp"
#include "geometry/triangle_tree.hpp"

namespace gdesp::geometry {
namespace {

/// Diameters that together hold the solid's share of the volume, in random order.
std::vector<float> draw_diameters(const PackingRequest& r, double solid_volume, Random& random) {
  std::vector<float> out;
  if (!r.sieve.empty()) {
    double shares = 0.0;
    for (const auto& c : r.sieve) shares += c.mass_share;
    for (const auto& c : r.sieve) {
      const double n = solid_volume * c.mass_share / shares / grain_volume(c.diameter, r.dimensions);
      out.insert(out.end(), static_cast<std::size_t>(std::llround(n)), static_cast<float>(c.diameter));
    }
  } else if (r.deviation <= 0.0 && r.half_width <= 0.0) {
    out.assign(static_cast<std::size_t>(std::llround(solid_volume / grain_volume(r.diameter, r.dimensions))),
               static_cast<float>(r.diameter));
  } else {
    for (double filled = 0.0; filled < solid_volume;) {
      const double d = r.diameter + (r.half_width > 0.0 ? r.half_width * random.signed_unit()
                                                        : r.deviation * std::clamp(random.normal(), -3.0, 3.0));
      const double v = grain_volume(d, r.dimensions);
      if (filled + 0.5 * v > solid_volume) break;
      filled += v;
      out.push_back(static_cast<float>(d));
    }
  }
  for (std::size_t k = out.size(); k > 1; --k) std::swap(out[k - 1], out[random.below(k)]);
  return out;
}

/// Points of a cubic lattice of the given spacing inside the space and at least `inset` from every wall.
std::vector<Vec3d> lattice_sites(const PackingRequest& r, const TriangleTree& walls, double spacing, double inset) {
  ColumnGrid grid = covering_columns(r.box, spacing);
  if (r.dimensions == 2) grid.y0 = 0.0, grid.ny = 1;
  const ColumnIntervals space = r.space(grid);
  std::vector<Vec3d> sites;
  for (int i = 0; i < grid.nx; ++i) {
    for (int j = 0; j < grid.ny; ++j) {
      const std::size_t c = grid.index(i, j);
      for (std::size_t k = space.first[c]; k < space.first[c + 1]; ++k) {
        const double low = space.interval[k].lower, length = space.interval[k].upper - low;
        const int n = std::max(1, static_cast<int>(std::lround(length / spacing)));
        if (length < inset) continue;
        for (int m = 0; m < n; ++m) {
          const Vec3d p{grid.x(i), grid.y(j), low + (m + 0.5) * length / n};
          if (walls.nearest(p, inset).triangle < 0) sites.push_back(p);
        }
      }
    }
  }
  return sites;
}

/// At least `wanted` sites, as evenly spread as they come; fewer only when the space is too tight.
std::vector<Vec3d> enough_sites(const PackingRequest& r, const TriangleTree& walls, double volume, std::size_t wanted,
                                double inset) {
  double spacing = std::pow(volume / static_cast<double>(wanted), 1.0 / r.dimensions);
  std::vector<Vec3d> best;
  for (int attempt = 0; attempt < 12; ++attempt) {
    std::vector<Vec3d> sites = lattice_sites(r, walls, spacing, inset);
    if (sites.size() > best.size()) best = sites;
    if (sites.size() >= wanted) return sites;
    const double ratio =
        std::max(static_cast<double>(sites.size()), 0.2 * static_cast<double>(wanted)) / static_cast<double>(wanted);
    spacing *= std::min(0.995, std::pow(ratio, 1.0 / r.dimensions));
  }
  return best;
}

void keep_random(std::vector<Vec3d>& sites, std::size_t wanted, Random& random) {
  std::vector<std::size_t> order(sites.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t k = 0; k < wanted; ++k) std::swap(order[k], order[k + random.below(order.size() - k)]);
  order.resize(wanted);
  std::sort(order.begin(), order.end());  // keeps neighbours near each other in memory
  std::vector<Vec3d> kept;
  kept.reserve(wanted);
  for (const std::size_t k : order) kept.push_back(sites[k]);
  sites = std::move(kept);
}

void jitter(std::vector<Vec3d>& sites, const TriangleTree& walls, double reach, double inset, int dimensions,
            Random& random) {
  for (auto& p : sites) {
    const Vec3d by{random.signed_unit() * reach, dimensions == 2 ? 0.0 : random.signed_unit() * reach,
                   random.signed_unit() * reach};
    if (walls.nearest(p, inset + norm(by)).triangle < 0) p += by;
  }
}

void require_one(bool any, const PackingRequest& r, double volume) {
  if (!any)
    throw Error(ErrorKind::input, r.name + (r.name.empty() ? "" : ": ") + "no grain of diameter " +
                                      std::to_string(grain_sizes(r).mean) + " m fits its " + std::to_string(volume) +
                                      (r.dimensions == 2 ? " m2" : " m3"));
}

/// Spheres spread over the space, overlapping; out.left_out are those without a site.
void scatter(const PackingRequest& r, const TriangleTree& walls, Packing& out) {
  Random random(r.seed);
  out.volume = r.volume > 0.0 ? r.volume : space_volume(r);
  out.diameter = draw_diameters(r, out.volume * (1.0 - r.porosity), random);
  const double smallest = grain_sizes(r).smallest, inset = 0.4 * smallest;
  const std::size_t wanted = out.diameter.size();
  if (wanted > 0) out.position = enough_sites(r, walls, out.volume, wanted, inset);
  require_one(!out.position.empty(), r, out.volume);
  if (out.position.size() > wanted) keep_random(out.position, wanted, random);
  out.diameter.resize(out.position.size());
  out.left_out = wanted - out.position.size();
  jitter(out.position, walls, 0.25 * smallest, inset, r.dimensions, random);
}

double porosity_of(const PackingRequest& r, const Packing& p) {
  double solid = 0.0;
  for (const float d : p.diameter) solid += grain_volume(d, r.dimensions);
  return 1.0 - solid / p.volume;
}

}  // namespace

double space_volume(const PackingRequest& r) {
  const Vec3d size = extent(r.box);
  const double widest = r.dimensions == 2 ? size.x : std::max(size.x, size.y);
  ColumnGrid grid = covering_columns(r.box, widest / 800.0);
  if (r.dimensions == 2) grid.y0 = 0.0, grid.ny = 1;
  const auto length = [](const ColumnIntervals& c) {
    double sum = 0.0;
    for (const auto& i : c.interval) sum += i.upper - i.lower;
    return sum;
  };
  const double whole = length(solid_intervals(r.body, grid)), part = length(r.space(grid));
  if (!(whole > 0.0)) return 0.0;
  const double exact = signed_volume(r.body) / (r.dimensions == 2 ? size.y : 1.0);
  return exact * part / whole;
}

double grain_volume(double d, int dimensions) {
  return std::numbers::pi * (dimensions == 2 ? d * d / 4.0 : d * d * d / 6.0);
}

GrainSizes grain_sizes(const PackingRequest& r) {
  const double reach = std::max(3.0 * r.deviation, r.half_width);
  if (r.sieve.empty()) return {r.diameter, r.diameter - reach, r.diameter + reach};
  GrainSizes s{r.sieve.front().diameter, r.sieve.front().diameter, r.sieve.front().diameter};
  for (const auto& c : r.sieve)
    s.smallest = std::min(s.smallest, c.diameter), s.largest = std::max(s.largest, c.diameter);
  return s;
}

TriangleMesh bounding_walls(const PackingRequest& r) {
  TriangleMesh walls = r.walls;
  if (r.dimensions != 2) return walls;
  std::erase_if(walls.triangle, [&](const auto& t) {
    const Vec3d a = walls.vertex[static_cast<std::size_t>(t.x)];
    const Vec3d n =
        cross(walls.vertex[static_cast<std::size_t>(t.y)] - a, walls.vertex[static_cast<std::size_t>(t.z)] - a);
    return std::abs(n.y) > 0.5 * norm(n);
  });
  return walls;
}

Packing scatter_spheres(const PackingRequest& r) {
  Packing out;
  scatter(r, TriangleTree(bounding_walls(r)), out);
  out.porosity = porosity_of(r, out);
  return out;
}

Packing pack_spheres(const PackingRequest& r) {
  Packing out;
  const TriangleTree walls(bounding_walls(r));
  scatter(r, walls, out);
  const std::size_t wanted = out.position.size() + out.left_out;
  const double largest = grain_sizes(r).largest;
  PackingState state{std::move(out.position), std::move(out.diameter), r.dimensions};
  out.iterations = relax_overlaps(state, walls, largest);
  drop_misplaced(state, walls, r.contains, largest);
  out.left_out = wanted - state.position.size();
  out.largest_overlap = largest_overlap(state, walls, largest);
  out.position = std::move(state.position);
  out.diameter = std::move(state.diameter);
  require_one(!out.position.empty(), r, out.volume);
  out.porosity = porosity_of(r, out);
  return out;
}

void measure(const PackingRequest& r, Packing& p) {
  p.largest_overlap =
      largest_overlap({p.position, p.diameter, r.dimensions}, TriangleTree(bounding_walls(r)), grain_sizes(r).largest);
  p.porosity = porosity_of(r, p);
}

}  // namespace gdesp::geometry
