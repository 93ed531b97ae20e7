// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/report.hpp"

#include <unistd.h>

#include "command.hpp"
#include "core/error.hpp"
#include "options.hpp"

namespace gdesp::tool {

int run_report(const std::vector<std::string>& arguments) {
  using Texts = std::vector<std::string>;
  po::options_description own("Report");
  own.add_options()("output,o", po::value<std::string>()->value_name("FILE.html"), "the page");
  own.add_options()("with", po::value<Texts>()->value_name("RUN"),
                    "the same scene at another resolution, for error bars; give at least two");
  own.add_options()("picture", po::value<Texts>()->value_name("FILE.png"),
                    "a picture to put in front (see render); may be repeated");
  own.add_options()("cell", po::value<double>()->value_name("M")->default_value(0.0, "chosen"), "cell of the maps");
  CommandLine line("report", own);
  const char* definition =
      "One page of HTML, complete in itself (no network): scene, what was modelled and what was left out, run-up table "
      "with\n"
      "error bars, profiles, maps, gauges, slide, energy budget, the solver's diagnostics, warnings, and how to\n"
      "reproduce it all. Each quantity as defined by its own command.\n";
  if (!line.parse(arguments, definition,
                  "surge-analyze report lake.run -o lake.html --with lake-6m.run --with lake-8m.run"))
    return 0;
  if (!line.has("output")) throw Error(ErrorKind::usage, "report: -o FILE.html is needed");
  const analysis::SourceOptions options = source_options(line);
  analysis::ReportOptions report;
  if (line.has("with")) report.coarser = line.get<Texts>("with");
  if (line.has("picture")) report.pictures = line.get<Texts>("picture");
  report.map_cell = line.get<double>("cell");
  analysis::FrameSource source(options);
  std::optional<cli::Progress> progress;
  if (source.expected() > 1 && ::isatty(STDERR_FILENO)) progress.emplace("report");
  const std::string path = line.get<std::string>("output");
  const auto warnings = analysis::write_report(source, options, report, path, [&](double fraction, double time) {
    if (progress) progress->update(fraction, "t = " + analysis::format_number(time) + " s");
  });
  progress.reset();
  for (const std::string& w : warnings) cli::warning(w);
  cli::info("report: " + path);
  return source.failed() ? static_cast<int>(ErrorKind::numerical) : 0;
}

}  // namespace gdesp::tool
