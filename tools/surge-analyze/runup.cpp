// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/run_up_measurement.hpp"
#include "command.hpp"
#include "options.hpp"

namespace gdesp::tool {

int run_runup(const std::vector<std::string>& arguments) {
  po::options_description own("Run-up");
  own.add_options()("along", "print the maximum by place along the shore instead of the height against time");
  own.add_options()("region", po::value<std::string>()->value_name("NAME"),
                    "region whose shore is profiled (default: far bank, or the scene's first)");
  own.add_options()("section", po::value<std::string>()->value_name("NAME"),
                    "section of the scene along which places are counted (default: long axis of lake or region)");
  own.add_options()("bin", po::value<double>()->value_name("M")->default_value(0.0, "4 dp"), "width of a place");
  own.add_options()("contact", po::value<double>()->value_name("DP")->default_value(2.6, "2.6"),
                    "distance from a wall, in particle spacings, at which water lies on the bank");
  own.add_options()("link", po::value<double>()->value_name("DP")->default_value(1.5, "1.5"),
                    "distance, in particle spacings, up to which particles are connected");
  CommandLine line("runup", own);
  const char* definition =
      "Run-up R(t): the highest point of the connected water that lies on a bank, above still water:\n"
      "  R = max (z + dp/2) - z_still\n"
      "over the particles of the main body that are within 2.6 dp of a wall at rest. Connected: chains of neighbours\n"
      "closer than 1.5 dp, sheets at least one particle thick (Ester et al. 1996), and the film that their edge thins "
      "to:\n"
      "single particles on the wall within 2.6 dp of those before them; drops, spray and torn water are splash, in a\n"
      "column of their own. Still water reads 0. The reading resolves dp. Run-up as in Synolakis 1987,\n"
      "J. Fluid Mech. 185, 523, doi 10.1017/S002211208700329X. Regions: the scene's, else near and far bank: the "
      "sides\n"
      "of the lake's long axis, seen from the slide. x, y, z are the scene's own coordinates.\n";
  if (!line.parse(arguments, definition, "surge-analyze runup lake.run --plot runup.svg > runup.tsv")) return 0;
  analysis::RunUpOptions options;
  options.along_shore = line.has("along");
  if (line.has("region")) options.region = line.get<std::string>("region");
  if (line.has("section")) options.section = line.get<std::string>("section");
  options.bin = line.get<double>("bin");
  options.rule.contact = line.get<double>("contact");
  options.rule.connectivity.link = line.get<double>("link");
  analysis::RunUpMeasurement measurement(options);
  return run_measurement(line, measurement);
}

}  // namespace gdesp::tool
