// SPDX-License-Identifier: GPL-3.0-or-later
#include "failure_files.hpp"

#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "io/safe_file.hpp"
#include "io/tables.hpp"

namespace gdesp::tool {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
constexpr std::size_t most_ids = 100;

bool finite(const Vec3d& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool finite(const Vec3f& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool finite(float v) { return std::isfinite(v); }
template <class T>
bool finite(const std::vector<T>& column, std::size_t k) {
  return column.empty() || finite(column[k]);
}

bool finite_row(const FluidTable& t, std::size_t k) {
  return finite(t.position, k) && finite(t.velocity, k) && finite(t.density, k) && finite(t.pressure, k) &&
         finite(t.porosity, k);
}
bool finite_row(const GrainTable& t, std::size_t k) {
  return finite(t.position, k) && finite(t.velocity, k) && finite(t.angular_velocity, k);
}

template <class T>
void keep_rows(std::vector<T>& column, const std::vector<std::size_t>& rows) {
  if (column.empty()) return;
  std::vector<T> kept;
  kept.reserve(rows.size());
  for (const std::size_t k : rows) kept.push_back(column[k]);
  column.swap(kept);
}
void keep_rows(FluidTable& t, const std::vector<std::size_t>& rows) {
  keep_rows(t.position, rows);
  keep_rows(t.velocity, rows);
  keep_rows(t.density, rows);
  keep_rows(t.pressure, rows);
  keep_rows(t.porosity, rows);
  keep_rows(t.mass_share, rows);
  keep_rows(t.id, rows);
}
void keep_rows(GrainTable& t, const std::vector<std::size_t>& rows) {
  keep_rows(t.position, rows);
  keep_rows(t.diameter, rows);
  keep_rows(t.density, rows);
  keep_rows(t.velocity, rows);
  keep_rows(t.angular_velocity, rows);
  keep_rows(t.group, rows);
  keep_rows(t.id, rows);
}

/// Leaves the finite rows; says how many went and who they were.
template <class Table>
void only_finite(Table& table, ordered_json& report) {
  std::vector<std::size_t> rows;
  ordered_json ids = ordered_json::array();
  for (std::size_t k = 0; k < table.position.size(); ++k) {
    if (finite_row(table, k))
      rows.push_back(k);
    else if (ids.size() < most_ids)
      ids.push_back(table.id[k]);
  }
  report["particles"] = table.position.size();
  report["not_finite"] = table.position.size() - rows.size();
  if (rows.size() == table.position.size()) return;
  report["not_finite_ids"] = ids;
  keep_rows(table, rows);
}

}  // namespace

ordered_json write_failure_state(const std::string& run_folder, const std::string& name, Frame frame) {
  const std::string folder = run_folder + "/failure";
  std::error_code trouble;
  fs::create_directories(folder, trouble);
  if (trouble) throw Error(ErrorKind::resource, folder + ": cannot be made: " + trouble.message());
  ordered_json report{{"t", frame.time}, {"step", frame.step}};
  const std::vector<VtpArray> field{{"time", ScalarType::float64, 1, &frame.time, 1},
                                    {"step", ScalarType::int64, 1, &frame.step, 1}};
  if (!frame.fluid.position.empty()) {
    only_finite(frame.fluid, report["fluid"]);
    report["fluid"]["path"] = folder + "/" + name + "_fluid.vtp";
    write_fluid(report["fluid"]["path"], frame.fluid, field);
  }
  if (!frame.grains.position.empty()) {
    only_finite(frame.grains, report["grains"]);
    report["grains"]["path"] = folder + "/" + name + "_grains.vtp";
    write_grains(report["grains"]["path"], frame.grains, field);
  }
  return report;
}

void write_failure_report(const std::string& run_folder, const ordered_json& report) {
  write_text_file(run_folder + "/failure/failure.json", report.dump(1) + "\n");
}

}  // namespace gdesp::tool
