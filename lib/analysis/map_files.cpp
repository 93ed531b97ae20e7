// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/map_files.hpp"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.hpp"

namespace gdesp::analysis {
namespace {

constexpr float nothing = -9999.0f;

std::string wkt_of(const std::string& crs) {
  if (crs.empty()) return {};
  OGRSpatialReferenceH srs = OSRNewSpatialReference(nullptr);
  char* text = nullptr;
  const bool known = OSRSetFromUserInput(srs, crs.c_str()) == OGRERR_NONE && OSRExportToWkt(srs, &text) == OGRERR_NONE;
  std::string wkt = known ? text : "";
  CPLFree(text);
  OSRDestroySpatialReference(srs);
  if (!known)
    throw Error(ErrorKind::input, "terrain.crs \"" + crs + "\": GDAL does not know it; valid is e.g. EPSG:32632");
  return wkt;
}

// Rows from north to south, as rasters are read.
GDALDatasetH in_memory(const Raster& r, const Vec3d& offset, double up, const std::string& wkt) {
  GDALDatasetH data = GDALCreate(GDALGetDriverByName("MEM"), "", r.nx, r.ny, 1, GDT_Float32, nullptr);
  double place[6] = {r.x0 - 0.5 * r.dx + offset.x, r.dx, 0.0, r.y0 + (r.ny - 0.5) * r.dx + offset.y, 0.0, -r.dx};
  GDALSetGeoTransform(data, place);
  if (!wkt.empty()) GDALSetProjection(data, wkt.c_str());
  GDALRasterBandH band = GDALGetRasterBand(data, 1);
  GDALSetRasterNoDataValue(band, nothing);
  std::vector<float> row(static_cast<std::size_t>(r.nx));
  for (int iy = 0; iy < r.ny; ++iy) {
    for (int ix = 0; ix < r.nx; ++ix) {
      const float v = r.at(ix, r.ny - 1 - iy);
      row[static_cast<std::size_t>(ix)] = std::isfinite(v) ? static_cast<float>(v + up) : nothing;
    }
    if (GDALRasterIO(band, GF_Write, 0, iy, r.nx, 1, row.data(), r.nx, 1, GDT_Float32, 0, 0) != CE_None) {
      throw Error(ErrorKind::resource, "a map does not fit into memory");
    }
  }
  return data;
}

void write_raster(const Raster& r, const Vec3d& offset, double up, const std::string& wkt, const std::string& path,
                  bool ascii) {
  GDALDatasetH data = in_memory(r, offset, up, wkt);
  const char* const tif[] = {"COMPRESS=LZW", nullptr};
  const char* const asc[] = {"DECIMAL_PRECISION=3", nullptr};
  const std::string aside = path + ".part" + (ascii ? ".asc" : ".tif");
  GDALDatasetH file = GDALCreateCopy(GDALGetDriverByName(ascii ? "AAIGrid" : "GTiff"), aside.c_str(), data, FALSE,
                                     const_cast<char**>(ascii ? asc : tif), nullptr, nullptr);
  if (file) GDALClose(file);
  GDALClose(data);
  if (!file) throw Error(ErrorKind::resource, path + ": cannot be written: " + CPLGetLastErrorMsg());
  std::filesystem::rename(aside, path);
  const std::string stem = aside.substr(0, aside.size() - 4), final_stem = path.substr(0, path.size() - 4);
  if (std::filesystem::exists(stem + ".prj")) std::filesystem::rename(stem + ".prj", final_stem + ".prj");
  std::filesystem::remove(aside + ".aux.xml");
}

void write_lines(const MapMeasurement& map, const std::string& path) {
  const RunInfo& info = map.info();
  nlohmann::ordered_json features = nlohmann::ordered_json::array();
  const auto rounded = [](double v) { return std::round(v * 1000.0) / 1000.0; };
  for (const GroundLine& line : map.run_up_lines()) {
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    double highest = -1e300;
    for (const Vec3d& p : line) {
      const Vec3d at = to_scene(info, p);
      nlohmann::ordered_json point{rounded(at.x), rounded(at.y)};
      if (std::isfinite(at.z)) {
        point.push_back(rounded(at.z));
        highest = std::max(highest, at.z);
      }
      points.push_back(std::move(point));
    }
    nlohmann::ordered_json properties{{"run", info.name}};
    if (highest > -1e300) properties["highest_ground_m"] = rounded(highest);
    if (highest > -1e300 && info.still_water_level) {
      properties["highest_above_still_water_m"] = rounded(highest - info.offset.z - *info.still_water_level);
    }
    features.push_back({{"type", "Feature"},
                        {"properties", properties},
                        {"geometry", {{"type", "LineString"}, {"coordinates", points}}}});
  }
  nlohmann::ordered_json collection{{"type", "FeatureCollection"}, {"name", "run_up_line"}};
  if (!info.scene.terrain.crs
           .empty()) {  // GeoJSON 2008, which GDAL and QGIS read: coordinates are the terrain's, not WGS 84
    std::string name = info.scene.terrain.crs;
    if (name.rfind("EPSG:", 0) == 0) name = "urn:ogc:def:crs:EPSG::" + name.substr(5);
    collection["crs"] = {{"type", "name"}, {"properties", {{"name", name}}}};
  }
  collection["features"] = features;
  const std::string aside = path + ".part";
  std::ofstream out(aside);
  out << collection.dump(1) << '\n';
  out.close();
  if (!out) throw Error(ErrorKind::resource, path + ": cannot be written");
  std::filesystem::rename(aside, path);
}

}  // namespace

std::vector<std::string> write_maps(const MapMeasurement& map, const std::string& prefix, bool esri_ascii) {
  GDALAllRegister();
  CPLSetErrorHandler(CPLQuietErrorHandler);
  const std::string wkt = wkt_of(map.info().scene.terrain.crs), end = esri_ascii ? ".asc" : ".tif";
  const Vec3d offset = map.info().offset;
  const std::filesystem::path folder = std::filesystem::path(prefix).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder);
  std::vector<std::string> paths{prefix + "_level_max" + end, prefix + "_depth_max" + end, prefix + "_arrival" + end,
                                 prefix + "_run_up_line.geojson"};
  write_raster(map.level_max(), offset, offset.z, wkt, paths[0], esri_ascii);
  write_raster(map.depth_max(), offset, 0.0, wkt, paths[1], esri_ascii);
  write_raster(map.arrival(), offset, 0.0, wkt, paths[2], esri_ascii);
  write_lines(map, paths[3]);
  return paths;
}

}  // namespace gdesp::analysis
