// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/map_files.hpp"
#include "analysis/map_measurement.hpp"
#include "command.hpp"
#include "core/error.hpp"
#include "options.hpp"

namespace gdesp::tool {

int run_map(const std::vector<std::string>& arguments) {
  po::options_description own("Map");
  own.add_options()("output,o", po::value<std::string>()->value_name("PREFIX"),
                    "write PREFIX_level_max, _depth_max, _arrival and PREFIX_run_up_line.geojson");
  own.add_options()("ascii", "ESRI ASCII grids (.asc) instead of GeoTIFF (.tif)");
  own.add_options()("cell", po::value<double>()->value_name("M")->default_value(0.0, "dp"), "size of a cell");
  own.add_options()("threshold", po::value<double>()->value_name("M")->default_value(0.0, "dp/2"),
                    "depth that is wet, and departure of the level that is an arrival");
  CommandLine line("map", own);
  const char* definition =
      "Maps over the domain, in the terrain's own coordinates (case coordinates + offset; its coordinate system, where "
      "the\n"
      "scene names one):\n"
      "  level_max  highest free surface over the cell, m (free surface: see profile --help)\n"
      "  depth_max  highest level minus the ground, m\n"
      "  arrival    first time the level departs from its first reading by the threshold, linear between frames; for\n"
      "             dry ground the first frame in which it is wet, s\n"
      "  run_up_line  outline of what was ever wet, as lines with the ground's elevation\n"
      "Connected water only. Cells where nothing was are -9999. The run-up line is the inundation line (inland limit "
      "of\n"
      "wetting) of the Tsunami Glossary, IOC Technical Series 85, UNESCO 2013; its arrival time is another one: that "
      "of the\n"
      "first maximum.\n";
  if (!line.parse(arguments, definition, "surge-analyze map lake.run -o maps/lake --plot maps/lake.png")) return 0;
  analysis::MapOptions options;
  options.cell = line.get<double>("cell");
  options.threshold = line.get<double>("threshold");
  analysis::MapMeasurement measurement(options);
  if (!line.has("output") && !line.has("plot"))
    throw Error(ErrorKind::usage, "map: -o PREFIX (or --plot FILE) is needed");
  const int code = run_measurement(line, measurement);
  if (line.has("output")) {
    for (const std::string& path :
         analysis::write_maps(measurement, line.get<std::string>("output"), line.has("ascii"))) {
      cli::info("map: " + path);
    }
  }
  return code;
}

}  // namespace gdesp::tool
