// SPDX-License-Identifier: GPL-3.0-or-later
// How the emulated device ends the program.
#pragma once

#include <string>

namespace gdesp::emulated {

/// Prints "emulated device: WHAT (in KERNEL)" on stderr and ends the program with exit status 1.
[[noreturn]] void trouble(const std::string& what, const std::string& kernel);

}  // namespace gdesp::emulated
