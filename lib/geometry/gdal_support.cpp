// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/gdal_support.hpp"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/error.hpp"

namespace gdesp::geometry {
namespace {

OGRSpatialReference parsed(const std::string& text) {
  OGRSpatialReference crs;
  const QuietGdal quiet;
  if (crs.SetFromUserInput(text.c_str()) != OGRERR_NONE) crs.Clear();
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

void CPL_STDCALL hand_over(CPLErr level, CPLErrorNum, const char* text) {
  if (level == CE_Debug) return;
  static_cast<QuietGdal*>(CPLGetErrorHandlerUserData())->remember(level == CE_Warning, text);
}

}  // namespace

void gdal_start() {
  static std::once_flag once;
  std::call_once(once, [] {
    CPLSetConfigOption("GDAL_PAM_ENABLED", "NO");  // never leaves .aux.xml files beside the input
    GDALAllRegister();
  });
}

std::string gdal_path(const std::string& path) {
  return path.size() > 3 && path.compare(path.size() - 3, 3, ".gz") == 0 ? "/vsigzip/" + path : path;
}

QuietGdal::QuietGdal() { CPLPushErrorHandlerEx(hand_over, this); }

QuietGdal::~QuietGdal() { CPLPopErrorHandler(); }

void QuietGdal::remember(bool warning, const char* text) {
  last_ = text;
  std::replace(last_.begin(), last_.end(), '\n', ' ');
  if (warning && ++warning_count_ == 1) first_warning_ = last_;
}

std::string QuietGdal::message() const { return last_.empty() ? "no reason given" : last_; }

std::vector<std::string> QuietGdal::warnings(const std::string& path) const {
  if (warning_count_ == 0) return {};
  return {path + ": GDAL warns: " + first_warning_ +
          (warning_count_ > 1 ? " (and " + std::to_string(warning_count_ - 1) + " more)" : "")};
}

std::string wkt_of(const OGRSpatialReference& crs) {
  char* text = nullptr;
  const char* options[] = {"FORMAT=WKT2", nullptr};
  crs.exportToWkt(&text, options);
  std::string out = text ? text : "";
  CPLFree(text);
  return out;
}

std::string check_crs(const std::string& text, const std::string& where) {
  gdal_start();
  const OGRSpatialReference crs = parsed(text);
  if (crs.IsEmpty()) {
    throw Error(ErrorKind::input,
                where + ": unknown coordinate system \"" + text + "\"; valid: e.g. \"EPSG:2193\", WKT, PROJ text");
  }
  return wkt_of(crs);
}

std::string crs_name(const std::string& text) {
  const OGRSpatialReference crs = parsed(text);
  return crs.GetName() ? crs.GetName() : text;
}

bool is_geographic(const std::string& text) { return parsed(text).IsGeographic(); }

bool same_crs(const std::string& a, const std::string& b) {
  const OGRSpatialReference p = parsed(a), q = parsed(b);
  return p.IsSame(&q);
}

std::string utm_crs(double longitude, double latitude) {
  const int zone = std::clamp(static_cast<int>(std::floor((longitude + 180.0) / 6.0)) + 1, 1, 60);
  return "EPSG:" + std::to_string((latitude < 0 ? 32700 : 32600) + zone);
}

}  // namespace gdesp::geometry
