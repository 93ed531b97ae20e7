// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/table.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

#include "core/error.hpp"

namespace gdesp::analysis {
namespace {

std::string without_unit(const std::string& name) { return name.substr(0, name.find('[')); }

std::string quoted_json(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04x", c);
      out += code;
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string quoted_csv(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

std::vector<std::string> split_line(const std::string& line, char separator) {
  std::vector<std::string> field(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (quoted && c == '"' && k + 1 < line.size() && line[k + 1] == '"')
      field.back() += '"', ++k;
    else if (c == '"')
      quoted = !quoted;
    else if (c == separator && !quoted)
      field.emplace_back();
    else if (c != '\r')
      field.back() += c;
  }
  for (std::string& f : field) {
    const auto first = f.find_first_not_of(' '), last = f.find_last_not_of(' ');
    f = first == std::string::npos ? "" : f.substr(first, last - first + 1);
  }
  return field;
}

Cell parse_cell(const std::string& text) {
  if (text.empty() || text == "nan" || text == "NaN" || text == "NA") return std::numeric_limits<double>::quiet_NaN();
  double value = 0.0;
  const char* begin = text.data() + (text[0] == '+' ? 1 : 0);
  const auto [end, problem] = std::from_chars(begin, text.data() + text.size(), value);
  if (problem == std::errc() && end == text.data() + text.size()) return value;
  return text;
}

}  // namespace

std::string format_number(double value) {
  if (std::isnan(value)) return "nan";
  char text[32];
  std::snprintf(text, sizeof text, "%.7g", value == 0.0 ? 0.0 : value);
  return text;
}

std::size_t Table::find(const std::string& name) const {
  for (std::size_t k = 0; k < column.size(); ++k) {
    if (column[k] == name) return k;
  }
  for (std::size_t k = 0; k < column.size(); ++k) {
    if (without_unit(column[k]) == name || without_unit(column[k]) == without_unit(name)) return k;
  }
  std::string known;
  for (const std::string& c : column) known += (known.empty() ? "" : ", ") + c;
  throw Error(ErrorKind::input, "no column \"" + name + "\"; the table has: " + known);
}

std::vector<double> Table::numbers(const std::string& name) const {
  const std::size_t k = find(name);
  std::vector<double> result;
  for (const auto& r : row) {
    const double* value = std::get_if<double>(&r[k]);
    result.push_back(value ? *value : std::numeric_limits<double>::quiet_NaN());
  }
  return result;
}

TableFormat parse_table_format(const std::string& name) {
  if (name == "tsv") return TableFormat::tsv;
  if (name == "csv") return TableFormat::csv;
  if (name == "json") return TableFormat::json;
  throw Error(ErrorKind::usage, "--format " + name + ": valid are tsv, csv, json");
}

TableWriter::TableWriter(Sink sink, TableFormat format, std::vector<std::string> column)
    : sink_(std::move(sink)), format_(format), column_(std::move(column)) {
  std::string line = format_ == TableFormat::json ? "[" : "";
  for (std::size_t k = 0; k < column_.size() && format_ != TableFormat::json; ++k) {
    if (k > 0) line += format_ == TableFormat::tsv ? '\t' : ',';
    line += format_ == TableFormat::csv ? quoted_csv(column_[k]) : column_[k];
  }
  sink_(format_ == TableFormat::json ? line : line + '\n');
}

TableWriter::~TableWriter() {
  try {
    finish();
  } catch (...) {  // the reader has gone; nothing is left to say
  }
}

void TableWriter::row(const std::vector<Cell>& cells) {
  std::string line = format_ == TableFormat::json ? (first_ ? "\n{" : ",\n{") : "";
  first_ = false;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const double* number = std::get_if<double>(&cells[k]);
    if (format_ == TableFormat::json) {
      line += (k > 0 ? "," : "") + quoted_json(column_[k]) + ':';
      line += number ? (std::isfinite(*number) ? format_number(*number) : "null")
                     : quoted_json(std::get<std::string>(cells[k]));
      continue;
    }
    if (k > 0) line += format_ == TableFormat::tsv ? '\t' : ',';
    const std::string text = number ? format_number(*number) : std::get<std::string>(cells[k]);
    line += format_ == TableFormat::csv ? quoted_csv(text) : text;
  }
  sink_(line + (format_ == TableFormat::json ? "}" : "\n"));
}

void TableWriter::finish() {
  if (finished_) return;
  finished_ = true;
  if (format_ == TableFormat::json) sink_(first_ ? "]\n" : "\n]\n");
}

Table parse_table(std::istream& in, const std::string& name) {
  Table table;
  std::string line;
  char separator = ',';
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line == "\r" || line[0] == '#') continue;
    if (table.column.empty()) {
      separator = line.find('\t') != std::string::npos ? '\t' : ',';
      table.column = split_line(line, separator);
      continue;
    }
    const std::vector<std::string> field = split_line(line, separator);
    if (field.size() != table.column.size()) {
      throw Error(ErrorKind::input, name + ":" + std::to_string(number) + ": " + std::to_string(field.size()) +
                                        " values, but the header names " + std::to_string(table.column.size()));
    }
    std::vector<Cell> cells;
    cells.reserve(field.size());
    for (const std::string& f : field) cells.push_back(parse_cell(f));
    table.row.push_back(std::move(cells));
  }
  if (table.column.empty()) throw Error(ErrorKind::input, name + ": no header line; a CSV or TSV table is needed");
  return table;
}

Table read_table(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw Error(ErrorKind::input, path + ": cannot be opened; a CSV or TSV table is needed");
  return parse_table(in, path);
}

}  // namespace gdesp::analysis
