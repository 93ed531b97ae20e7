// SPDX-License-Identifier: GPL-3.0-or-later
// The free surface as triangles and as a sparse signed distance field (OpenVDB).
//
// Construction (closed_union.hpp): each particle is a ball of radius 1.3 dp; the signed distance to their union,
// smoothed by one mean over 27 voxels, is moved inwards by 0.72 dp. That joins neighbours up to 2.6 dp apart, keeps
// sheets one particle thick, and puts the surface of still water where the measured free surface lies, half a spacing above its
// uppermost particles (tested: within 0.1 dp; 1.3 - 0.5 dp less what the union's dimples and the mean take away).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/vec3.hpp"
#include "particles/particle_tables.hpp"

namespace gdesp::analysis {

struct SurfaceOptions {
  double dp = 0.0;     ///< m
  double voxel = 0.0;  ///< m; 0: dp / 2
};

struct SurfaceMesh {
  std::vector<Vec3d> vertex;                 ///< m, case coordinates
  std::vector<Vec3<std::int32_t>> triangle;  ///< outward by the right-hand rule
  std::vector<Vec3f> velocity;               ///< m/s, at the vertices; empty without velocities
};

/// Triangles of the surface of the fluid; with velocities, each vertex takes the weighted mean of the particles
/// near it. Throws Error(resource) when the field does not fit into memory.
SurfaceMesh extract_surface(std::span<const Vec3d> position, std::span<const Vec3f> velocity,
                            const SurfaceOptions& options);

/// Writes the level set (grid "surface", metres; transform in scene coordinates: `offset` added) as .vdb.
void write_surface_vdb(std::span<const Vec3d> position, const SurfaceOptions& options, const Vec3d& offset, double time,
                       const std::string& path);

/// Writes the triangles as .vtp (inline binary, every ParaView reads it), case coordinates, with time and offset as field data.
void write_surface_vtp(const SurfaceMesh& mesh, const Vec3d& offset, double time, const std::string& path);

/// Volume enclosed by a closed surface of triangles, m3 (divergence theorem).
double enclosed_volume(const SurfaceMesh& mesh);

}  // namespace gdesp::analysis
