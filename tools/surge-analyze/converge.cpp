// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "analysis/comparison.hpp"
#include "analysis/plot.hpp"
#include "analysis/run_quantity.hpp"
#include "command.hpp"
#include "core/error.hpp"
#include "curve_input.hpp"
#include "options.hpp"

namespace gdesp::tool {
namespace {

analysis::Figure draw(const std::vector<double>& spacing, const std::vector<double>& value,
                      const analysis::Convergence& c, const std::string& quantity) {
  analysis::Panel panel;
  panel.title = "Convergence of " + analysis::plain_text(quantity);
  panel.x_label = "particle spacing dp (m)";
  panel.y_label = analysis::plain_text(quantity);
  panel.series.push_back({"runs", spacing, value, {}, {}, analysis::MarkStyle::line_points, {}, 0});
  if (c.kind == analysis::ConvergenceKind::monotone) {
    char note[120];
    std::snprintf(note, sizeof note, "observed order %.2f; extrapolated %.5g; error bar of the finest +-%.2g (GCI)",
                  c.order, c.extrapolated, c.error_bar);
    panel.note = note;
    const auto finest = static_cast<std::size_t>(std::min_element(spacing.begin(), spacing.end()) - spacing.begin());
    panel.series.push_back({"finest, with GCI",
                            {spacing[finest]},
                            {value[finest]},
                            {value[finest] - c.error_bar},
                            {value[finest] + c.error_bar},
                            analysis::MarkStyle::points,
                            {},
                            1});
    panel.series.push_back({"extrapolated", {0.0}, {c.extrapolated}, {}, {}, analysis::MarkStyle::points, {}, 2});
  } else {
    panel.note = "not converging monotonically: " + to_string(c.kind) + "; no order, no error bar";
  }
  analysis::Figure figure;
  figure.panel.push_back(std::move(panel));
  return figure;
}

struct Runs {
  std::vector<double> spacing, value;
  std::string quantity;
};

Runs read_runs(const CommandLine& line) {
  Runs runs;
  runs.quantity = line.get<std::string>("quantity");
  const auto inputs = line.get<std::vector<std::string>>("input");
  if (line.has("table")) {
    if (!inputs.empty()) throw Error(ErrorKind::usage, "converge: runs or --table, not both");
    const analysis::Table table = read_table_or_stdin(line.get<std::string>("table"));
    runs.spacing = table.numbers(line.get<std::string>("spacing"));
    if (!line.has("value")) throw Error(ErrorKind::usage, "converge --table: --value COLUMN is needed");
    runs.quantity = line.get<std::string>("value");
    runs.value = table.numbers(runs.quantity);
    return runs;
  }
  if (inputs.size() < 3)
    throw Error(ErrorKind::usage,
                "converge: at least three runs (or --table) are needed, " + std::to_string(inputs.size()) + " given");
  for (const std::string& input : inputs) {
    analysis::SourceOptions source = source_options(line);
    source.inputs = {input};
    const analysis::RunQuantity q = analysis::measure_quantity(source, runs.quantity);
    runs.spacing.push_back(q.dp);
    runs.value.push_back(q.value);
    cli::info(input + ": dp " + analysis::format_number(q.dp) + " m, " + runs.quantity + " " +
              analysis::format_number(q.value) + " " + q.unit);
  }
  return runs;
}

}  // namespace

int run_converge(const std::vector<std::string>& arguments) {
  po::options_description own("Convergence");
  own.add_options()("quantity", po::value<std::string>()->value_name("Q")->default_value("runup"),
                    analysis::quantity_help());
  own.add_options()("table", po::value<std::string>()->value_name("FILE"),
                    "a table with one row a run, instead of runs (- for standard input)");
  own.add_options()("spacing", po::value<std::string>()->value_name("COLUMN")->default_value("dp"), "of the table");
  own.add_options()("value", po::value<std::string>()->value_name("COLUMN"), "of the table");
  CommandLine line("converge", own);
  const char* definition =
      "Observed order, Richardson extrapolation and error bar (grid convergence index, safety factor 1.25) of the "
      "three\n"
      "finest runs, by the procedure of Celik et al. 2008, J. Fluids Eng. 130, 078001, doi 10.1115/1.2960953. Runs "
      "that\n"
      "oscillate or diverge get no order and no error bar: the table says so and the exit code is 4.\n";
  if (!line.parse(arguments, definition, "surge-analyze converge dp8.run dp6.run dp4.run --quantity 'runup:far bank'"))
    return 0;
  const Runs runs = read_runs(line);
  const analysis::Convergence c = analysis::assess_convergence(runs.spacing, runs.value);
  const auto finest =
      static_cast<std::size_t>(std::min_element(runs.spacing.begin(), runs.spacing.end()) - runs.spacing.begin());
  analysis::TableWriter writer(
      stdout_sink(), analysis::parse_table_format(line.get<std::string>("format")),
      {"quantity", "convergence", "order", "finest", "extrapolated", "error_bar", "error_bar[%]", "ratio"});
  const bool monotone = c.kind == analysis::ConvergenceKind::monotone;
  writer.row({runs.quantity, to_string(c.kind), c.order, runs.value[finest], c.extrapolated, c.error_bar,
              100.0 * c.error_bar / std::abs(runs.value[finest]), c.ratio});
  writer.finish();
  if (line.has("plot"))
    analysis::write_figure(draw(runs.spacing, runs.value, c, runs.quantity), line.get<std::string>("plot"));
  if (monotone) return 0;
  cli::warning("the runs do not converge monotonically (" + to_string(c.kind) +
               "): no order and no error bar; finer runs are needed");
  return static_cast<int>(ErrorKind::numerical);
}

}  // namespace gdesp::tool
