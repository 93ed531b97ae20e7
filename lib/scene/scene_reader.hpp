// SPDX-License-Identifier: GPL-3.0-or-later
// Inside the scene module only: the parts that see toml++.
#pragma once

#define TOML_HEADER_ONLY 1
// Assertions of the library meet some texts that it refuses right after: they are no fault of the program.
#define TOML_ASSERT static_cast<void>
#include <toml++/toml.h>

#include <string>

#include "scene/scene_visitor.hpp"

namespace gdesp::scene_detail {

/// "lake.toml:12", or "--set slide.diameter=abc" for a value from the command line.
std::string where_is(const toml::node& node);

/// Fills `scene` from the table; `file` names it in messages and its folder is where relative paths start.
/// Unknown keys are not its business (scene_source.cpp checks them before).
KeySources read_scene_table(const toml::table& root, const std::string& file, bool check_files, Scene& scene);

}  // namespace gdesp::scene_detail
