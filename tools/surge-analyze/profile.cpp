// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/profile_measurement.hpp"
#include "command.hpp"
#include "options.hpp"

namespace gdesp::tool {

int run_profile(const std::vector<std::string>& arguments) {
  po::options_description own("Profile");
  own.add_options()("section", po::value<std::string>()->value_name("NAME"),
                    "section of the scene (default: its first)");
  own.add_options()("line", po::value<std::string>()->value_name("X1,Y1,X2,Y2"),
                    "line, scene coordinates (default: the domain's middle along x)");
  own.add_options()("step", po::value<double>()->value_name("M")->default_value(0.0, "dp"), "distance between points");
  own.add_options()("time", po::value<std::string>()->value_name("T1,T2,..."),
                    "times; the nearest frame is taken (default: all frames)");
  CommandLine line("profile", own);
  const char* definition =
      "Free surface z(s) along a line: the highest level at which the fluid fraction f = sum V W (Wendland C2,\n"
      "h = 1.3 dp) reaches half of its deep-water value, corrected for thin sheets and vertical walls; connected "
      "water\n"
      "only. Still water is read to better than 0.1 dp. z_solids: top of the grains or of the rigid slide.\n"
      "z_bed: the walls. nan: nothing there. Level of half the smoothed fraction: cf. Marrone et al. 2010,\n"
      "J. Comput. Phys. 229, 3652, doi 10.1016/j.jcp.2010.01.019.\n";
  if (!line.parse(arguments, definition,
                  "surge-analyze profile lake.run --section axis --time 10,20,30 --plot profile.svg"))
    return 0;
  analysis::ProfileOptions options;
  if (line.has("section")) options.section = line.get<std::string>("section");
  if (line.has("line")) options.line = parse_line("--line", line.get<std::string>("line"));
  if (line.has("time")) options.times = parse_numbers("--time", line.get<std::string>("time"));
  options.step = line.get<double>("step");
  analysis::ProfileMeasurement measurement(options);
  return run_measurement(line, measurement);
}

}  // namespace gdesp::tool
