// SPDX-License-Identifier: GPL-3.0-or-later
// Curves of several tables in one figure: runs against each other and against measurements.
#include "analysis/plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "command.hpp"
#include "core/error.hpp"
#include "curve_input.hpp"
#include "options.hpp"

namespace gdesp::tool {
namespace {

using Texts = std::vector<std::string>;

po::options_description own_options() {
  po::options_description own("Curves");
  own.add_options()("table", po::value<Texts>()->value_name("TABLE"), "tables of any command (or -), one a run");
  own.add_options()("x", po::value<std::string>()->value_name("COLUMN")->default_value("t"), "");
  own.add_options()("y", po::value<Texts>()->value_name("COLUMN"), "may be repeated: a curve each");
  own.add_options()("by", po::value<std::string>()->value_name("COLUMN"), "a curve for each value of this column");
  own.add_options()("label", po::value<Texts>()->value_name("TEXT"),
                    "of a table, in their order; default: the file's name");
  own.add_options()("y-name", po::value<Texts>()->value_name("TEXT"),
                    "of a --y, in their order; default: the column's name");
  own.add_options()("where", po::value<Texts>()->value_name("COLUMN=VALUE"), "rows of the tables; may be repeated");
  own.add_options()("scale-x", po::value<double>()->value_name("F")->default_value(1.0, "1"),
                    "x of the tables is multiplied by this");
  own.add_options()("scale-y", po::value<double>()->value_name("F")->default_value(1.0, "1"),
                    "y of the tables is multiplied by this");
  own.add_options()("points", "marks instead of lines");
  own.add_options()("name", po::value<std::string>()->value_name("COLUMN"), "text beside each mark");
  own.add_options()("reference", po::value<Texts>()->value_name("TABLE"), "measurements, as marks; may be repeated");
  own.add_options()("ref-x", po::value<std::string>()->value_name("COLUMN"), "their x (default: as --x)");
  own.add_options()("ref-y", po::value<Texts>()->value_name("COLUMN"), "their y (default: as --y); may be repeated");
  own.add_options()("ref-where", po::value<Texts>()->value_name("COLUMN=VALUE"),
                    "rows of the measurements; may be repeated");
  own.add_options()("ref-label", po::value<Texts>()->value_name("TEXT"),
                    "of a curve of the measurements, in their order");
  po::options_description axes("Axes");
  axes.add_options()("x-label", po::value<std::string>()->value_name("TEXT"),
                     "with its unit; default: the column's name");
  axes.add_options()("y-label", po::value<std::string>()->value_name("TEXT"),
                     "with its unit; default: the column's name");
  axes.add_options()("x-range", po::value<std::string>()->value_name("LOW,HIGH"), "");
  axes.add_options()("y-range", po::value<std::string>()->value_name("LOW,HIGH"), "");
  axes.add_options()("log-x", "logarithmic");
  axes.add_options()("log-y", "logarithmic");
  axes.add_options()("equal", "one unit is as long on both axes");
  axes.add_options()("title", po::value<std::string>()->value_name("TEXT")->default_value(""), "");
  axes.add_options()("note", po::value<std::string>()->value_name("TEXT")->default_value(""),
                     "small print below the title");
  axes.add_options()("height", po::value<double>()->value_name("MM")->default_value(95.0, "95"),
                     "of the figure, without the legend; its width is 160 mm");
  own.add(axes);
  return own;
}

std::string base_name(const std::string& path) {
  const auto slash = path.rfind('/');
  std::string name = path == "-" ? "standard input" : path.substr(slash == std::string::npos ? 0 : slash + 1);
  const auto dot = name.rfind('.');
  return dot == std::string::npos || dot == 0 ? name : name.substr(0, dot);
}

std::string text_of(const analysis::Cell& cell) {
  const double* number = std::get_if<double>(&cell);
  return number ? analysis::format_number(*number) : std::get<std::string>(cell);
}

struct Style {
  analysis::MarkStyle mark;
  std::string name_column;
  double scale_x = 1.0, scale_y = 1.0;
};

/// One series of a table: the rows whose `by` column has the value (all where `by` is empty).
analysis::Series series_of(const analysis::Table& table, const std::string& x, const std::string& y, const Style& style,
                           const std::string& by = {}, const std::string& value = {}) {
  analysis::Series s;
  s.style = style.mark;
  const std::vector<double> all_x = table.numbers(x), all_y = table.numbers(y);
  for (std::size_t k = 0; k < table.row.size(); ++k) {
    if (!by.empty() && text_of(table.row[k][table.find(by)]) != value) continue;
    s.x.push_back(all_x[k] * style.scale_x);
    s.y.push_back(all_y[k] * style.scale_y);
    if (!style.name_column.empty())
      s.name.push_back(analysis::plain_text(text_of(table.row[k][table.find(style.name_column)])));
  }
  return s;
}

class Curves {
 public:
  explicit Curves(const CommandLine& line) : line_(line) {}

  std::vector<analysis::Series> read() {
    const Style style{line_.has("points") ? analysis::MarkStyle::points : analysis::MarkStyle::line, text("name", ""),
                      line_.get<double>("scale-x"), line_.get<double>("scale-y")};
    const Texts tables = texts("table"), y = texts("y"), labels = texts("label"), y_names = texts("y-name");
    for (std::size_t k = 0; k < tables.size(); ++k) {
      const analysis::Table table = choose_rows(read_table_or_stdin(tables[k]), texts("where"), "--where");
      const std::string label = k < labels.size() ? labels[k] : base_name(tables[k]);
      for (std::size_t j = 0; j < y.size(); ++j) {
        const std::string name = j < y_names.size() ? y_names[j] : y[j].substr(0, y[j].find('['));
        add(table, y[j], style,
            {y.size() == 1                          ? label
             : tables.size() == 1 && labels.empty() ? name
                                                    : label + ", " + name,
             tables.size() == 1 && y.size() == 1 && labels.empty()});
      }
    }
    add_references();
    return std::move(series_);
  }

  Texts texts(const char* key) const { return line_.has(key) ? line_.get<Texts>(key) : Texts{}; }
  std::string text(const char* key, const std::string& otherwise) const {
    return line_.has(key) ? line_.get<std::string>(key) : otherwise;
  }

 private:
  struct Label {
    std::string text;
    bool alone;
  };

  void add(const analysis::Table& table, const std::string& y, const Style& style, const Label& label) {
    const std::string by = text("by", ""), x = line_.get<std::string>("x");
    Texts values;
    if (by.empty())
      values.push_back("");
    else {
      for (const auto& row : table.row) {
        const std::string value = text_of(row[table.find(by)]);
        if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
      }
    }
    for (const std::string& value : values) {
      analysis::Series s = series_of(table, x, y, style, by, value);
      const std::string which = by.empty() ? "" : by.substr(0, by.find('[')) + " = " + value;
      s.label = by.empty() ? label.text : label.alone ? which : label.text + ", " + which;
      s.colour = static_cast<int>(series_.size() % 6);  // black and grey are the measurements'
      series_.push_back(std::move(s));
    }
  }

  void add_references() {
    const Texts labels = texts("ref-label"), y = line_.has("ref-y") ? texts("ref-y") : texts("y");
    const std::string x = text("ref-x", line_.get<std::string>("x"));
    std::size_t number = 0;
    for (const std::string& path : texts("reference")) {
      const analysis::Table table = choose_rows(analysis::read_table(path), texts("ref-where"), "--ref-where");
      for (const std::string& column : y) {
        analysis::Series s = series_of(table, x, column, {analysis::MarkStyle::points, ""});
        s.label = number < labels.size() ? labels[number] : base_name(path);
        s.colour = 6 + static_cast<int>(number % 2);
        series_.push_back(std::move(s));
        ++number;
      }
    }
  }

  const CommandLine& line_;
  std::vector<analysis::Series> series_;
};

void set_range(const CommandLine& line, const char* key, double& low, double& high) {
  if (!line.has(key)) return;
  const std::string option = std::string("--") + key;
  const std::vector<double> range = parse_numbers(option, line.get<std::string>(key));
  if (range.size() != 2 || !(range[0] < range[1])) throw Error(ErrorKind::usage, option + ": LOW,HIGH is needed");
  low = range[0], high = range[1];
}

void print(const std::vector<analysis::Series>& series, const CommandLine& line) {
  analysis::TableWriter writer(stdout_sink(), analysis::parse_table_format(line.get<std::string>("format")),
                               {"curve", "points", "x_first", "x_last", "y_lowest", "y_highest"});
  for (const analysis::Series& s : series) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    double count = 0;
    for (const double y : s.y) {
      if (std::isfinite(y)) low = std::min(low, y), high = std::max(high, y), ++count;
    }
    const double none = std::numeric_limits<double>::quiet_NaN();
    writer.row({s.label, count, s.x.empty() ? none : s.x.front(), s.x.empty() ? none : s.x.back(),
                count > 0 ? low : none, count > 0 ? high : none});
  }
  writer.finish();
}

}  // namespace

int run_plot(const std::vector<std::string>& arguments) {
  CommandLine line("plot", own_options(), CommandLine::Inputs::own);
  const char* definition =
      "Draws columns of tables, as the other commands print them, in one figure: several runs, with measurements as "
      "black\n"
      "marks. Nothing is computed but the two factors --scale-x and --scale-y. Labels take gnuplot's enhanced text in\n"
      "titles and axes (x_0, m^3); names of files and columns stand as they are. Prints what was drawn.\n";
  if (!line.parse(
          arguments, definition,
          "surge-analyze plot coarse.tsv fine.tsv --x 't*' --y 'x*' --label 'H/20' --label 'H/40' --plot fronts.pdf",
          "table")) {
    return 0;
  }
  Curves curves(line);
  if (curves.texts("table").empty()) throw Error(ErrorKind::usage, "plot: a table is needed, or - for standard input");
  if (curves.texts("y").empty()) throw Error(ErrorKind::usage, "plot: --y COLUMN is needed");
  if (!line.has("plot")) throw Error(ErrorKind::usage, "plot: --plot FILE is needed");
  analysis::Panel panel;
  panel.series = curves.read();
  panel.title = line.get<std::string>("title");
  panel.note = line.get<std::string>("note");
  panel.x_label = curves.text("x-label", analysis::plain_text(line.get<std::string>("x")));
  panel.y_label = curves.text("y-label", analysis::plain_text(curves.texts("y")[0]));
  panel.log_x = line.has("log-x"), panel.log_y = line.has("log-y"), panel.equal_axes = line.has("equal");
  set_range(line, "x-range", panel.x_low, panel.x_high);
  set_range(line, "y-range", panel.y_low, panel.y_high);
  print(panel.series, line);
  for (analysis::Series& s : panel.series) s.label = analysis::plain_text(s.label);
  analysis::Figure figure;
  figure.panel.push_back(std::move(panel));
  figure.panel_height_mm = line.get<double>("height");
  analysis::write_figure(figure, line.get<std::string>("plot"));
  return 0;
}

}  // namespace gdesp::tool
