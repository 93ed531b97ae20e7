// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/run_folder.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

#include "core/error.hpp"
#include "io/safe_file.hpp"
#include "scene/scene_source.hpp"

namespace gdesp {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t largest_list = 256u << 20;  // bytes

/// The value of attribute="..." in a line; "" when there is none.
std::string attribute(const std::string& line, const std::string& name) {
  const std::size_t at = line.find(" " + name + "=\"");
  if (at == std::string::npos) return {};
  const std::size_t first = at + name.size() + 3, last = line.find('"', first);
  return last == std::string::npos ? std::string() : line.substr(first, last - first);
}

template <class Number>
bool parse_number(const std::string& text, Number& value) {
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  return !text.empty() && result.ec == std::errc{} && result.ptr == text.data() + text.size();
}

/// Adds the frames that one .pvd lists, by number.
void read_pvd(const fs::path& folder, const std::string& kind, std::map<int, FramePaths>& frames) {
  const fs::path path = folder / (kind + ".pvd");
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return;
  const std::string text = read_text_file(path.string(), largest_list);
  int line_number = 0;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const std::string line = text.substr(start, end - start);
    start = end + 1;
    ++line_number;
    if (line.find("<DataSet ") == std::string::npos) continue;
    const std::string file = attribute(line, "file");
    const std::size_t digits = file.rfind('_');
    FramePaths frame;
    int number = 0;
    const bool sound = digits != std::string::npos && file.size() > digits + 5 &&
                       file.find("..") == std::string::npos && parse_number(attribute(line, "timestep"), frame.time) &&
                       std::isfinite(frame.time) &&
                       parse_number(file.substr(digits + 1, file.size() - digits - 5), number);
    if (!sound)
      throw Error(ErrorKind::input, path.string() + ":" + std::to_string(line_number) +
                                        ": not a frame of this run: " + line.substr(0, 100));
    const std::size_t comment = line.find("<!-- step ");
    if (comment != std::string::npos)
      std::from_chars(line.data() + comment + 10, line.data() + line.size(), frame.step);
    FramePaths& entry = frames.try_emplace(number, frame).first->second;
    frame_path(entry, kind) = (folder / file).string();
  }
}

}  // namespace

std::string& frame_path(FramePaths& paths, const std::string& kind) {
  return kind == "fluid" ? paths.fluid : (kind == "grains" ? paths.grains : paths.bodies);
}

std::string frame_name(const std::string& kind, int number) {
  char digits[16];
  std::snprintf(digits, sizeof digits, "%05d", number);
  return "frames/" + kind + "_" + digits + ".vtp";
}

std::string pvd_text(const std::string& run_folder, const std::string& kind, std::vector<FramePaths> frames) {
  std::string out = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (FramePaths& frame : frames) {
    const std::string& path = frame_path(frame, kind);
    if (path.empty()) continue;
    out += "<DataSet timestep=\"" + toml_number(frame.time) + "\" part=\"0\" file=\"" +
           path.substr(std::min(path.size(), run_folder.size() + 1)) + "\"/><!-- step " + std::to_string(frame.step) +
           " -->\n";
  }
  return out + "</Collection>\n</VTKFile>\n";
}

std::vector<FramePaths> list_frames(const std::string& run_folder) {
  std::error_code ignored;
  const fs::path folder(run_folder);
  if (!fs::is_directory(folder, ignored)) throw Error(ErrorKind::input, run_folder + ": there is no such run folder");
  std::map<int, FramePaths> frames;
  for (const char* kind : frame_kinds) read_pvd(folder, kind, frames);
  if (frames.empty() && !fs::exists(folder / "frames", ignored) && !fs::exists(folder / "case.link", ignored))
    throw Error(ErrorKind::input, run_folder + ": is no run folder (it has no case.link and no frames)");
  std::vector<FramePaths> out;
  out.reserve(frames.size());
  for (const auto& entry : frames) out.push_back(entry.second);
  std::stable_sort(out.begin(), out.end(), [](const FramePaths& a, const FramePaths& b) { return a.time < b.time; });
  return out;
}

std::string run_case_path(const std::string& run_folder) {
  const fs::path link = fs::path(run_folder) / "case.link";
  std::error_code ignored;
  if (!fs::is_directory(run_folder, ignored))
    throw Error(ErrorKind::input, run_folder + ": there is no such run folder");
  if (!fs::exists(link, ignored))
    throw Error(ErrorKind::input, run_folder + ": has no case.link, so its case is not known");
  std::string text = read_text_file(link.string(), 65536);
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  if (text.empty() || text.find('\n') != std::string::npos || text.find('\0') != std::string::npos)
    throw Error(ErrorKind::input, link.string() + ": expected one line, the path of the case");
  return fs::absolute(fs::path(run_folder) / text).lexically_normal().string();
}

void write_run_case_path(const std::string& run_folder, const std::string& case_path) {
  write_text_file((fs::path(run_folder) / "case.link").string(),
                  fs::absolute(case_path).lexically_normal().string() + "\n");
}

}  // namespace gdesp
