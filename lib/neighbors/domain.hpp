// SPDX-License-Identifier: GPL-3.0-or-later
// Where particles are. A position is three 64-bit integers in units of tile_size / 2^32: exact over any domain,
// the same on every device, with a resolution of about 1e-8 of a particle spacing. Loops work on single-precision
// coordinates relative to the origin of the particle's tile (64 particle spacings wide), so that precision does
// not depend on how large the domain is or where it lies (docs/decisions/0002).
#pragma once

#include <cmath>
#include <cstdint>

#include "core/host_device.hpp"
#include "core/vec3.hpp"

namespace gdesp {

using FixedPosition = Vec3<std::int64_t>;

struct Domain {
  static constexpr int fraction_bits = 32;
  static constexpr double one_tile = 4294967296.0;  // 2^fraction_bits

  Vec3d lower;               ///< m, case coordinates of the origin of tile (0, 0, 0)
  Vec3d tile_size;           ///< m; along a periodic axis the period is a whole number of tiles
  Vec3<std::int32_t> tiles;  ///< number along each axis
  bool periodic[3] = {false, false, false};
  int dimensions = 3;  ///< 2: the plane x-z, y = 0

  GDESP_HD static std::int32_t tile_of(std::int64_t p) { return static_cast<std::int32_t>(p >> fraction_bits); }
  GDESP_HD static std::uint32_t fraction_of(std::int64_t p) { return static_cast<std::uint32_t>(p); }

  /// m, relative to the particle's own tile.
  GDESP_HD float local(std::int64_t p, int axis) const {
    return static_cast<float>(static_cast<double>(fraction_of(p)) * (tile_size[axis] / one_tile));
  }
  GDESP_HD std::int64_t fixed_length(double metres, int axis) const {
    return static_cast<std::int64_t>(::llrint(metres * (one_tile / tile_size[axis])));
  }
  GDESP_HD FixedPosition fixed(const Vec3d& r) const {
    return {fixed_length(r.x - lower.x, 0), fixed_length(r.y - lower.y, 1), fixed_length(r.z - lower.z, 2)};
  }
  /// m, case coordinates.
  GDESP_HD Vec3d metres(const FixedPosition& p) const {
    return {lower.x + static_cast<double>(p.x) * (tile_size.x / one_tile),
            lower.y + static_cast<double>(p.y) * (tile_size.y / one_tile),
            lower.z + static_cast<double>(p.z) * (tile_size.z / one_tile)};
  }
  /// Moves by a displacement (m). Does not wrap: that happens when particles are sorted anew (wrapped()).
  GDESP_HD FixedPosition moved(FixedPosition p, const Vec3d& by) const {
    p.x += fixed_length(by.x, 0);
    p.y += fixed_length(by.y, 1);
    p.z += fixed_length(by.z, 2);
    return p;
  }
  /// The image inside the period along periodic axes.
  GDESP_HD FixedPosition wrapped(FixedPosition p) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (!periodic[axis]) continue;
      const std::int64_t period = static_cast<std::int64_t>(tiles[axis]) << fraction_bits;
      if (p[axis] < 0) p[axis] += period;
      if (p[axis] >= period) p[axis] -= period;
    }
    return p;
  }
  /// m, relative to the origin of tile (tx, ty, tz), which need not be the particle's own.
  GDESP_HD Vec3f relative_to_tile(const FixedPosition& p, const Vec3<std::int32_t>& tile) const {
    Vec3f r;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t d = p[axis] - (static_cast<std::int64_t>(tile[axis]) << fraction_bits);
      r[axis] = static_cast<float>(static_cast<double>(d) * (tile_size[axis] / one_tile));
    }
    return r;
  }
  GDESP_HD Vec3<std::int32_t> tile_coordinates(std::int32_t number) const {
    return {number % tiles.x, (number / tiles.x) % tiles.y, number / (tiles.x * tiles.y)};
  }
  GDESP_HD bool inside(const FixedPosition& p) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] < 0 || tile_of(p[axis]) >= tiles[axis]) return false;
    }
    return true;
  }
  /// Dense number of the tile that holds p; p must be inside.
  GDESP_HD std::int32_t tile_number(const FixedPosition& p) const {
    return (tile_of(p.z) * tiles.y + tile_of(p.y)) * tiles.x + tile_of(p.x);
  }
  /// m, r_a - r_b, by the nearest image along periodic axes.
  GDESP_HD Vec3f separation(const FixedPosition& a, const FixedPosition& b) const {
    Vec3f r;
    for (int axis = 0; axis < 3; ++axis) {
      std::int64_t d = a[axis] - b[axis];
      if (periodic[axis]) {
        const std::int64_t period = static_cast<std::int64_t>(tiles[axis]) << fraction_bits;
        if (2 * d > period) d -= period;
        if (2 * d < -period) d += period;
      }
      r[axis] = static_cast<float>(static_cast<double>(d) * (tile_size[axis] / one_tile));
    }
    return r;
  }
};

/// The domain of a box (m, case coordinates) for particle spacing dp (m): tiles about 64 dp wide.
/// `period_exact`: along periodic axes the box is the period; elsewhere the tiles may overhang.
Domain make_domain(const Vec3d& lower, const Vec3d& upper, double dp, const bool periodic[3], int dimensions);

}  // namespace gdesp
