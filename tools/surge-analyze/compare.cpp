// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>

#include "analysis/comparison.hpp"
#include "analysis/plot.hpp"
#include "command.hpp"
#include "core/error.hpp"
#include "curve_input.hpp"
#include "options.hpp"

namespace gdesp::tool {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

po::options_description own_options() {
  using Texts = std::vector<std::string>;
  po::options_description own("Comparison");
  own.add_options()("table", po::value<Texts>()->value_name("TABLE REFERENCE"),
                    "our table (or -) and the reference, CSV or TSV");
  own.add_options()("x", po::value<std::string>()->value_name("COLUMN")->default_value("t"), "our x");
  own.add_options()("y", po::value<std::string>()->value_name("COLUMN"), "our y");
  own.add_options()("ref-x", po::value<std::string>()->value_name("COLUMN"), "the reference's x (default: as ours)");
  own.add_options()("ref-y", po::value<std::string>()->value_name("COLUMN"), "the reference's y (default: as ours)");
  own.add_options()("scale-x", po::value<double>()->value_name("F")->default_value(1.0, "1"),
                    "our x is multiplied by this (seconds to a paper's time)");
  own.add_options()("scale-y", po::value<double>()->value_name("F")->default_value(1.0, "1"),
                    "our y is multiplied by this");
  own.add_options()("low", po::value<std::string>()->value_name("COLUMN"), "lower end of the reference's band");
  own.add_options()("high", po::value<std::string>()->value_name("COLUMN"), "upper end of the reference's band");
  own.add_options()("where", po::value<Texts>()->value_name("COLUMN=VALUE"), "rows of our table; may be repeated");
  own.add_options()("ref-where", po::value<Texts>()->value_name("COLUMN=VALUE"),
                    "rows of the reference; may be repeated");
  own.add_options()("from", po::value<double>()->value_name("X"), "compare from this x on");
  own.add_options()("until", po::value<double>()->value_name("X"), "compare up to this x");
  own.add_options()(
      "max-shift", po::value<double>()->value_name("X")->default_value(0.0, "0"),
      "allow one constant shift of our x up to +-X (a release that takes time); the best is taken and said");
  own.add_options()("label-x", po::value<std::string>()->value_name("TEXT"), "axis of the plot");
  own.add_options()("label-y", po::value<std::string>()->value_name("TEXT"), "axis of the plot");
  return own;
}

struct Labels {
  std::string x, y, ours, reference;
};

analysis::Figure draw(const analysis::Curve& ours, const analysis::Curve& reference, const analysis::Comparison& c,
                      const Labels& labels) {
  analysis::Panel panel;
  panel.x_label = labels.x;
  panel.y_label = labels.y;
  panel.title = "Comparison with " + analysis::plain_text(labels.reference);
  char note[160];
  std::snprintf(note, sizeof note, "RMS %.3g (%.2g %% of the range), bias %.3g, largest %.3g", c.rms,
                100.0 * c.rms / c.range, c.bias, c.largest);
  panel.note = note;
  if (!reference.low.empty()) {
    panel.series.push_back(
        {"band", reference.x, reference.y, reference.low, reference.high, analysis::MarkStyle::band, {}, 7});
    panel.series.push_back(
        {analysis::plain_text(labels.reference), reference.x, reference.y, {}, {}, analysis::MarkStyle::line, {}, 6});
  } else {
    panel.series.push_back(
        {analysis::plain_text(labels.reference), reference.x, reference.y, {}, {}, analysis::MarkStyle::points, {}, 6});
  }
  analysis::Curve moved = ours;
  for (double& x : moved.x) x += c.shift;
  panel.series.push_back(
      {analysis::plain_text(labels.ours), moved.x, moved.y, {}, {}, analysis::MarkStyle::line, {}, 0});
  analysis::Figure figure;
  figure.panel.push_back(std::move(panel));
  figure.panel_height_mm = 100.0;
  return figure;
}

std::string base_name(const std::string& path) {
  const auto slash = path.rfind('/');
  return path == "-" ? "ours" : path.substr(slash == std::string::npos ? 0 : slash + 1);
}

}  // namespace

int run_compare(const std::vector<std::string>& arguments) {
  using Texts = std::vector<std::string>;
  CommandLine line("compare", own_options(), CommandLine::Inputs::own);
  const char* definition =
      "Differences ours - reference at the reference's points, ours interpolated linearly: RMS, bias (mean), largest "
      "(with\n"
      "its sign, and where); also as a share of the reference's range; and the share of points inside the\n"
      "reference's band. Points outside our range are left out, their number is said. Cf. Oberkampf and Trucano 2002, "
      "Prog.\n"
      "Aerosp. Sci. 38, 209, doi 10.1016/S0376-0421(02)00005-2.\n";
  if (!line.parse(arguments, definition,
                  "surge-analyze gauge dam.run | surge-analyze compare - data/reference/lobovsky_2014_h300_pressure.csv"
                  " --y pressure --where gauge=sensor2 --scale-x 5.718 --scale-y 3.408e-4 --ref-x t_star --ref-y "
                  "p_median --low p_low --high p_high",
                  "table")) {
    return 0;
  }
  const Texts files = line.has("table") ? line.get<Texts>("table") : Texts{};
  if (files.size() != 2) throw Error(ErrorKind::usage, "compare: two tables are needed, ours (or -) and the reference");
  if (!line.has("y")) throw Error(ErrorKind::usage, "compare: --y COLUMN is needed");
  const auto texts = [&](const char* key) { return line.has(key) ? line.get<Texts>(key) : Texts{}; };
  const auto text = [&](const char* key, const std::string& otherwise) {
    return line.has(key) ? line.get<std::string>(key) : otherwise;
  };
  const analysis::Table reference_table = choose_rows(read_table_or_stdin(files[1]), texts("ref-where"), "--ref-where");
  const analysis::Table table = choose_rows(read_table_or_stdin(files[0]), texts("where"), "--where");
  const std::string x = line.get<std::string>("x"), y = line.get<std::string>("y");
  analysis::Curve ours{table.numbers(x), table.numbers(y), {}, {}};
  analysis::Curve reference{
      reference_table.numbers(text("ref-x", x)), reference_table.numbers(text("ref-y", y)), {}, {}};
  for (double& value : ours.x) value *= line.get<double>("scale-x");
  for (double& value : ours.y) value *= line.get<double>("scale-y");
  if (line.has("low") != line.has("high")) throw Error(ErrorKind::usage, "compare: --low and --high go together");
  if (line.has("low")) {
    reference.low = reference_table.numbers(line.get<std::string>("low"));
    reference.high = reference_table.numbers(line.get<std::string>("high"));
  }
  analysis::ComparisonOptions options;
  options.max_shift = line.get<double>("max-shift");
  if (line.has("from")) options.from = line.get<double>("from");
  if (line.has("until")) options.until = line.get<double>("until");
  const analysis::Comparison c = analysis::compare_curves(ours, reference, options);
  analysis::TableWriter writer(stdout_sink(), analysis::parse_table_format(line.get<std::string>("format")),
                               {"quantity", "points", "left_out", "rms", "bias", "largest", "largest_at", "rms[%]",
                                "largest[%]", "inside_band[%]", "shift"});
  const double share = c.range > 0.0 ? 100.0 / c.range : none;
  writer.row({y, static_cast<double>(c.points), static_cast<double>(reference.x.size() - c.points), c.rms, c.bias,
              c.largest, c.largest_at, c.rms * share, c.largest * share, c.inside ? 100.0 * *c.inside : none, c.shift});
  writer.finish();
  if (line.has("plot")) {
    analysis::write_figure(
        draw(ours, reference, c, {text("label-x", x), text("label-y", y), base_name(files[0]), base_name(files[1])}),
        line.get<std::string>("plot"));
  }
  return 0;
}

}  // namespace gdesp::tool
