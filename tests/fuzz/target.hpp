// SPDX-License-Identifier: GPL-3.0-or-later
// What is fuzzed: one reader a target. A target is given bytes; the readers that want a file find them in one.
#pragma once

#include <string>
#include <vector>

namespace gdesp::fuzz {

struct Target {
  const char* name;  ///< also the folder of its corpus
  /// Endings of the file the bytes are written to, by the first letter of the seed's name ("a.stl" -> ".stl"): empty for bytes
  /// that no file holds.
  bool needs_file;
  /// Reads. Throws gdesp::Error when the input is unusable; anything else that leaves it is a finding.
  /// `path`: the file with the bytes (needs_file), in a folder of its own.
  void (*read)(const std::string& bytes, const std::string& path);
  /// Seeds made by the project's own writers, as {file name, bytes}; may be null.
  std::vector<std::pair<std::string, std::string>> (*seeds)(const std::string& folder);
};

const std::vector<Target>& targets();

}  // namespace gdesp::fuzz
