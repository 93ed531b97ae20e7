// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <vector>

#include "core/error.hpp"
#include "io/safe_file.hpp"

namespace gdesp::tool {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
constexpr std::size_t largest_log = std::size_t{4} << 30, largest_json = std::size_t{64} << 20;  // bytes

ordered_json vector_json(const Vec3d& v) { return ordered_json::array({v.x, v.y, v.z}); }

/// The lines of a log up to and with `last_step`, and up to recovery number `recoveries`.
std::string kept_lines(const std::string& path, std::int64_t last_step, int recoveries) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {};
  const std::string text = read_text_file(path, largest_log);
  std::size_t end = 0;
  for (std::size_t newline = text.find('\n'); newline != std::string::npos; newline = text.find('\n', end)) {
    const ordered_json line = ordered_json::parse(text.begin() + static_cast<std::ptrdiff_t>(end),
                                                  text.begin() + static_cast<std::ptrdiff_t>(newline), nullptr, false);
    if (!line.is_object() || line.value("step", std::int64_t{-1}) < 0 || line["step"] > last_step) break;
    if (line.value("recovery", 0) > recoveries) break;
    end = newline + 1;
  }
  return text.substr(0, end);
}

void remove_parts(const fs::path& folder) {
  std::vector<fs::path> parts;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().filename().string().find(".part-") != std::string::npos) parts.push_back(entry.path());
  for (const fs::path& part : parts) fs::remove(part, ignored);
}

}  // namespace

ordered_json diagnostics_record(const Diagnostics& d) {
  ordered_json record{{"t", d.time},
                      {"step", d.step},
                      {"dt", d.time_step},
                      {"limited_by", d.limited_by},
                      {"fluid_mass", d.fluid_mass},
                      {"fluid_kinetic", d.fluid_kinetic},
                      {"fluid_potential", d.fluid_potential},
                      {"fluid_elastic", d.fluid_elastic},
                      {"fluid_momentum", vector_json(d.fluid_momentum)},
                      {"grain_mass", d.grain_mass},
                      {"grain_kinetic", d.grain_kinetic},
                      {"grain_potential", d.grain_potential},
                      {"grain_elastic", d.grain_elastic},
                      {"grain_momentum", vector_json(d.grain_momentum)},
                      {"body_kinetic", d.body_kinetic},
                      {"body_potential", d.body_potential},
                      {"body_elastic", d.body_elastic},
                      {"body_momentum", vector_json(d.body_momentum)},
                      {"largest_body_speed", d.largest_body_speed},
                      {"largest_speed", d.largest_speed},
                      {"largest_grain_speed", d.largest_grain_speed},
                      {"mach", d.mach},
                      {"largest_density_error", d.largest_density_error},
                      {"largest_overlap", d.largest_overlap},
                      {"deepest_in_wall", d.deepest_in_wall},
                      {"fluid_particles", d.fluid_particles},
                      {"grains", d.grains},
                      {"lost_fluid", d.lost_fluid},
                      {"lost_grains", d.lost_grains},
                      {"rebuilds", d.rebuilds},
                      {"grain_substeps", d.grain_substeps},
                      {"awake_share", d.awake_share}};
  if (d.far_lakes > 0) {
    record["far_lake_mass"] = d.far_lake_mass;
    record["far_lake_kinetic"] = d.far_lake_kinetic;
    record["far_lake_potential"] = d.far_lake_potential;
    record["far_lake_momentum"] = d.far_lake_momentum;
    record["far_lake_highest"] = d.far_lake_highest;
  }
  return record;
}

DiagnosticsLog::DiagnosticsLog(const std::string& run_folder, std::int64_t last_step, int recoveries)
    : path_(run_folder + "/log.ndjson"), last_step_(last_step) {
  write_text_file(path_, last_step >= 0 ? kept_lines(path_, last_step, recoveries) : std::string());
  open_at_end();
}

DiagnosticsLog::~DiagnosticsLog() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void DiagnosticsLog::open_at_end() {
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (descriptor_ < 0) throw Error(ErrorKind::resource, path_ + ": cannot be opened: " + std::strerror(errno));
}

void DiagnosticsLog::put(const std::string& line) {
  std::size_t done = 0;
  while (done < line.size()) {
    const ssize_t n = ::write(descriptor_, line.data() + done, line.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw Error(ErrorKind::resource, path_ + ": cannot be written: " + std::strerror(errno));
    done += static_cast<std::size_t>(n);
  }
}

void DiagnosticsLog::add(const Diagnostics& d) {
  if (d.step <= last_step_) return;
  put(diagnostics_record(d).dump() + "\n");
  last_step_ = d.step;
}

void DiagnosticsLog::go_back(std::int64_t step, const ordered_json& record) {
  ::close(descriptor_);
  descriptor_ = -1;
  write_text_file(path_, kept_lines(path_, step, record.value("recovery", 1) - 1));
  open_at_end();
  put(record.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n");
  last_step_ = step;
}

void write_run_json(const std::string& run_folder, const ordered_json& content) {
  write_text_file(run_folder + "/run.json", content.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n");
}

ordered_json read_run_json(const std::string& run_folder) {
  const std::string path = run_folder + "/run.json";
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return nullptr;
  const ordered_json content = ordered_json::parse(read_text_file(path, largest_json), nullptr, false);
  return content.is_object() ? content : ordered_json(nullptr);
}

void tidy_run_folder(const std::string& run_folder, bool resume) {
  const fs::path folder(run_folder);
  std::error_code ignored;
  remove_parts(folder);
  remove_parts(folder / "frames");
  remove_parts(folder / "checkpoints");
  remove_parts(folder / "failure");
  if (resume) return;
  fs::remove_all(folder / "checkpoints", ignored);
  fs::remove_all(folder / "failure", ignored);
  fs::remove(folder / "log.ndjson", ignored);
  fs::remove(folder / "run.json", ignored);
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

}  // namespace gdesp::tool
