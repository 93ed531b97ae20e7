// SPDX-License-Identifier: GPL-3.0-or-later
// A look at a VTK file before VTK reads it: VTK believes the sizes that a file states and takes memory for them.
#pragma once

#include <string>

namespace gdesp {

/// Throws Error(input) when the file is missing or empty, is not complete, or states more points, cells or values
/// than its length can hold.
void refuse_implausible_vtk(const std::string& path);

}  // namespace gdesp
