// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/run_record.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "core/error.hpp"

namespace gdesp::analysis {
namespace {

template <class T>
T value_or(const nlohmann::ordered_json& json, const char* key, T otherwise) {
  const auto it = json.find(key);
  if (it == json.end()) return otherwise;
  if constexpr (std::is_same_v<T, std::string>)
    return it->is_string() ? it->get<std::string>() : otherwise;
  else
    return it->is_number() ? it->get<T>() : otherwise;
}

}  // namespace

std::optional<RunRecord> read_run_record(const std::string& run_folder) {
  const std::string path = run_folder + "/run.json";
  std::ifstream in(path);
  if (!in) return std::nullopt;
  RunRecord r;
  r.json = nlohmann::ordered_json::parse(in, nullptr, false);
  if (!r.json.is_object()) throw Error(ErrorKind::input, path + ": not a JSON object");
  r.command = value_or<std::string>(r.json, "command", "");
  r.device = value_or<std::string>(r.json, "device", "");
  r.device_name = value_or<std::string>(r.json, "device_name", "");
  r.version = value_or<std::string>(r.json, "version", "");
  r.commit = value_or<std::string>(r.json, "commit", "");
  r.status = value_or<std::string>(r.json, "status", "");
  r.threads = value_or<int>(r.json, "threads", 0);
  r.wall_seconds = value_or<double>(r.json, "wall_seconds", 0.0);
  r.simulated = value_or<double>(r.json, "t", 0.0);
  r.score = value_or<double>(r.json, "score", 0.0);
  return r;
}

const std::vector<double>* RunLog::find(const std::string& wanted) const {
  const auto it = std::find(name.begin(), name.end(), wanted);
  return it == name.end() ? nullptr : &value[static_cast<std::size_t>(it - name.begin())];
}

namespace {

bool is_vector(const nlohmann::ordered_json& item) {
  return item.is_array() && item.size() == 3 && item[0].is_number() && item[1].is_number() && item[2].is_number();
}

double magnitude(const nlohmann::ordered_json& v) {
  return std::hypot(v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
}

}  // namespace

RunLog read_run_log(const std::string& run_folder) {
  RunLog log;
  std::ifstream in(run_folder + "/log.ndjson");
  std::size_t lines = 0;
  for (std::string line; std::getline(in, line);) {
    const auto record = nlohmann::ordered_json::parse(line, nullptr, false);
    if (!record.is_object()) continue;
    ++lines;
    for (const auto& [key, item] : record.items()) {
      if (!item.is_number() && !is_vector(item)) continue;
      auto it = std::find(log.name.begin(), log.name.end(), key);
      if (it == log.name.end()) {
        log.name.push_back(key);
        log.value.emplace_back(lines - 1, std::numeric_limits<double>::quiet_NaN());
        it = log.name.end() - 1;
      }
      log.value[static_cast<std::size_t>(it - log.name.begin())].push_back(item.is_number() ? item.get<double>()
                                                                                            : magnitude(item));
    }
    for (auto& column : log.value) column.resize(lines, std::numeric_limits<double>::quiet_NaN());
  }
  return log;
}

}  // namespace gdesp::analysis
