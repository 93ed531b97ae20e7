// SPDX-License-Identifier: GPL-3.0-or-later
// Body of for_each_candidate: walks the pencils of the (at most 3 x 3 x 3) tiles around a box.
namespace gdesp {
namespace detail {

struct CellRange {
  std::int32_t first, last;
};

// Cells that overlap [low, high] (m, local to the tile of the cells).
GDESP_HD inline CellRange cell_range(float low, float high, float inverse_cell, std::int32_t cells) {
  const float begin = low * inverse_cell;
  const float end = high * inverse_cell;
  CellRange range{0, cells - 1};
  if (begin > 0.0f) range.first = begin < static_cast<float>(cells) ? static_cast<std::int32_t>(begin) : cells;
  if (end < static_cast<float>(cells)) range.last = end < 0.0f ? -1 : static_cast<std::int32_t>(end);
  return range;
}

// True when a block of tile `storage` that overlaps the cells holds a particle.
GDESP_HD inline bool any_in_blocks(const CellGridView& grid, Index storage, const CellRange& x, const CellRange& y,
                                   const CellRange& z) {
  const int bx = x.first >> grid.block_shift.x, ex = x.last >> grid.block_shift.x;
  const int by = y.first >> grid.block_shift.y, ey = y.last >> grid.block_shift.y;
  const int bz = z.first >> grid.block_shift.z, ez = z.last >> grid.block_shift.z;
  const std::uint64_t columns = (std::uint64_t{2} << ex) - (std::uint64_t{1} << bx);
  std::uint64_t wanted = 0, found = 0;
  for (int b = by; b <= ey; ++b) wanted |= columns << (8 * b);
  for (int b = bz; b <= ez; ++b) found |= grid.block[8 * static_cast<std::int64_t>(storage) + b];
  return (wanted & found) != 0;
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

// Distance between the interval [low, high] and cell c of tile offset `shift` metres away.
GDESP_HD inline float cell_distance(float low, float high, std::int32_t c, float cell_size, float shift) {
  const float cell_low = shift + static_cast<float>(c) * cell_size;
  const float below = cell_low - high, above = low - (cell_low + cell_size);
  const float d = below > above ? below : above;
  return d > 0.0f ? d : 0.0f;
}

}  // namespace detail

template <class Visit>
GDESP_HD inline void for_each_candidate(const CellGridView& grid, const Vec3<std::int32_t>& tile, const Vec3f& low,
                                        const Vec3f& high, float cutoff, const Visit& visit) {
  const Domain& domain = grid.domain;
  const Vec3f size{static_cast<float>(domain.tile_size.x), static_cast<float>(domain.tile_size.y),
                   static_cast<float>(domain.tile_size.z)};
  const Vec3f cell{1.0f / grid.inverse_cell_size.x, 1.0f / grid.inverse_cell_size.y, 1.0f / grid.inverse_cell_size.z};
  // Cell borders are computed in single precision: reach a thousandth of a cell further.
  const float reach = cutoff + 1.0e-3f * (cell.y > cell.x ? cell.y : cell.x);
  for (int oz = -1; oz <= 1; ++oz) {
    const float shift_z = static_cast<float>(oz) * size.z;
    const auto rz =
        detail::cell_range(low.z - reach - shift_z, high.z + reach - shift_z, grid.inverse_cell_size.z, grid.cells.z);
    if (rz.first > rz.last) continue;
    const std::int32_t tz = detail::neighbour_tile(tile.z, oz, domain.tiles.z, domain.periodic[2]);
    if (tz < 0) continue;
    for (int oy = -1; oy <= 1; ++oy) {
      const float shift_y = static_cast<float>(oy) * size.y;
      const auto ry =
          detail::cell_range(low.y - reach - shift_y, high.y + reach - shift_y, grid.inverse_cell_size.y, grid.cells.y);
      if (ry.first > ry.last) continue;
      const std::int32_t ty = detail::neighbour_tile(tile.y, oy, domain.tiles.y, domain.periodic[1]);
      if (ty < 0) continue;
      for (int ox = -1; ox <= 1; ++ox) {
        const float shift_x = static_cast<float>(ox) * size.x;
        const auto all_x = detail::cell_range(low.x - reach - shift_x, high.x + reach - shift_x,
                                              grid.inverse_cell_size.x, grid.cells.x);
        if (all_x.first > all_x.last) continue;
        const std::int32_t tx = detail::neighbour_tile(tile.x, ox, domain.tiles.x, domain.periodic[0]);
        if (tx < 0) continue;
        const std::int64_t number = (static_cast<std::int64_t>(tz) * domain.tiles.y + ty) * domain.tiles.x + tx;
        const Index storage = grid.tile_slot[number];
        if (storage < 0 || !detail::any_in_blocks(grid, storage, all_x, ry, rz)) continue;
        for (std::int32_t cz = rz.first; cz <= rz.last; ++cz) {
          const float dz = detail::cell_distance(low.z, high.z, cz, cell.z, shift_z);
          for (std::int32_t cy = ry.first; cy <= ry.last; ++cy) {
            const float dy = detail::cell_distance(low.y, high.y, cy, cell.y, shift_y);
            const float rest = reach * reach - dz * dz - dy * dy;
            if (rest < 0.0f) continue;
            const float reach_x = ::sqrtf(rest);
            const auto rx = detail::cell_range(low.x - reach_x - shift_x, high.x + reach_x - shift_x,
                                               grid.inverse_cell_size.x, grid.cells.x);
            if (rx.first > rx.last) continue;
            const Index* pencil = grid.pencil(storage, cy, cz);
            const Index begin = pencil[rx.first], end = pencil[rx.last + 1];
            if (end > begin) {
              visit(begin / exec::cluster_size, (end - 1) / exec::cluster_size, Vec3<std::int32_t>{ox, oy, oz});
            }
          }
        }
      }
    }
  }
}

}  // namespace gdesp
