// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/raster_reader.hpp"

#include <gdal_priv.h>
#include <gdal_utils.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>

#include "core/error.hpp"
#include "geometry/gdal_support.hpp"

namespace gdesp::geometry {
namespace {

constexpr double most_nodes = 4.0e8;  // 3.2 GB of elevations

struct CloseDataset {
  void operator()(GDALDataset* d) const { GDALClose(d); }
};
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

/// Formats that hold elevations; the rest of GDAL's drivers (databases, network services) stay shut.
const char* const terrain_drivers[] = {"GTiff", "COG",  "AAIGrid", "USGSDEM", "XYZ",   "SRTMHGT",        "HFA",
                                       "EHdr",  "ENVI", "GSAG",    "GSBG",    "GS7BG", "GRASSASCIIGrid", "netCDF",
                                       "DTED",  "SDTS", "VRT",     "BT",      nullptr};

Dataset open(const std::string& path) {
  return Dataset(GDALDataset::Open(gdal_path(path).c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, terrain_drivers));
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(ErrorKind::input, path + ": " + why);
}

Dataset warp(Dataset source, const std::string& path, const std::string& from, const std::string& to,
             const QuietGdal& quiet) {
  std::vector<std::string> words = {"-of",     "MEM",        "-r",  "bilinear", "-ot",
                                    "Float64", "-dstnodata", "nan", "-t_srs",   to};
  if (!from.empty()) words.insert(words.end(), {"-s_srs", from});
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (auto& w : words) argv.push_back(w.data());
  argv.push_back(nullptr);
  const std::unique_ptr<GDALWarpAppOptions, void (*)(GDALWarpAppOptions*)> options(
      GDALWarpAppOptionsNew(argv.data(), nullptr), &GDALWarpAppOptionsFree);
  GDALDatasetH sources[] = {GDALDataset::ToHandle(source.get())};
  int usage_error = 0;
  GDALDatasetH out = options ? GDALWarp("", nullptr, 1, sources, options.get(), &usage_error) : nullptr;
  if (!out) refuse(path, "cannot be reprojected to " + crs_name(to) + " (" + quiet.message() + ")");
  return Dataset(GDALDataset::FromHandle(out));
}

/// A header can state any size; memory is only taken for what a file of this length may hold: text needs two bytes a node, and
/// nothing that was measured packs better than four thousand nodes a byte.
void check_size(GDALDataset& data, const std::string& path) {
  const double nodes = static_cast<double>(data.GetRasterXSize()) * data.GetRasterYSize();
  const std::string driver = data.GetDriverName() ? data.GetDriverName() : "";
  std::error_code failed;
  const auto bytes = static_cast<double>(std::filesystem::file_size(path, failed));
  if (failed || driver == "VRT") return;
  const bool gzipped = std::filesystem::path(path).extension() == ".gz";
  const bool text =
      driver == "AAIGrid" || driver == "GSAG" || driver == "GRASSASCIIGrid" || driver == "XYZ" || driver == "USGSDEM";
  const double most = text ? (bytes + 64.0) * (gzipped ? 500.0 : 0.5) + 1.0 : (bytes + 64.0) * 4000.0;
  if (nodes > most) {
    refuse(path, "is damaged or cut short: it states " + std::to_string(data.GetRasterXSize()) + " x " +
                     std::to_string(data.GetRasterYSize()) + " nodes, which a file of " +
                     std::to_string(static_cast<long long>(bytes)) + " bytes cannot hold");
  }
}

/// Rows from the south, data-free nodes NaN.
Heightfield read_band(GDALDataset& data, const std::string& path, const QuietGdal& quiet) {
  double g[6] = {0, 1, 0, 0, 0, -1};
  if (data.GetGeoTransform(g) != CE_None) refuse(path, "the raster does not say where it lies (no geotransform)");
  if (std::abs(g[2]) > 1e-9 * std::abs(g[1]) || std::abs(g[4]) > 1e-9 * std::abs(g[5])) {
    refuse(path, "the raster's grid is rotated; rewrite it north-up (gdalwarp does)");
  }
  const int nx = data.GetRasterXSize(), ny = data.GetRasterYSize();
  if (data.GetRasterCount() < 1) refuse(path, "the raster has no band");
  if (static_cast<double>(nx) * ny > most_nodes) {
    refuse(path,
           "has " + std::to_string(nx) + " x " + std::to_string(ny) + " nodes, more than 4e8; cut out the part needed");
  }
  if (g[1] == 0.0 || g[5] == 0.0 || !std::isfinite(g[0] + g[1] + g[3] + g[5]))
    refuse(path, "the cell size is zero or not a number");
  Heightfield f;
  f.nx = nx;
  f.ny = ny;
  f.dx = std::abs(g[1]);
  f.dy = std::abs(g[5]);
  f.x0 = g[0] + 0.5 * g[1] + (g[1] < 0 ? (nx - 1) * g[1] : 0.0);
  f.y0 = g[3] + 0.5 * g[5] + (g[5] < 0 ? (ny - 1) * g[5] : 0.0);
  f.z.resize(static_cast<std::size_t>(nx) * ny);
  GDALRasterBand* band = data.GetRasterBand(1);
  if (band->RasterIO(GF_Read, 0, 0, nx, ny, f.z.data(), nx, ny, GDT_Float64, 0, 0) != CE_None) {
    refuse(path, "is damaged or cut short (" + quiet.message() + ")");
  }
  if (g[5] < 0) {
    for (int j = 0; j < ny / 2; ++j) {
      std::swap_ranges(f.z.begin() + static_cast<std::ptrdiff_t>(j) * nx,
                       f.z.begin() + static_cast<std::ptrdiff_t>(j + 1) * nx,
                       f.z.begin() + static_cast<std::ptrdiff_t>(ny - 1 - j) * nx);
    }
  }
  if (g[1] < 0) {
    for (int j = 0; j < ny; ++j) {
      const auto row = f.z.begin() + static_cast<std::ptrdiff_t>(j) * nx;
      std::reverse(row, row + nx);
    }
  }
  int has_nodata = 0;
  const double nodata = band->GetNoDataValue(&has_nodata);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (auto& z : f.z) {
    if (!std::isfinite(z) || (has_nodata && (z == nodata || static_cast<float>(z) == static_cast<float>(nodata))))
      z = nan;
  }
  return f;
}

void scale(Heightfield& f, const RasterOptions& o) {
  f.x0 *= o.scale;
  f.y0 *= o.scale;
  f.dx *= o.scale;
  f.dy *= o.scale;
  for (auto& z : f.z) z = z * o.vertical_scale + o.vertical_offset;
}

Raster read(Dataset data, const std::string& path, const RasterOptions& options, const QuietGdal& quiet) {
  check_size(*data, path);
  Raster out;
  out.driver = data->GetDriverName() ? data->GetDriverName() : "";
  const OGRSpatialReference* own = data->GetSpatialRef();
  std::string crs = options.crs;
  if (crs.empty() && own) crs = wkt_of(*own);
  if (!crs.empty()) crs = check_crs(crs, path);
  std::string target = options.target_crs;
  if (target.empty() && !crs.empty() && is_geographic(crs)) {
    double g[6];
    if (data->GetGeoTransform(g) == CE_None) {
      target = utm_crs(g[0] + 0.5 * g[1] * data->GetRasterXSize(), g[3] + 0.5 * g[5] * data->GetRasterYSize());
    }
  }
  if (!target.empty()) {
    if (crs.empty()) refuse(path, "its coordinate system is unknown; state it (terrain.crs = \"EPSG:...\")");
    if (!same_crs(crs, target)) data = warp(std::move(data), path, crs, target, quiet);
    crs = check_crs(target, path);
  }
  out.field = read_band(*data, path, quiet);
  out.crs = crs;
  out.warnings = quiet.warnings(path);
  scale(out.field, options);
  if (is_empty(bounds(out.field))) refuse(path, "holds no elevation at all (every cell is without data)");
  return out;
}

}  // namespace

std::optional<Raster> read_if_raster(const std::string& path, const RasterOptions& options) {
  gdal_start();
  const QuietGdal quiet;  // outlives the data set: closing may warn, too
  Dataset data = open(path);
  if (!data) return std::nullopt;
  return read(std::move(data), path, options, quiet);
}

Raster read_raster(const std::string& path, const RasterOptions& options) {
  if (!std::filesystem::exists(path)) refuse(path, "no such file");
  std::optional<Raster> raster = read_if_raster(path, options);
  if (!raster)
    refuse(path, "is no raster that can be read (GeoTIFF, ESRI ASCII, USGS DEM, XYZ grid are), or it is damaged");
  return std::move(*raster);
}

Heightfield merge(const std::vector<Heightfield>& tiles) {
  Heightfield out = tiles.front();
  if (tiles.size() == 1) return out;
  Box box = empty_box();
  for (const auto& t : tiles) {
    extend(box, Vec3d{t.x0, t.y0, 0.0});
    extend(box, Vec3d{t.x0 + (t.nx - 1) * t.dx, t.y0 + (t.ny - 1) * t.dy, 0.0});
    if (t.dx * t.dy < out.dx * out.dy) out.dx = t.dx, out.dy = t.dy, out.x0 = t.x0, out.y0 = t.y0;
  }
  // Keep the finest tile's nodes where they are.
  const double west = std::ceil((out.x0 - box.lower.x) / out.dx - 1e-6),
               south = std::ceil((out.y0 - box.lower.y) / out.dy - 1e-6);
  out.x0 -= west * out.dx;
  out.y0 -= south * out.dy;
  const double nx = std::floor((box.upper.x - out.x0) / out.dx + 1e-6) + 1,
               ny = std::floor((box.upper.y - out.y0) / out.dy + 1e-6) + 1;
  if (nx * ny > most_nodes) {
    throw Error(ErrorKind::input, "the tiles together span " + std::to_string(static_cast<long long>(nx)) + " x " +
                                      std::to_string(static_cast<long long>(ny)) +
                                      " nodes, more than 4e8; are they of one coordinate system?");
  }
  out.nx = static_cast<int>(nx);
  out.ny = static_cast<int>(ny);
  out.z.assign(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny), std::numeric_limits<double>::quiet_NaN());
  for (int j = 0; j < out.ny; ++j) {
    for (int i = 0; i < out.nx; ++i) {
      const double x = out.x0 + i * out.dx, y = out.y0 + j * out.dy;
      for (const auto& t : tiles) {
        const double u = std::round((x - t.x0) / t.dx), v = std::round((y - t.y0) / t.dy);
        const bool on_node = std::abs(t.x0 + u * t.dx - x) < 1e-6 * t.dx &&
                             std::abs(t.y0 + v * t.dy - y) < 1e-6 * t.dy && u >= 0 && v >= 0 && u < t.nx && v < t.ny;
        const double z = on_node ? t.at(static_cast<int>(u), static_cast<int>(v)) : sample(t, x, y);
        if (std::isfinite(z)) {
          out.at(i, j) = z;
          break;
        }
      }
    }
  }
  return out;
}

std::optional<Raster> read_tiles(const std::vector<std::string>& paths, const RasterOptions& options) {
  std::optional<Raster> first = read_if_raster(paths.front(), options);
  if (!first || paths.size() == 1) return first;
  RasterOptions rest = options;
  rest.target_crs = first->crs;
  std::vector<Heightfield> tiles = {std::move(first->field)};
  for (std::size_t k = 1; k < paths.size(); ++k) {
    std::optional<Raster> next = read_if_raster(paths[k], rest);
    if (!next) return std::nullopt;
    first->warnings.insert(first->warnings.end(), next->warnings.begin(), next->warnings.end());
    tiles.push_back(std::move(next->field));
  }
  first->field = merge(tiles);
  return first;
}

}  // namespace gdesp::geometry
