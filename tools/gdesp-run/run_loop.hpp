// SPDX-License-Identifier: GPL-3.0-or-later
// A run from case to last frame.
#pragma once

#include "options.hpp"

namespace gdesp::tool {

/// Reads the case of the options, runs it to its end, writes frames, log and records. Returns the exit code: 0, or
/// 130 when interrupted (a checkpoint has been written). Throws Error: input, numerical, resource.
int run_case(RunOptions options);

}  // namespace gdesp::tool
