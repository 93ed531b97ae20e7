// SPDX-License-Identifier: GPL-3.0-or-later
// Tables as the tool prints them and as references come: named columns with units in brackets ("t[s]").
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <variant>
#include <vector>

namespace gdesp::analysis {

using Cell = std::variant<double, std::string>;

struct Table {
  std::vector<std::string> column;
  std::vector<std::vector<Cell>> row;

  /// Index of a column by its full name or by its name without the unit; throws Error(input) that lists them.
  std::size_t find(const std::string& name) const;
  /// A column's numbers; text becomes NaN.
  std::vector<double> numbers(const std::string& name) const;
};

enum class TableFormat { tsv, csv, json };
/// Throws Error(usage) with what is valid.
TableFormat parse_table_format(const std::string& name);

/// Prints row by row, each handed over whole, so that a reader downstream follows a live run.
/// A missing number (NaN) is "nan" in TSV and CSV, null in JSON.
class TableWriter {
 public:
  using Sink = std::function<void(const std::string&)>;
  TableWriter(Sink sink, TableFormat format, std::vector<std::string> column);
  ~TableWriter();
  TableWriter(const TableWriter&) = delete;
  TableWriter& operator=(const TableWriter&) = delete;
  void row(const std::vector<Cell>& cells);
  void finish();  ///< closes the JSON array; the destructor does it too, but cannot report a failure

 private:
  Sink sink_;
  TableFormat format_;
  std::vector<std::string> column_;
  bool first_ = true, finished_ = false;
};

/// Seven significant digits, shortest form: 0.1, 12.5, 3.2e-07.
std::string format_number(double value);

/// Reads TSV or CSV (by content: a tab in the header line means TSV); lines that start with '#' are comments;
/// the first other line is the header. Throws Error(input) naming file and line.
Table read_table(const std::string& path);
Table parse_table(std::istream& in, const std::string& name);

}  // namespace gdesp::analysis
