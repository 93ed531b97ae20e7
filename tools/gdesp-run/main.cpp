// SPDX-License-Identifier: GPL-3.0-or-later
// gdesp-run: from a case to the frames of its simulation.
#include <csignal>

#include "exec/backend.hpp"
#include "explain.hpp"
#include "options.hpp"
#include "run_loop.hpp"
#include "target.hpp"

namespace {

int run(const std::vector<std::string>& arguments) {
  auto options = gdesp::tool::parse_options(arguments);
  if (!options) return 0;
  gdesp::cli::install_signal_handlers();
  gdesp::tool::resolve_paths(*options);
  if (gdesp::cli::interrupted()) return 130;
  if (options->accuracy > 0.0 || options->budget > 0.0) return gdesp::tool::run_to_target(*options);
  if (options->explain) return gdesp::tool::explain(std::move(*options));
  return gdesp::tool::run_case(std::move(*options));
}

}  // namespace

int main(int argc, char** argv) {
  gdesp::exec::wait_briefly(argv);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is an error with a message
  return gdesp::cli::run_tool("gdesp-run", argc, argv, run);
}
