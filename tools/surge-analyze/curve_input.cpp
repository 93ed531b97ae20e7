// SPDX-License-Identifier: GPL-3.0-or-later
#include "curve_input.hpp"

#include <iostream>

#include "core/error.hpp"

namespace gdesp::tool {

analysis::Table read_table_or_stdin(const std::string& path) {
  return path == "-" ? analysis::parse_table(std::cin, "standard input") : analysis::read_table(path);
}

analysis::Table choose_rows(const analysis::Table& table, const std::vector<std::string>& where,
                            const std::string& option) {
  analysis::Table chosen = table;
  for (const std::string& condition : where) {
    // "case=n2=2 a=2.25in": the column's name ends at the first '='.
    const auto equals = condition.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(ErrorKind::usage, option + " " + condition + ": valid is COLUMN=VALUE");
    const std::size_t column = chosen.find(condition.substr(0, equals));
    const std::string wanted = condition.substr(equals + 1);
    std::vector<std::vector<analysis::Cell>> rows;
    for (const auto& row : chosen.row) {
      const double* number = std::get_if<double>(&row[column]);
      const std::string text = number ? analysis::format_number(*number) : std::get<std::string>(row[column]);
      if (text == wanted) rows.push_back(row);
    }
    chosen.row = std::move(rows);
    if (chosen.row.empty()) throw Error(ErrorKind::input, option + " " + condition + ": no row is left");
  }
  return chosen;
}

}  // namespace gdesp::tool
