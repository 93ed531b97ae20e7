// SPDX-License-Identifier: GPL-3.0-or-later
// Surface meshes from files, by content rather than by name where the format allows: STL (ASCII, binary), OBJ, PLY,
// OFF through CGAL; VTK, VTP, VTU through VTK; MSH 2 and 4, GEO, STEP through gmsh.
#pragma once

#include <string>

#include "geometry/triangle_mesh.hpp"

namespace gdesp::geometry {

struct MeshOptions {
  double mesh_size = 0.0;  ///< m, element size for GEO and STEP (required there)
  double scale = 1.0;      ///< unit of the file in metres
  Vec3d translate;         ///< m, after scaling
};

/// Whether the name's ending is one of a mesh format (also with .gz behind it).
bool is_mesh_name(const std::string& path);

/// Reads a mesh as it is: polygons are split into triangles, equal vertices are joined (STL), nothing is repaired.
/// Throws Error(input): missing, not of its format, cut short, indices out of range, numbers not finite, no triangle.
TriangleMesh read_mesh(const std::string& path, const MeshOptions& options = {});

// The parts, by library. Each throws Error(input).
TriangleMesh read_mesh_vtk(const std::string& path);
TriangleMesh read_mesh_gmsh(const std::string& path, double mesh_size);

}  // namespace gdesp::geometry
