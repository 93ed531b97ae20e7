// SPDX-License-Identifier: GPL-3.0-or-later
// Between particle tables and the columns of files. The names of the columns are those of docs/formats/frames.md.
#pragma once

#include <string>
#include <vector>

#include "io/frame.hpp"
#include "io/point_source.hpp"
#include "io/vtp_writer.hpp"

namespace gdesp {

void write_fluid(const std::string& path, const FluidTable& fluid, std::vector<VtpArray> field);
void write_grains(const std::string& path, const GrainTable& grains, std::vector<VtpArray> field);
void write_boundary(const std::string& path, const BoundaryTable& boundary, std::vector<VtpArray> field);
void write_triangles(const std::string& path, const TriangleTable& triangles, std::vector<VtpArray> field);

/// Columns that the file lacks stay empty; a column that a mapping names must be there. Positions must be finite.
FluidTable fluid_of(const PointSource& source, const std::string& path, const std::vector<FieldMapping>& mapping);
GrainTable grains_of(const PointSource& source, const std::string& path, const std::vector<FieldMapping>& mapping);
BoundaryTable boundary_of(const PointSource& source, const std::string& path);
TriangleTable triangles_of(const PointSource& source, const std::string& path);
FrameMeta meta_of(const PointSource& source);

}  // namespace gdesp
