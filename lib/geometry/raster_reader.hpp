// SPDX-License-Identifier: GPL-3.0-or-later
// Rasters and point clouds through GDAL: GeoTIFF, ESRI ASCII, USGS DEM, XYZ grids, and anything else GDAL opens
// as a raster; also gzipped. Points (CSV, XYZ without a grid) are triangulated.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/heightfield.hpp"

namespace gdesp::geometry {

/// How a raster's numbers become metres in the scene's coordinates.
struct RasterOptions {
  double scale = 1.0;            ///< horizontal unit of the file in metres
  double vertical_scale = 1.0;   ///< vertical unit in metres; -1: depths, positive down
  double vertical_offset = 0.0;  ///< m, added after scaling
  std::string crs;               ///< of the file where it does not say (anything GDAL understands)
  std::string target_crs;        ///< reproject to this when it differs; empty: leave as it is
};

struct Raster {
  Heightfield field;
  std::string crs;                    ///< WKT; empty when unknown
  std::string driver;                 ///< GDAL's short name of the format
  std::vector<std::string> warnings;  ///< "PATH: ...", of the library that reads
};

/// Reads one raster; nullopt where GDAL recognises none (the extension is not looked at). Throws Error(input): no data, rotated grid,
/// unknown CRS.
std::optional<Raster> read_if_raster(const std::string& path, const RasterOptions& options);
/// The same of a file that must be one: throws Error(input) also when it is missing or no raster.
Raster read_raster(const std::string& path, const RasterOptions& options);
/// Reads and joins tiles: equal grids are laid side by side, others are sampled onto the finest grid. Where tiles
/// overlap the earlier file wins. nullopt where one of them is no raster.
std::optional<Raster> read_tiles(const std::vector<std::string>& paths, const RasterOptions& options);
/// Joins heightfields in the same way.
Heightfield merge(const std::vector<Heightfield>& tiles);

/// Points from a text file (x y z by column; CSV with or without header; gzip too), converted like a raster.
std::vector<Vec3d> read_points(const std::string& path, const RasterOptions& options);

}  // namespace gdesp::geometry
