// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/front_measurement.hpp"
#include "command.hpp"
#include "core/error.hpp"
#include "options.hpp"

namespace gdesp::tool {

int run_front(const std::vector<std::string>& arguments) {
  po::options_description own("Front");
  own.add_options()("direction", po::value<std::string>()->value_name("DIR")->default_value("x"),
                    "x, -x, y, -y or NX,NY");
  own.add_options()("fraction", po::value<double>()->value_name("F")->default_value(0.001, "0.001"),
                    "share of the fill that lies beyond the front");
  own.add_options()("scale-length", po::value<double>()->value_name("M"),
                    "L in x* and t* (default: height of the water at the start)");
  own.add_options()("origin", po::value<double>()->value_name("M"),
                    "x0 in x*, scene coordinates (default: the water's edge at the start)");
  own.add_options()("reference", po::value<std::string>()->value_name("CSV"), "table drawn into the plot");
  own.add_options()("reference-t", po::value<std::string>()->value_name("COLUMN")->default_value("t_star"), "its t*");
  own.add_options()("reference-x", po::value<std::string>()->value_name("COLUMN")->default_value("x_star"), "its x*");
  CommandLine line("front", own);
  const char* definition =
      "Leading edge x_front(t): the place beyond which a stated fraction (0.1 %) of the fill lies, of the connected\n"
      "water and of the solids; every particle is a slice of its own size, so the reading is finer than dp.\n"
      "x_tip is the outermost edge of the connected water (fraction 0). x* = (x - x0)/L, t* = t (g/L)^1/2 as in\n"
      "Lobovsky et al. 2014, J. Fluids Struct. 48, 407, doi 10.1016/j.jfluidstructs.2014.03.009.\n";
  if (!line.parse(arguments, definition, "surge-analyze front dam.run --scale-length 0.3 --plot front.pdf")) return 0;
  analysis::FrontOptions options;
  options.direction = analysis::parse_direction(line.get<std::string>("direction"));
  options.fraction = line.get<double>("fraction");
  if (!(options.fraction >= 0.0 && options.fraction < 1.0))
    throw Error(ErrorKind::usage, "--fraction: 0 or more and below 1 is needed");
  if (line.has("scale-length")) options.scale_length = line.get<double>("scale-length");
  if (line.has("origin")) options.origin = line.get<double>("origin");
  if (line.has("reference")) {
    options.reference = line.get<std::string>("reference");
    const analysis::Table table = analysis::read_table(options.reference);  // before the long work
    table.find(line.get<std::string>("reference-t"));
    table.find(line.get<std::string>("reference-x"));
  }
  options.reference_t = line.get<std::string>("reference-t");
  options.reference_x = line.get<std::string>("reference-x");
  analysis::FrontMeasurement measurement(options);
  return run_measurement(line, measurement);
}

}  // namespace gdesp::tool
