// SPDX-License-Identifier: GPL-3.0-or-later
// Maps as files that a GIS opens in place.
#pragma once

#include <string>
#include <vector>

#include "analysis/map_measurement.hpp"

namespace gdesp::analysis {

/// Writes PREFIX_level_max, _depth_max, _arrival as GeoTIFF (.tif, LZW) or ESRI ASCII (.asc), and
/// PREFIX_run_up_line.geojson, all in the scene's own coordinates (case coordinates + offset), with the terrain's
/// coordinate system where the scene names one. Cells are areas: the raster's corner lies half a cell outside the first
/// centre. Nothing-there is -9999. Returns the paths. Throws Error(resource) when a file cannot be written,
/// Error(input) on a coordinate system that GDAL does not know.
std::vector<std::string> write_maps(const MapMeasurement& map, const std::string& prefix, bool esri_ascii);

}  // namespace gdesp::analysis
