// SPDX-License-Identifier: GPL-3.0-or-later
// VTK's PolyData XML (VTP), inline binary, not compressed: the one flavour that every ParaView reads (5.11 on
// Debian cannot read appended data) and the fastest to write. Arrays are written from where they lie.
// Format: VTK User's Guide, "VTK File Formats", XML formats; one base64 stream of a UInt64 byte count and the data.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/vec3.hpp"
#include "particles/particle_tables.hpp"

namespace gdesp {

enum class ScalarType { float32, float64, int32, uint32, int64, uint8 };
std::size_t size_of(ScalarType type);
const char* vtk_name(ScalarType type);

/// A column to write; `data` must live until the file is written.
struct VtpArray {
  std::string name;
  ScalarType type;
  int components;
  const void* data;
  std::size_t tuples;
};

inline VtpArray vtp_array(const std::string& name, const std::vector<float>& v) {
  return {name, ScalarType::float32, 1, v.data(), v.size()};
}
inline VtpArray vtp_array(const std::string& name, const std::vector<Vec3f>& v) {
  return {name, ScalarType::float32, 3, v.data(), v.size()};
}
inline VtpArray vtp_array(const std::string& name, const std::vector<double>& v) {
  return {name, ScalarType::float64, 1, v.data(), v.size()};
}
inline VtpArray vtp_array(const std::string& name, const std::vector<std::int32_t>& v) {
  return {name, ScalarType::int32, 1, v.data(), v.size()};
}
inline VtpArray vtp_array(const std::string& name, const std::vector<std::uint32_t>& v) {
  return {name, ScalarType::uint32, 1, v.data(), v.size()};
}
inline VtpArray vtp_array(const std::string& name, const std::vector<std::int64_t>& v) {
  return {name, ScalarType::int64, 1, v.data(), v.size()};
}

/// What goes into one file. With `triangles` their vertices are the points; else the points are one poly-vertex.
struct VtpContent {
  const std::vector<Vec3d>* position = nullptr;
  const std::vector<Vec3<std::int32_t>>* triangles = nullptr;
  std::vector<VtpArray> field;   ///< any length
  std::vector<VtpArray> points;  ///< one tuple a point; empty arrays are left out
  std::vector<VtpArray> cells;   ///< one tuple a triangle
};

/// Writes aside and renames. Throws Error(resource) when it cannot be written; std::logic_error when an array's
/// length does not fit.
void write_vtp(const std::string& path, const VtpContent& content);

}  // namespace gdesp
