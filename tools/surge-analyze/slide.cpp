// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/front_measurement.hpp"
#include "analysis/slide_measurement.hpp"
#include "command.hpp"
#include "options.hpp"

namespace gdesp::tool {

int run_slide(const std::vector<std::string>& arguments) {
  po::options_description own("Slide");
  own.add_options()("direction", po::value<std::string>()->value_name("DIR"),
                    "x, -x, y, -y or NX,NY (default: towards the lake's middle)");
  own.add_options()("fraction", po::value<double>()->value_name("F")->default_value(0.001, "0.001"),
                    "share of the slide beyond its front");
  CommandLine line("slide", own);
  const char* definition =
      "Centre of mass and its velocity (grains: mass-weighted; rigid body: centre of its closed surface, velocity from "
      "the\n"
      "frame before); travel of the front since the first frame (the place beyond which a stated fraction lies);\n"
      "submerged: share of the solids' volume below the free surface over it (spherical caps at the water line).\n"
      "Experiments with granular slides: cf. McFall and Fritz 2016, Proc. R. Soc. A 472, 20160052, doi\n"
      "10.1098/rspa.2016.0052. For the deposit's profile see: surge-analyze profile, column z_solids.\n";
  if (!line.parse(arguments, definition, "surge-analyze slide lake.run --plot slide.svg")) return 0;
  analysis::SlideOptions options;
  if (line.has("direction")) options.direction = analysis::parse_direction(line.get<std::string>("direction"));
  options.fraction = line.get<double>("fraction");
  analysis::SlideMeasurement measurement(options);
  return run_measurement(line, measurement);
}

}  // namespace gdesp::tool
