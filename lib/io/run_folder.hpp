// SPDX-License-Identifier: GPL-3.0-or-later
// Names inside a run folder, and the .pvd series that list its frames.
#pragma once

#include <string>
#include <vector>

#include "io/frame.hpp"

namespace gdesp {

inline constexpr const char* frame_kinds[] = {"fluid", "grains", "bodies"};

/// The member of `paths` that belongs to the kind ("fluid", "grains", "bodies").
std::string& frame_path(FramePaths& paths, const std::string& kind);

/// frames/fluid_00012.vtp
std::string frame_name(const std::string& kind, int number);

/// The text of a .pvd series of one kind; paths relative to the run folder.
std::string pvd_text(const std::string& run_folder, const std::string& kind, std::vector<FramePaths> frames);

}  // namespace gdesp
