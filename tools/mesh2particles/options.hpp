// SPDX-License-Identifier: GPL-3.0-or-later
// The command line of mesh2particles.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/cli.hpp"

namespace gdesp::tool {

struct MeshOptions {
  std::string scene;   ///< TOML file
  std::string output;  ///< case folder
  std::vector<Override> overrides;
  std::vector<std::string> check;  ///< files to judge instead of building
  std::string preview;             ///< PNG or VTP, or empty
  bool force = false, explain = false;
};

/// Parses and checks. nullopt when --help or --version has been answered. Throws Error(usage).
std::optional<MeshOptions> parse_options(const std::vector<std::string>& arguments);

int build(const MeshOptions& options);    ///< scene to case; prints the case record
int explain(const MeshOptions& options);  ///< what would be built, on stdout
int check(const MeshOptions& options);    ///< a report per file on stdout; 3 when one is refused

}  // namespace gdesp::tool
