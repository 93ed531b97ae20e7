// SPDX-License-Identifier: GPL-3.0-or-later
// Reading a scene out of a file that holds more than a scene (a case's case.toml).
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace gdesp {

struct SceneReadOptions {
  bool check_files = true;                  ///< input files must exist (a case no longer needs them)
  std::vector<std::string> foreign_tables;  ///< top-level tables that are not the scene's
  bool replace_preset = false;              ///< an overriding preset also replaces the old preset's values
};

/// As read_scene, with options.
Scene read_scene(const std::string& path, const std::vector<Override>& overrides, const SceneReadOptions& options);

/// A top-level table of a TOML file as JSON text; "" when the file has none of that name.
/// Throws Error(input) when the file cannot be read or is not TOML.
std::string toml_table_as_json(const std::string& path, const std::string& table);

/// A number as TOML: shortest text that reads back the same, always with '.' or 'e'.
std::string toml_number(double value);
/// A basic TOML string with quotes and escapes.
std::string toml_string(const std::string& text);

}  // namespace gdesp
