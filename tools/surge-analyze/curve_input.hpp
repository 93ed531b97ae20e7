// SPDX-License-Identifier: GPL-3.0-or-later
// Curves out of tables: columns by name, rows by --where.
#pragma once

#include <string>
#include <vector>

#include "analysis/comparison.hpp"
#include "analysis/table.hpp"

namespace gdesp::tool {

/// A table from a file or, for "-", from standard input.
analysis::Table read_table_or_stdin(const std::string& path);
/// Keeps the rows whose column equals a value, for each "column=value". Throws Error(usage, input).
analysis::Table choose_rows(const analysis::Table& table, const std::vector<std::string>& where,
                            const std::string& option);

}  // namespace gdesp::tool
