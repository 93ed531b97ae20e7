// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "options.hpp"

namespace gdesp::tool {

/// --explain: prints models, counts, limits and memory, takes some steps to tell the cost, writes no file. Returns 0.
int explain(RunOptions options);

}  // namespace gdesp::tool
