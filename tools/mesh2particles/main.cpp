// SPDX-License-Identifier: GPL-3.0-or-later
// mesh2particles: from terrain, water and slides as an engineer has them to particles.
#include "options.hpp"

namespace {

int run(const std::vector<std::string>& arguments) {
  const auto options = gdesp::tool::parse_options(arguments);
  if (!options) return 0;
  if (!options->check.empty()) return gdesp::tool::check(*options);
  return options->explain ? gdesp::tool::explain(*options) : gdesp::tool::build(*options);
}

}  // namespace

int main(int argc, char** argv) { return gdesp::cli::run_tool("mesh2particles", argc, argv, run); }
