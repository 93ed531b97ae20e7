// SPDX-License-Identifier: GPL-3.0-or-later
// A look at an OpenVDB file before OpenVDB reads it: OpenVDB reads past the end of a torn file without noticing.
#pragma once

#include <string>

namespace gdesp {

/// Throws Error(input) when the file is missing, is no OpenVDB file, or is shorter than its own table of grids says.
/// Layout: openvdb/io/Archive.cc and GridDescriptor.cc of OpenVDB 10 (file versions 222 to 224).
void refuse_torn_vdb(const std::string& path);

}  // namespace gdesp
