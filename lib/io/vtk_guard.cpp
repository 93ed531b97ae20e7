// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cctype>
#include <cstdint>
#include <string_view>

#include "core/error.hpp"
#include "io/foreign_guard.hpp"
#include "io/safe_file.hpp"

namespace gdesp {
namespace {

constexpr std::size_t largest_file = std::size_t{64} << 30;  // bytes
constexpr std::uint64_t best_compression = 1100;             // zlib's bound, about 1032 : 1

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(ErrorKind::input, path + ": damaged or incomplete VTK file: " + why);
}

/// The whole number at the start of the text, capped; 0 when there is none.
std::uint64_t leading_number(std::string_view text) {
  std::uint64_t value = 0;
  for (const char c : text) {
    if (!std::isdigit(static_cast<unsigned char>(c))) break;
    value = std::min<std::uint64_t>(value * 10 + std::uint64_t(c - '0'), std::uint64_t{1} << 56);
  }
  return value;
}

void check_count(const std::string& path, std::string_view what, std::uint64_t count, std::uint64_t most) {
  if (count > most)
    refuse(path, std::string(what) + " = " + std::to_string(count) + " in a file that can hold " +
                     std::to_string(most) + " at most");
}

void check_xml(const std::string& path, std::string_view text) {
  if (text.find("<VTKFile") == std::string_view::npos) refuse(path, "it holds no <VTKFile>");
  if (text.rfind("</VTKFile>") == std::string_view::npos) refuse(path, "its end is missing");
  const bool compressed = text.find("compressor=") != std::string_view::npos;
  const std::uint64_t most = text.size() * (compressed ? best_compression : 1);
  for (const std::string_view key : {"NumberOfPoints=", "NumberOfCells=", "NumberOfVerts=", "NumberOfLines=",
                                     "NumberOfStrips=", "NumberOfPolys=", "NumberOfTuples="})
    for (std::size_t at = text.find(key); at != std::string_view::npos; at = text.find(key, at + 1))
      check_count(path, key.substr(0, key.size() - 1), leading_number(text.substr(at + key.size() + 1)), most);
}

/// Legacy: after a keyword at the start of a line, the numbers that follow are sizes.
void check_legacy(const std::string& path, std::string_view text) {
  if (!text.starts_with("# vtk DataFile")) refuse(path, "it does not start with \"# vtk DataFile\"");
  for (const std::string_view word :
       {"POINTS", "VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS", "CELLS", "CELL_TYPES", "POINT_DATA", "CELL_DATA",
        "FIELD", "DIMENSIONS", "OFFSETS", "CONNECTIVITY", "LOOKUP_TABLE"})
    for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
      if (at > 0 && text[at - 1] != '\n') continue;
      const std::string_view line = text.substr(at, std::min<std::size_t>(200, text.find('\n', at) - at));
      for (std::size_t i = 1; i < line.size(); ++i)
        if (line[i - 1] == ' ') check_count(path, word, leading_number(line.substr(i)), text.size());
    }
}

}  // namespace

void refuse_implausible_vtk(const std::string& path) {
  const std::string text = read_text_file(path, largest_file);
  if (text.empty()) refuse(path, "it is empty");
  if (path.ends_with(".vtk"))
    check_legacy(path, text);
  else
    check_xml(path, text);
}

}  // namespace gdesp
