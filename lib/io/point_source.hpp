// SPDX-License-Identifier: GPL-3.0-or-later
// A file of points with named columns, whoever wrote it: what case and frame reading stand on.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/vec3.hpp"
#include "particles/particle_tables.hpp"

namespace gdesp {

class PointSource {
 public:
  virtual ~PointSource() = default;
  virtual std::size_t size() const = 0;
  virtual std::vector<Vec3d> positions() const = 0;
  virtual std::vector<std::string> names() const = 0;
  /// Components of the column; 0 when there is none of that name.
  virtual int components(const std::string& name) const = 0;
  /// Fills size() x components() values.
  virtual void read(const std::string& name, float* values) const = 0;
  virtual void read(const std::string& name, std::int64_t* values) const = 0;
  /// A field (not one value a point); empty when there is none of that name.
  virtual std::vector<double> field(const std::string& name) const = 0;
  /// Polygons as triangles, with the cell columns "body" and "smooth" when they are there.
  virtual TriangleTable triangles() const = 0;
};

/// Inline binary VTP, not compressed (this project's own flavour, strictly checked: sizes that lie cannot make it
/// take memory beyond the file's own size). Returns null when the file is VTP of another flavour.
std::unique_ptr<PointSource> open_plain_vtp(const std::string& path);
/// VTP, VTU and legacy VTK through VTK.
std::unique_ptr<PointSource> open_with_vtk(const std::string& path);
/// Points in an OpenVDB file.
std::unique_ptr<PointSource> open_vdb_points(const std::string& path);
/// By the name's ending; throws Error(input) that lists what can be read.
std::unique_ptr<PointSource> open_points(const std::string& path);

}  // namespace gdesp
