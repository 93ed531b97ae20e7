// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "analysis/comparison.hpp"
#include "analysis/plot.hpp"
#include "analysis/run_quantity.hpp"
#include "analysis/run_record.hpp"
#include "command.hpp"
#include "core/error.hpp"
#include "curve_input.hpp"
#include "options.hpp"

namespace gdesp::tool {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// One point of the chart. cost: wall seconds per simulated second.
struct Point {
  std::string name, group, source;
  double dp = none, error = none, cost = none, score = none;
};

Point measure_run(const CommandLine& line, const std::string& run, double reference) {
  const auto record = analysis::read_run_record(run);
  if (!record || record->simulated <= 0.0) {
    throw Error(ErrorKind::input,
                run + ": no run.json with wall_seconds and t; its cost is not known (give it through --points)");
  }
  analysis::SourceOptions source = source_options(line);
  source.inputs = {run};
  const analysis::RunQuantity q = analysis::measure_quantity(source, line.get<std::string>("quantity"));
  Point p;
  p.name = std::filesystem::path(run).lexically_normal().filename().string();
  p.group = (q.preset.empty() ? "run" : q.preset) + ", " + record->device;
  p.source = "measured, " + (record->device_name.empty() ? record->device : record->device_name);
  p.dp = q.dp;
  p.error = 100.0 * std::abs(q.value - reference) / std::abs(reference);
  p.cost = record->cost();
  p.score = record->score;
  return p;
}

std::string spacing(double metres) {
  char text[32];
  if (metres < 0.1)
    std::snprintf(text, sizeof text, "%.3g mm", 1e3 * metres);
  else
    std::snprintf(text, sizeof text, "%.3g m", metres);
  return text;
}

/// Points that others measured: columns name, error[%], cost[s/s], and where known group, source, dp[m], N.
void add_points(const std::string& path, std::vector<Point>& points) {
  const analysis::Table table = analysis::read_table(path);
  const auto text = [&](const char* column, std::size_t k, const std::string& otherwise) {
    for (const std::string& c : table.column) {
      if (c.substr(0, c.find('[')) != column) continue;
      const analysis::Cell& cell = table.row[k][table.find(column)];
      const double* number = std::get_if<double>(&cell);
      return number ? analysis::format_number(*number) : std::get<std::string>(cell);
    }
    return otherwise;
  };
  const auto number = [&](const char* column, std::size_t k) {
    for (const std::string& c : table.column) {
      if (c.substr(0, c.find('[')) == column) return table.numbers(column)[k];
    }
    return none;
  };
  const std::vector<double> error = table.numbers("error"), cost = table.numbers("cost");
  for (std::size_t k = 0; k < table.row.size(); ++k) {
    points.push_back({text("name", k, "point " + std::to_string(k + 1)), text("group", k, "others"),
                      text("source", k, path), number("dp", k), error[k], cost[k], number("N", k)});
  }
}

analysis::Figure draw(const std::vector<Point>& points, const std::vector<bool>& front, const std::string& title) {
  analysis::Panel panel;
  panel.title = title;
  panel.note = "down and to the left is better; dashed: points that no other beats in both";
  panel.x_label = "wall seconds per simulated second";
  panel.y_label = "error (%)";
  panel.log_x = panel.log_y = true;
  analysis::Series best;
  best.label = "Pareto front";
  best.style = analysis::MarkStyle::dashes;
  best.colour = 6;
  std::vector<std::size_t> by_cost(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) by_cost[k] = k;
  std::sort(by_cost.begin(), by_cost.end(),
            [&](std::size_t a, std::size_t b) { return points[a].cost < points[b].cost; });
  const double floor = 1e-3;                      // %, a logarithmic axis has no zero
  std::vector<bool> named(points.size(), false);  // on the front, and not on top of the name before
  double last_cost = 0.0;
  for (const std::size_t k : by_cost) {
    if (front[k] && points[k].cost > 2.0 * last_cost) named[k] = true, last_cost = points[k].cost;
    if (front[k]) best.x.push_back(points[k].cost), best.y.push_back(std::max(points[k].error, floor));
  }
  panel.series.push_back(best);
  std::vector<std::string> groups;
  for (const Point& p : points) {
    if (std::find(groups.begin(), groups.end(), p.group) == groups.end()) groups.push_back(p.group);
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    analysis::Series s;
    s.label = analysis::plain_text(groups[g]);
    s.colour = static_cast<int>(g % 6);
    bool spacings = true;
    for (const std::size_t k : by_cost) {
      const Point& p = points[k];
      if (p.group != groups[g]) continue;
      s.x.push_back(p.cost);
      s.y.push_back(std::max(p.error, floor));
      spacings = spacings && std::isfinite(p.dp);
      s.name.push_back(!std::isfinite(p.dp) ? analysis::plain_text(p.name) : named[k] ? "dp " + spacing(p.dp) : "");
    }
    s.style = spacings && s.x.size() > 1 ? analysis::MarkStyle::line_points : analysis::MarkStyle::points;
    panel.series.push_back(std::move(s));
  }
  analysis::Figure figure;
  figure.panel.push_back(std::move(panel));
  figure.panel_height_mm = 110.0;
  return figure;
}

}  // namespace

int run_tradeoff(const std::vector<std::string>& arguments) {
  po::options_description own("Trade-off");
  own.add_options()("quantity", po::value<std::string>()->value_name("Q")->default_value("runup"),
                    analysis::quantity_help());
  own.add_options()("reference", po::value<double>()->value_name("VALUE"), "what the quantity should be");
  own.add_options()("points", po::value<std::vector<std::string>>()->value_name("TABLE"),
                    "points of other programs or earlier studies: columns name, error[%], cost[s/s] and, where known, "
                    "group, source, dp[m], N");
  own.add_options()("title", po::value<std::string>()->value_name("TEXT"), "of the chart");
  CommandLine line("tradeoff", own);
  const char* definition =
      "Error against cost. Each run is a point: error, the share by which its quantity differs from the reference, in "
      "%; cost,\n"
      "wall seconds per simulated second (run.json); N, the paper's score n t / T. On the Pareto front (yes) are the\n"
      "points that no other beats in both error and cost (Ehrgott 2005, Multicriteria Optimization, Springer, doi\n"
      "10.1007/3-540-27659-9).\n";
  if (!line.parse(
          arguments, definition,
          "surge-analyze tradeoff dp*.run --quantity runup --reference 0.28 --points others.tsv --plot tradeoff.svg"))
    return 0;
  std::vector<Point> points;
  const auto runs = line.get<std::vector<std::string>>("input");
  if (!runs.empty() && !line.has("reference"))
    throw Error(ErrorKind::usage, "tradeoff: --reference VALUE is needed for runs");
  points.reserve(runs.size());
  for (const std::string& run : runs) points.push_back(measure_run(line, run, line.get<double>("reference")));
  if (line.has("points")) {
    for (const std::string& path : line.get<std::vector<std::string>>("points")) add_points(path, points);
  }
  if (points.empty()) throw Error(ErrorKind::usage, "tradeoff: runs or --points are needed");
  std::vector<double> cost, error;
  for (const Point& p : points) cost.push_back(p.cost), error.push_back(p.error);
  const std::vector<bool> front = analysis::pareto_front(cost, error);
  analysis::TableWriter writer(stdout_sink(), analysis::parse_table_format(line.get<std::string>("format")),
                               {"name", "group", "dp[m]", "error[%]", "cost[s/s]", "N", "pareto", "source"});
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point& p = points[k];
    writer.row({p.name, p.group, p.dp, p.error, p.cost, p.score, std::string(front[k] ? "yes" : "no"), p.source});
  }
  writer.finish();
  if (line.has("plot")) {
    const std::string title =
        line.has("title") ? line.get<std::string>("title") : "Error against cost, " + line.get<std::string>("quantity");
    analysis::write_figure(draw(points, front, analysis::plain_text(title)), line.get<std::string>("plot"));
  }
  return 0;
}

}  // namespace gdesp::tool
