// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace gdesp::geometry {

/// SHA-256 of a file (FIPS 180-4) as 64 hexadecimal digits. Throws Error(input) when it cannot be read.
std::string sha256_of_file(const std::string& path);

}  // namespace gdesp::geometry
