// SPDX-License-Identifier: GPL-3.0-or-later
#include <cpl_vsi.h>
#include <ogr_spatialref.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>

#include "core/error.hpp"
#include "geometry/gdal_support.hpp"
#include "geometry/raster_reader.hpp"

namespace gdesp::geometry {
namespace {

/// Whole text of a file, gzipped or not.
std::string read_text(const std::string& path) {
  gdal_start();
  const QuietGdal quiet;
  VSILFILE* file = VSIFOpenL(gdal_path(path).c_str(), "rb");
  if (!file) throw Error(ErrorKind::input, path + ": cannot be opened");
  std::string text;
  char buffer[1 << 16];
  for (std::size_t n = 1; n > 0;) {
    n = VSIFReadL(buffer, 1, sizeof buffer, file);
    text.append(buffer, n);
  }
  VSIFCloseL(file);
  return text;
}

/// The numbers of a line, split at blanks, commas and semicolons; false when a word is no number.
bool numbers_of(std::string_view line, double (&out)[3], int& count) {
  count = 0;
  std::size_t at = 0;
  while (at < line.size()) {
    const auto start = line.find_first_not_of(" \t,;\r\"", at);
    if (start == std::string_view::npos) break;
    at = std::min(line.find_first_of(" \t,;\r\"", start), line.size());
    if (count == 3) return true;
    const auto r = std::from_chars(line.data() + start + (line[start] == '+'), line.data() + at, out[count]);
    if (r.ec != std::errc() || r.ptr != line.data() + at) return false;
    ++count;
  }
  return true;
}

void reproject(std::vector<Vec3d>& points, const std::string& path, const RasterOptions& o) {
  if (o.target_crs.empty() || o.crs.empty() || same_crs(check_crs(o.crs, path), check_crs(o.target_crs, path))) return;
  const QuietGdal quiet;
  OGRSpatialReference from, to;
  from.SetFromUserInput(o.crs.c_str());
  to.SetFromUserInput(o.target_crs.c_str());
  from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  to.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> transform(OGRCreateCoordinateTransformation(&from, &to));
  if (!transform)
    throw Error(ErrorKind::input, path + ": no way from " + crs_name(o.crs) + " to " + crs_name(o.target_crs));
  for (auto& p : points) {
    if (!transform->Transform(1, &p.x, &p.y)) {
      throw Error(ErrorKind::input, path + ": a point cannot be brought from " + crs_name(o.crs) + " to " +
                                        crs_name(o.target_crs) + "; is the coordinate system right?");
    }
  }
}

}  // namespace

std::vector<Vec3d> read_points(const std::string& path, const RasterOptions& o) {
  if (!std::filesystem::exists(path)) throw Error(ErrorKind::input, path + ": no such file");
  const std::string text = read_text(path);
  if (text.substr(0, 4096).find('\0') != std::string::npos)
    throw Error(ErrorKind::input, path +
                                      ": is neither text with points nor a raster that can be read (GeoTIFF, ESRI "
                                      "ASCII, USGS DEM, XYZ grid are); is it damaged or cut short?");
  std::vector<Vec3d> points;
  std::size_t line_number = 0, at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line(text.data() + at, end - at);
    at = end + 1;
    ++line_number;
    double v[3];
    int count = 0;
    const bool numeric = numbers_of(line, v, count);
    if (numeric && count == 0) continue;
    if ((!numeric || count < 3) && line_number == 1) continue;  // a header
    if (!numeric || count < 3 || !std::isfinite(v[0] + v[1] + v[2])) {
      throw Error(ErrorKind::input, path + ":" + std::to_string(line_number) +
                                        ": expected three numbers x y z, found \"" + std::string(line.substr(0, 60)) +
                                        "\"");
    }
    points.push_back({v[0], v[1], v[2]});
  }
  if (points.empty()) throw Error(ErrorKind::input, path + ": holds no points (expected x y z in columns)");
  reproject(points, path, o);
  for (auto& p : points) p = {p.x * o.scale, p.y * o.scale, p.z * o.vertical_scale + o.vertical_offset};
  return points;
}

}  // namespace gdesp::geometry
