// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/gauge_measurement.hpp"
#include "command.hpp"
#include "options.hpp"

namespace gdesp::tool {

int run_gauge(const std::vector<std::string>& arguments) {
  po::options_description own("Gauge");
  own.add_options()("at", po::value<std::vector<std::string>>()->value_name("NAME=X,Y[,Z]"),
                    "a gauge, scene coordinates; with Z pressure too; may be repeated (default: the scene's gauges)");
  own.add_options()("arrival", "one row a gauge: arrival time, highest level, highest pressure");
  own.add_options()("threshold", po::value<double>()->value_name("M")->default_value(0.0, "dp/2"),
                    "departure that counts as arrival");
  CommandLine line("gauge", own);
  const char* definition =
      "Level: the free surface over the gauge (see profile --help), connected water; rise: above its first reading;\n"
      "in a far lake the level of its columns (no pressure).\n"
      "Pressure (gauges with Z): mean of the particles' pressure weighted with W within 2.6 dp, each value carried\n"
      "hydrostatically to the gauge's height; 0 where no water touches the gauge. Arrival: first departure of the "
      "level from\n"
      "its first reading by the threshold, linear between frames; at a dry gauge the first frame with water. Weighted "
      "means of\n"
      "particles: Monaghan 2005, Rep. Prog. Phys. 68, 1703, doi 10.1088/0034-4885/68/8/R01. The arrival time of the "
      "Tsunami\n"
      "Glossary (IOC Technical Series 85, UNESCO 2013) is another one: that of the first maximum; read it off the "
      "level.\n";
  if (!line.parse(arguments, definition, "surge-analyze gauge lake.run --at dam=1200,340 --plot gauge.svg")) return 0;
  analysis::GaugeOptions options;
  if (line.has("at")) {
    int number = 0;
    for (const std::string& text : line.get<std::vector<std::string>>("at")) {
      options.gauges.push_back(analysis::parse_gauge(text, ++number));
    }
  }
  options.arrivals = line.has("arrival");
  options.threshold = line.get<double>("threshold");
  analysis::GaugeMeasurement measurement(options);
  return run_measurement(line, measurement);
}

}  // namespace gdesp::tool
