// SPDX-License-Identifier: GPL-3.0-or-later
// Readers of third parties fall over damaged files: VTK and OpenVDB follow sizes and indices that a file states. They
// run in a child process with limits on memory and time, so that a file that brings them down is an Error here.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/point_source.hpp"

namespace gdesp {

/// One column of a file, as floats or as whole numbers, point by point.
struct MemoryColumn {
  std::string name;
  int components = 1;
  std::vector<float> numbers;  ///< empty when the column holds whole numbers
  std::vector<std::int64_t> integers;
};

struct MemoryField {
  std::string name;
  std::vector<double> values;
};

/// A point file in memory.
struct MemoryPoints : PointSource {
  std::vector<Vec3d> position;
  std::vector<MemoryColumn> columns;
  std::vector<MemoryField> fields;
  TriangleTable surface;  ///< its vertices are `position` and are not repeated here

  std::size_t size() const override { return position.size(); }
  std::vector<Vec3d> positions() const override { return position; }
  std::vector<std::string> names() const override;
  int components(const std::string& name) const override;
  void read(const std::string& name, float* values) const override;
  void read(const std::string& name, std::int64_t* values) const override;
  std::vector<double> field(const std::string& name) const override;
  TriangleTable triangles() const override;

 private:
  const MemoryColumn* find(const std::string& name) const;
};

/// Calls `reader(path, points)` in a child process and brings the points over. An Error of the child is thrown here; a
/// child that dies, or passes its limits, is an Error(input) that names the file and `library`.
/// Limits: 4 GiB + 64 x the file's length of memory, 20 s + 2 s a MiB of processor time.
std::unique_ptr<MemoryPoints> read_isolated(const std::string& path, const char* library,
                                            const std::function<void(const std::string&, MemoryPoints&)>& reader);

}  // namespace gdesp
