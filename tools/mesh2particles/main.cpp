// SPDX-License-Identifier: GPL-3.0-or-later
// mesh2particles: from terrain, water and slides as an engineer has them to particles.
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <new>

#include "options.hpp"
#include "scene_summary.hpp"

namespace {

/// A machine that runs out of memory ends a program without a word. Here the allocation that would not fit fails instead: `bytes`
/// are what may come to what the program has already.
void stay_within(double bytes) {
  double pages[6] = {};  // total, resident, shared, text, library, data
  std::ifstream sizes("/proc/self/statm");
  for (double& p : pages) sizes >> p;
  rlimit data{};
  if (!sizes || !std::isfinite(bytes) || ::getrlimit(RLIMIT_DATA, &data) != 0) return;
  data.rlim_cur =
      std::min(data.rlim_cur, static_cast<rlim_t>(bytes + pages[5] * static_cast<double>(::sysconf(_SC_PAGESIZE))));
  ::setrlimit(RLIMIT_DATA, &data);
}

int run(const std::vector<std::string>& arguments) {
  const auto options = gdesp::tool::parse_options(arguments);
  if (!options) return 0;
  const double free = gdesp::tool::available_memory("cpu");
  stay_within(free);
  try {
    if (!options->check.empty()) return gdesp::tool::check(*options);
    return options->explain ? gdesp::tool::explain(*options) : gdesp::tool::build(*options);
  } catch (const std::bad_alloc&) {
    throw gdesp::Error(gdesp::ErrorKind::resource,
                       "out of memory: " + gdesp::tool::memory_text(free) +
                           " were free; twice the resolution.dp needs about an eighth (a quarter in the plane)");
  }
}

}  // namespace

int main(int argc, char** argv) { return gdesp::cli::run_tool("mesh2particles", argc, argv, run); }
