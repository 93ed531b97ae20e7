// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/run_quantity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/front_measurement.hpp"
#include "analysis/gauge_measurement.hpp"
#include "analysis/run_up_measurement.hpp"
#include "core/error.hpp"

namespace gdesp::analysis {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Rows of a measurement over a whole run, as a table.
Table collect(FrameSource& source, Measurement& measurement) {
  Table table;
  table.column = measurement.begin(source.info());
  run_measurements(source, {&measurement}, {[&](const std::vector<Cell>& row) { table.row.push_back(row); }});
  return table;
}

double highest_run_up(FrameSource& source, const std::string& region) {
  RunUpOptions options;
  options.region = region;
  RunUpMeasurement measurement(options);
  collect(source, measurement);
  for (const auto& m : measurement.maxima()) {
    if (m.region == (region.empty() ? "all" : region)) return m.height;
  }
  return none;
}

double gauge_value(FrameSource& source, const std::string& name, const char* column) {
  GaugeOptions options;
  options.arrivals = true;
  GaugeMeasurement measurement(options);
  const Table table = collect(source, measurement);
  const std::size_t gauge = table.find("gauge");
  std::string known;
  for (std::size_t k = 0; k < table.row.size(); ++k) {
    if (std::get<std::string>(table.row[k][gauge]) == name) return table.numbers(column)[k];
    known += (known.empty() ? "" : ", ") + std::get<std::string>(table.row[k][gauge]);
  }
  throw Error(ErrorKind::usage, "no gauge \"" + name + "\"; the scene has " + known);
}

double last_front(FrameSource& source, const std::string& direction) {
  FrontOptions options;
  if (!direction.empty()) options.direction = parse_direction(direction);
  FrontMeasurement measurement(options);
  const Table table = collect(source, measurement);
  const std::vector<double> x = table.numbers("x_front");
  return x.back() - x.front();
}

}  // namespace

RunQuantity measure_quantity(const SourceOptions& options, const std::string& quantity) {
  const auto colon = quantity.find(':');
  const std::string kind = quantity.substr(0, colon),
                    argument = colon == std::string::npos ? "" : quantity.substr(colon + 1);
  const bool needs_argument = kind == "arrival" || kind == "level";
  if ((kind != "runup" && kind != "front" && !needs_argument) || (needs_argument && argument.empty())) {
    throw Error(ErrorKind::usage, "--quantity " + quantity + ": valid are " + quantity_help());
  }
  FrameSource source(options);
  RunQuantity q;
  q.dp = source.info().dp;
  q.particles = source.info().fluid_count;
  if (source.info().has_case) q.preset = source.info().scene.numerics.preset;
  q.unit = kind == "arrival" ? "s" : "m";
  if (kind == "runup")
    q.value = highest_run_up(source, argument);
  else if (kind == "front")
    q.value = last_front(source, argument);
  else if (kind == "arrival")
    q.value = gauge_value(source, argument, "t_arrival");
  else
    q.value = gauge_value(source, argument, "level_max");
  return q;
}

}  // namespace gdesp::analysis
