// SPDX-License-Identifier: GPL-3.0-or-later
// A look at foreign files before VTK or OpenVDB reads them: VTK believes the sizes that a file states and takes memory
// for them; OpenVDB reads past the end of a torn file without noticing.
#pragma once

#include <string>

namespace gdesp {

/// Throws Error(input) when a VTP, VTU or legacy VTK file is missing or empty, is not complete, or states more points,
/// cells or values than its length can hold.
void refuse_implausible_vtk(const std::string& path);

/// Throws Error(input) when the file is missing, is no OpenVDB file, or is shorter than its own table of grids says.
/// Layout: openvdb/io/Archive.cc and GridDescriptor.cc of OpenVDB 10 (file versions 222 to 224).
void refuse_torn_vdb(const std::string& path);

}  // namespace gdesp
