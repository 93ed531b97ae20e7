// SPDX-License-Identifier: GPL-3.0-or-later
// Judging and mending surfaces (CGAL polygon mesh processing): what is wrong, what was done, or why nothing can be
// done without guessing, with the place.
#pragma once

#include <string>
#include <vector>

#include "geometry/triangle_mesh.hpp"

namespace gdesp::geometry {

/// What a surface is meant to be.
enum class MeshPurpose {
  solid,  ///< closed: a slide, a body, a wall
  sheet,  ///< open and single-valued from above: terrain
  any     ///< judged for both
};

enum class MeshVerdict { usable, repaired, refused };

/// Counts of what was found, before any repair, and what became of it.
struct MeshReport {
  MeshVerdict verdict = MeshVerdict::usable;
  bool closed = false;  ///< after repair
  bool sheet = false;   ///< open and single-valued from above, after repair
  std::size_t vertices = 0, triangles = 0;
  std::size_t duplicate_vertices = 0, duplicate_triangles = 0, degenerate_triangles = 0, unused_vertices = 0;
  std::size_t border_edges = 0, non_manifold_edges = 0, inconsistent_edges = 0;
  std::size_t components = 0, holes = 0, self_intersections = 0;
  double volume = 0.0;  ///< m3, after repair; 0 for an open surface
  double area = 0.0;    ///< m2
  Box box;
  std::vector<std::string> done;  ///< repairs, in words
  std::string refusal;            ///< why, and where; empty unless refused
};

/// Limits of what counts as repair and not as a guess.
struct RepairLimits {
  double hole_share = 0.25;      ///< widest hole closed, as a share of the largest extent
  std::size_t hole_edges = 500;  ///< most edges of a hole closed
};

/// Judges `mesh` and repairs it in place as far as is sure. A refused mesh is left as it came.
MeshReport check_and_repair(TriangleMesh& mesh, MeshPurpose purpose, const RepairLimits& limits = {});

/// Makes a mesh a closed outward solid or throws Error(input): "PATH: ...". Repairs are added to `done`.
void require_solid(TriangleMesh& mesh, const std::string& path, std::vector<std::string>& done);

}  // namespace gdesp::geometry
