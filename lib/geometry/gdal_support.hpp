// SPDX-License-Identifier: GPL-3.0-or-later
// What the files that use GDAL share: start-up, silence, coordinate systems. Internal to lib/geometry.
#pragma once

#include <string>
#include <vector>

class OGRSpatialReference;

namespace gdesp::geometry {

/// Registers GDAL's drivers once.
void gdal_start();
/// GDAL's name of a file: /vsigzip/ in front of *.gz.
std::string gdal_path(const std::string& path);

/// Keeps GDAL from printing while it lives, on this thread, and remembers what it had to say.
class QuietGdal {
 public:
  QuietGdal();
  ~QuietGdal();
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;
  /// The last complaint of any kind; "no reason given" without one.
  std::string message() const;
  /// "PATH: GDAL warns: ..." with the first warning and the number of further ones; none: empty.
  std::vector<std::string> warnings(const std::string& path) const;

  void remember(bool warning, const char* text);

 private:
  std::string last_, first_warning_;
  int warning_count_ = 0;
};

/// WKT of a coordinate system given in any form; throws Error(input) naming `where` when it is unknown.
std::string check_crs(const std::string& text, const std::string& where);
std::string wkt_of(const OGRSpatialReference& crs);
std::string crs_name(const std::string& text);
bool is_geographic(const std::string& text);
bool same_crs(const std::string& a, const std::string& b);
/// EPSG code of the WGS 84 / UTM zone at a longitude and latitude (degrees).
std::string utm_crs(double longitude, double latitude);

}  // namespace gdesp::geometry
