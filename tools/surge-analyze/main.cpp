// SPDX-License-Identifier: GPL-3.0-or-later
// surge-analyze: from frames to the numbers and pictures of a hazard report.
#include <malloc.h>

#include <cstdio>

#include "cli/cli.hpp"
#include "command.hpp"
#include "options.hpp"

namespace {

std::string usage_text() {
  std::string text =
      "surge-analyze COMMAND RUN [options]\n"
      "Tables and plots from the frames of a run. RUN is a run folder, frame files, or - for the records of a running\n"
      "gdesp-run. Tables go to stdout (TSV; --format csv|json), plots to --plot FILE.svg|.png|.pdf.\n\nCommands:\n";
  for (const auto& command : gdesp::tool::commands()) {
    text += std::string("  ") + command.name + std::string(11 - std::string(command.name).size(), ' ') +
            command.summary + "\n";
  }
  return text + "\n\"surge-analyze COMMAND --help\" explains the command's definition and options.\n";
}

int run(const std::vector<std::string>& arguments) {
  const auto common = gdesp::cli::common_options();
  if (arguments.empty()) { throw gdesp::Error(gdesp::ErrorKind::usage, "no command; surge-analyze --help lists them"); }
  if (arguments[0].empty() || arguments[0][0] == '-') {
    const auto vm = gdesp::cli::parse(arguments, common, {});
    if (gdesp::cli::answer_help_or_version(
            vm, usage_text(), common,
            "Example: gdesp-run lake.case -o lake.run | surge-analyze runup - > runup.tsv\n")) {
      return 0;
    }
    throw gdesp::Error(gdesp::ErrorKind::usage, "no command; surge-analyze --help lists them");
  }
  std::vector<std::string> names;
  for (const auto& command : gdesp::tool::commands()) {
    if (arguments[0] == command.name) return command.run({arguments.begin() + 1, arguments.end()});
    names.push_back(command.name);
  }
  const std::string near = gdesp::cli::did_you_mean(arguments[0], names);
  throw gdesp::Error(
      gdesp::ErrorKind::usage,
      "unknown command " + arguments[0] + (near.empty() ? "" : "; did you mean " + near + "?") + " (see --help)");
}

}  // namespace

int main(int argc, char** argv) {
  // A frame's tables go back to the system when they are freed, and what is small shares one heap: else each of the
  // threads that read frames keeps a heap with holes, and the memory of a long run grows by a fifth.
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
  mallopt(M_ARENA_MAX, 1);
  return gdesp::cli::run_tool("surge-analyze", argc, argv, gdesp::tool::until_reader_leaves(run));
}
