// SPDX-License-Identifier: GPL-3.0-or-later
// --check: each file judged alone.
#include <cmath>
#include <cstdio>
#include <iostream>

#include "geometry/file_check.hpp"
#include "options.hpp"

namespace gdesp::tool {

int check(const MeshOptions& o) {
  bool refused = false;
  for (const auto& file : o.check) {
    const geometry::FileReport report = geometry::check_file(file);
    refused = refused || report.verdict == geometry::MeshVerdict::refused;
    if (cli::stdout_is_terminal()) {
      std::cout << geometry::describe(report) << std::flush;
      continue;
    }
    nlohmann::ordered_json r;
    r["record"] = "check";
    r["path"] = file;
    r["verdict"] = geometry::verdict_name(report.verdict);
    r["kind"] = report.kind;
    for (const auto& [name, value] : report.numbers) {
      if (value == std::floor(value) && std::abs(value) < 1e15)
        r[name] = static_cast<long long>(value);
      else
        r[name] = value;
    }
    r["found"] = report.found;
    r["repair"] = report.repair;
    if (!report.refusal.empty()) r["refusal"] = report.refusal;
    cli::write_record(r);
  }
  return refused ? 3 : 0;
}

}  // namespace gdesp::tool
