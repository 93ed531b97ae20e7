// SPDX-License-Identifier: GPL-3.0-or-later
// The ingredients of a scene as surfaces: terrain, walls, bodies, slides. Read in the scene's own coordinates, then
// shifted into the case's, all in double precision.
#pragma once

#include <string>
#include <vector>

#include "geometry/triangle_mesh.hpp"
#include "scene/scene.hpp"

namespace gdesp::geometry {

/// What was found and done, for people; no order but that of events.
struct Notes {
  std::vector<std::string> done;  ///< "slide.stl: 3 holes closed (largest 0.4 m)"
  std::vector<std::string> warnings;
};

/// A closed solid with outward normals, or (box set) an axis-aligned box.
struct SolidPart {
  std::string name;
  TriangleMesh mesh;
  std::optional<Box> box;
  bool no_slip = false;
};

/// Names of a tank's faces: of axis a the lower is number 2 a, the upper 2 a + 1.
inline constexpr const char* tank_face[6] = {"x-", "x+", "y-", "y+", "bottom", "top"};

/// A wall at rest: a tank (inner box, open faces), a closed solid, or a sheet that is solid below.
struct WallPart {
  std::string name;
  enum class Kind { tank, solid, sheet } kind = Kind::solid;
  Box tank;
  std::vector<std::string> open, symmetry;
  TriangleMesh mesh;
  bool no_slip = false;
};

/// Everything the scene is made of. Indices of bodies follow the scene's lists.
struct SceneParts {
  TriangleMesh terrain;          ///< sheet, normals up; empty without terrain
  double terrain_spacing = 0.0;  ///< m, mean edge of its triangles seen from above
  std::string terrain_crs;       ///< WKT, empty when unknown
  bool terrain_no_slip = false;
  std::vector<WallPart> walls;
  std::vector<SolidPart> moving, slides, floating;
  std::vector<SolidPart> fluid;    ///< closed meshes to be filled, by fill (empty mesh for other kinds)
  std::vector<std::string> files;  ///< every file that was read
};

/// Reads and checks every file of the scene, carves the terrain where a slide is part of it, builds the shapes.
SceneParts load_parts(const Scene& scene, Notes& notes);

/// Bounds of everything that has a surface.
Box bounds(const SceneParts& parts);
/// Subtracts `offset` from all coordinates.
void shift(SceneParts& parts, const Vec3d& offset);
/// The scene's own coordinates (boxes, polygons, seeds, levels) minus `offset`; what is only measured (gauges, sections, regions) stays.
Scene shifted(const Scene& scene, const Vec3d& offset);

/// Whether (x, y) lies inside the polygon (even-odd).
bool inside_polygon(const std::vector<Point2>& polygon, double x, double y);

}  // namespace gdesp::geometry
