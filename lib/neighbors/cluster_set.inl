// SPDX-License-Identifier: GPL-3.0-or-later
// Body of for_each_candidate: walks the pencils of the (at most 3 x 3 x 3) tiles around a point.
namespace gdesp {

/// Along one axis: the tile offset (-1, 0, 1) and cells of one stretch of the reach around a point.
struct CellRange {
  std::int32_t offset, first, last;
};

namespace detail {

// Cells [first, last] of tile offset o that lie within [low, high] (m, local to the point's tile).
GDESP_HD inline CellRange cell_range(int o, float low, float high, float tile, float inverse_cell, std::int32_t cells) {
  const float begin = (low - static_cast<float>(o) * tile) * inverse_cell;
  const float end = (high - static_cast<float>(o) * tile) * inverse_cell;
  CellRange range{o, 0, cells - 1};
  if (begin > 0.0f) range.first = static_cast<std::int32_t>(begin < static_cast<float>(cells) ? begin : cells);
  if (end < static_cast<float>(cells)) range.last = end < 0.0f ? -1 : static_cast<std::int32_t>(end);
  return range;
}

// Dense tile coordinate after the offset; -1 when there is none. Wraps along periodic axes.
GDESP_HD inline std::int32_t neighbour_tile(std::int32_t t, int o, std::int32_t tiles, bool periodic) {
  t += o;
  if (periodic) {
    if (t < 0) t += tiles;
    if (t >= tiles) t -= tiles;
    return t;
  }
  return (t < 0 || t >= tiles) ? -1 : t;
}

}  // namespace detail

template <class Visit>
GDESP_HD inline void for_each_candidate(const CellGridView& grid, const FixedPosition& p, float reach_x, float reach_y,
                                        float reach_z, const Visit& visit) {
  const Domain& domain = grid.domain;
  const float tile_x = static_cast<float>(domain.tile_size.x);
  const float tile_y = static_cast<float>(domain.tile_size.y);
  const float tile_z = static_cast<float>(domain.tile_size.z);
  const float x = domain.local(p.x, 0), y = domain.local(p.y, 1), z = domain.local(p.z, 2);
  for (int oz = -1; oz <= 1; ++oz) {
    const CellRange rz = detail::cell_range(oz, z - reach_z, z + reach_z, tile_z, grid.inverse_cell_size.z, grid.cells.z);
    if (rz.first > rz.last) continue;
    const std::int32_t tz = detail::neighbour_tile(Domain::tile_of(p.z), oz, domain.tiles.z, domain.periodic[2]);
    if (tz < 0) continue;
    for (int oy = -1; oy <= 1; ++oy) {
      const CellRange ry = detail::cell_range(oy, y - reach_y, y + reach_y, tile_y, grid.inverse_cell_size.y, grid.cells.y);
      if (ry.first > ry.last) continue;
      const std::int32_t ty = detail::neighbour_tile(Domain::tile_of(p.y), oy, domain.tiles.y, domain.periodic[1]);
      if (ty < 0) continue;
      for (int ox = -1; ox <= 1; ++ox) {
        const CellRange rx = detail::cell_range(ox, x - reach_x, x + reach_x, tile_x, grid.inverse_cell_size.x, grid.cells.x);
        if (rx.first > rx.last) continue;
        const std::int32_t tx = detail::neighbour_tile(Domain::tile_of(p.x), ox, domain.tiles.x, domain.periodic[0]);
        if (tx < 0) continue;
        const Index storage = grid.tile_slot[(static_cast<std::int64_t>(tz) * domain.tiles.y + ty) * domain.tiles.x + tx];
        if (storage < 0) continue;
        const Vec3<std::int32_t> offset{ox, oy, oz};
        for (std::int32_t cz = rz.first; cz <= rz.last; ++cz) {
          for (std::int32_t cy = ry.first; cy <= ry.last; ++cy) {
            const Index* pencil = grid.pencil(storage, cy, cz);
            const Index begin = pencil[rx.first], end = pencil[rx.last + 1];
            if (end > begin) visit(begin / exec::cluster_size, (end - 1) / exec::cluster_size, offset);
          }
        }
      }
    }
  }
}

}  // namespace gdesp
