// SPDX-License-Identifier: GPL-3.0-or-later
// All lengths below are in voxels, and coordinates are those of a tile: its voxels' centres are 0 .. 7.
#include "analysis/closed_union.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <unordered_map>

#include "core/error.hpp"

namespace gdesp::analysis {
namespace {

constexpr int edge = 8;
constexpr std::size_t voxels = edge * edge * edge;
constexpr std::int32_t farthest = 1 << 19;  // tile
using Index = Vec3<std::int32_t>;
using Values = std::array<float, voxels>;

std::size_t place(int x, int y, int z) { return (static_cast<std::size_t>(x) * edge + y) * edge + z; }

struct Tile {
  Index at;                       // in tiles
  std::vector<Vec3f> particle;    // in this tile
  bool inside = false;            // wholly within the union
  std::unique_ptr<Values> value;  // distance to the union's surface; none: beyond reach of it
  std::vector<Vec3f> crossing;    // where the surface crosses edges between voxels
};

class TileSet {
 public:
  TileSet(std::span<const Vec3d> position, double voxel) {
    for (std::size_t i = 0; i < position.size(); ++i) {
      const Vec3d p = position[i] * (1.0 / voxel);
      if (!(std::abs(p.x) < farthest * edge && std::abs(p.y) < farthest * edge && std::abs(p.z) < farthest * edge)) {
        throw Error(ErrorKind::numerical, "particle " + std::to_string(i) +
                                              " has a position that is not finite or too far away for a surface");
      }
      const Index at{tile_of(p.x), tile_of(p.y), tile_of(p.z)};
      if (tile.empty() || !(tile[last_].at == at)) last_ = find_or_add(at);
      tile[last_].particle.push_back(Vec3f(p - Vec3d(at) * static_cast<double>(edge)));
    }
  }

  void add_neighbours(int range) {
    const std::size_t count = tile.size();
    for (std::size_t t = 0; t < count; ++t) {
      const Index at = tile[t].at;
      for (int x = -range; x <= range; ++x)
        for (int y = -range; y <= range; ++y)
          for (int z = -range; z <= range; ++z) find_or_add(at + Index{x, y, z});
    }
  }

  const Tile* find(const Index& at) const {
    const auto found = number_.find(key(at));
    return found == number_.end() ? nullptr : &tile[found->second];
  }

  std::vector<Tile> tile;

 private:
  static std::int32_t tile_of(double x) { return static_cast<std::int32_t>(std::floor((std::round(x)) / edge)); }
  static std::uint64_t key(const Index& at) {
    const auto part = [](std::int32_t i) { return static_cast<std::uint64_t>(std::int64_t{i} + 2 * farthest); };
    return part(at.x) << 42 | part(at.y) << 21 | part(at.z);
  }
  std::size_t find_or_add(const Index& at) {
    const auto [place, added] = number_.try_emplace(key(at), static_cast<std::uint32_t>(tile.size()));
    if (added) {
      tile.emplace_back();
      tile.back().at = at;
    }
    return place->second;
  }

  std::unordered_map<std::uint64_t, std::uint32_t> number_;
  std::size_t last_ = 0;
};

int tiles_within(float reach) { return static_cast<int>(std::ceil(reach / edge)); }

// Particles or crossings (`points` says which) no further than `reach` from a tile's voxels, in its coordinates.
template <class Points>
void gather(const TileSet& tiles, const Tile& centre, float reach, const Points& points, std::vector<Vec3f>& near) {
  near.clear();
  const int range = tiles_within(reach);
  const auto beyond = [](float x) { return x - std::clamp(x, 0.0f, edge - 1.0f); };
  for (int x = -range; x <= range; ++x) {
    for (int y = -range; y <= range; ++y) {
      for (int z = -range; z <= range; ++z) {
        const Tile* other = tiles.find(centre.at + Index{x, y, z});
        if (!other) continue;
        const Vec3f shift{static_cast<float>(edge * x), static_cast<float>(edge * y), static_cast<float>(edge * z)};
        for (const Vec3f& local : points(*other)) {
          const Vec3f p = local + shift, far{beyond(p.x), beyond(p.y), beyond(p.z)};
          if (dot(far, far) < reach * reach) near.push_back(p);
        }
      }
    }
  }
}

// Squared distance to the nearest of some points, at most reach^2.
void nearest(const std::vector<Vec3f>& near, float reach, Values& squared) {
  squared.fill(reach * reach);
  const auto first = [&](float x) { return std::max(0, static_cast<int>(std::ceil(x - reach))); };
  const auto last = [&](float x) { return std::min(edge - 1, static_cast<int>(std::floor(x + reach))); };
  for (const Vec3f& p : near) {
    std::array<float, edge> dz2;
    for (int z = 0; z < edge; ++z) dz2[z] = (static_cast<float>(z) - p.z) * (static_cast<float>(z) - p.z);
    for (int x = first(p.x); x <= last(p.x); ++x) {
      const float dx = static_cast<float>(x) - p.x;
      for (int y = first(p.y); y <= last(p.y); ++y) {
        const float dy = static_cast<float>(y) - p.y, r2 = dx * dx + dy * dy;
        float* row = &squared[place(x, y, 0)];
        for (int z = 0; z < edge; ++z) row[z] = std::min(row[z], r2 + dz2[z]);
      }
    }
  }
}

// Distances outside the union are final, those within only tell the side.
void measure_outside(const TileSet& tiles, Tile& tile, float radius, float reach) {
  thread_local std::vector<Vec3f> near;
  const auto particles = [](const Tile& t) -> const std::vector<Vec3f>& { return t.particle; };
  Values squared;
  gather(tiles, tile, radius, particles, near);
  nearest(near, radius, squared);
  tile.inside = std::all_of(squared.begin(), squared.end(), [&](float s) { return s < radius * radius; });
  if (tile.inside) return;
  gather(tiles, tile, reach, particles, near);
  if (near.empty()) return;
  nearest(near, reach, squared);
  tile.value = std::make_unique<Values>();
  for (std::size_t i = 0; i < voxels; ++i) (*tile.value)[i] = std::sqrt(squared[i]) - radius;
}

// The crossings on the edges from this tile's voxels upwards along an axis, and across its lower face from a tile that
// is wholly within.
void find_crossings(const TileSet& tiles, Tile& tile, int axis) {
  Index step{};
  step[axis] = 1;
  const Tile *above = tiles.find(tile.at + step), *below = tiles.find(tile.at - step);
  for (std::size_t i = 0; i < voxels; ++i) {
    Index v{static_cast<int>(i) / (edge * edge), static_cast<int>(i) / edge % edge, static_cast<int>(i) % edge};
    Vec3f p(v);
    const float here = (*tile.value)[i];
    if (v[axis] == 0 && below && below->inside && here >= 0.0f) {
      p[axis] -= std::min(here, 1.0f);
      tile.crossing.push_back(p);
      p = Vec3f(v);
    }
    const bool leaves = ++v[axis] == edge;
    if (leaves) v[axis] = 0;
    const Tile* other = leaves ? above : &tile;
    if (!other || (!other->value && !other->inside)) continue;  // beyond reach: this voxel is outside, too
    const float there = other->inside ? here - 1.0f : (*other->value)[place(v.x, v.y, v.z)];
    if ((here < 0.0f) == (there < 0.0f)) continue;
    p[axis] += here / (here - there);
    tile.crossing.push_back(p);
  }
}

void measure_inside(const TileSet& tiles, Tile& tile, float reach) {
  if (!tile.value && !tile.inside) return;
  thread_local std::vector<Vec3f> near;
  gather(
      tiles, tile, reach, [](const Tile& t) -> const std::vector<Vec3f>& { return t.crossing; }, near);
  if (tile.inside) {
    if (near.empty()) return;
    tile.value = std::make_unique<Values>();
    tile.value->fill(-1.0f);
  }
  Values squared;
  nearest(near, reach, squared);
  for (std::size_t i = 0; i < voxels; ++i) {
    float& value = (*tile.value)[i];
    if (value < 0.0f) value = -std::sqrt(squared[i]);
  }
}

constexpr int padded = edge + 2;
using Padded = std::array<float, padded * padded * padded>;

// A tile's values and one voxel of its neighbours' around them.
void pad(const TileSet& tiles, const Tile& tile, float outside, float inside, Padded& all) {
  const auto part = [](int i) { return i < 0 ? -1 : i >= edge ? 1 : 0; };
  std::array<const Tile*, 27> around;
  for (int n = 0; n < 27; ++n) around[n] = tiles.find(tile.at + Index{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1});
  for (int x = -1; x <= edge; ++x) {
    for (int y = -1; y <= edge; ++y) {
      for (int z = -1; z <= edge; ++z) {
        const Tile* from = around[9 * part(x) + 3 * part(y) + part(z) + 13];
        float& value = all[((x + 1) * padded + y + 1) * padded + z + 1];
        if (!from)
          value = outside;
        else if (from->value)
          value = (*from->value)[place(x & 7, y & 7, z & 7)];
        else
          value = from->inside ? inside : outside;
      }
    }
  }
}

// Sum over the voxel and its two neighbours `stride` away, for all but the outermost of that direction.
void add_neighbours_along(std::size_t stride, Padded& all) {
  Padded sum = all;
  for (std::size_t i = stride; i + stride < all.size(); ++i) sum[i] = all[i - stride] + all[i] + all[i + stride];
  all = sum;
}

// F of a tile, in metres; false when it lies beyond the band everywhere.
bool smooth(const TileSet& tiles, const Tile& tile, const ClosingOptions& o, float outside, float inside,
            VoxelTile& out) {
  if (!tile.value) return false;
  Padded all;
  pad(tiles, tile, outside, inside, all);
  for (const std::size_t stride : {1, padded, padded * padded}) add_neighbours_along(stride, all);
  const float scale = static_cast<float>(o.voxel / 27.0), shift = static_cast<float>(o.inwards);
  const float end = static_cast<float>(o.half_width * o.voxel);
  bool any = false;
  for (int x = 0; x < edge; ++x) {
    for (int y = 0; y < edge; ++y) {
      for (int z = 0; z < edge; ++z) {
        const float f = scale * all[((x + 1) * padded + y + 1) * padded + z + 1] + shift;
        any = any || std::abs(f) < end;
        out.value[place(x, y, z)] = std::clamp(f, -end, end);
      }
    }
  }
  out.first = tile.at * edge;
  return any;
}

}  // namespace

std::vector<VoxelTile> closed_union(std::span<const Vec3d> position, const ClosingOptions& o) {
  const float radius = static_cast<float>(o.radius / o.voxel), inwards = static_cast<float>(o.inwards / o.voxel);
  const float band = static_cast<float>(o.half_width) + 1.75f;  // and what the mean over 27 voxels looks at
  const float reach = radius + std::max(band - inwards, 1.75f), depth = inwards + band;
  TileSet tiles(position, o.voxel);
  tiles.add_neighbours(tiles_within(reach));
  std::vector<Tile>& tile = tiles.tile;
#pragma omp parallel for schedule(dynamic, 16)
  for (std::size_t t = 0; t < tile.size(); ++t) measure_outside(tiles, tile[t], radius, reach);
#pragma omp parallel for schedule(dynamic, 16)
  for (std::size_t t = 0; t < tile.size(); ++t) {
    for (int axis = 0; tile[t].value && axis < 3; ++axis) find_crossings(tiles, tile[t], axis);
  }
#pragma omp parallel for schedule(dynamic, 16)
  for (std::size_t t = 0; t < tile.size(); ++t) measure_inside(tiles, tile[t], depth);
  std::vector<std::unique_ptr<VoxelTile>> smoothed(tile.size());
#pragma omp parallel for schedule(dynamic, 16)
  for (std::size_t t = 0; t < tile.size(); ++t) {
    auto out = std::make_unique<VoxelTile>();
    if (smooth(tiles, tile[t], o, reach - radius, -depth, *out)) smoothed[t] = std::move(out);
  }
  std::vector<VoxelTile> result;
  for (const auto& out : smoothed)
    if (out) result.push_back(*out);
  return result;
}

}  // namespace gdesp::analysis
