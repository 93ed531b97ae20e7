// SPDX-License-Identifier: GPL-3.0-or-later
// gdesp-run: from a case to the frames of its simulation.
#include "options.hpp"
#include "run_loop.hpp"

namespace {

int run(const std::vector<std::string>& arguments) {
  auto options = gdesp::tool::parse_options(arguments);
  if (!options) return 0;
  gdesp::cli::install_signal_handlers();
  gdesp::tool::resolve_paths(*options);
  return gdesp::tool::run_case(std::move(*options));
}

}  // namespace

int main(int argc, char** argv) { return gdesp::cli::run_tool("gdesp-run", argc, argv, run); }
