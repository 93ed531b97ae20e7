// SPDX-License-Identifier: GPL-3.0-or-later
// The surface as a VTK file.
#include "analysis/surface_mesh.hpp"
#include "io/vtp_writer.hpp"

namespace gdesp::analysis {

void write_surface_vtp(const SurfaceMesh& mesh, const Vec3d& offset, double time, const std::string& path) {
  const double place[3] = {offset.x, offset.y, offset.z};
  std::vector<float> speed;
  speed.reserve(mesh.velocity.size());
  for (const Vec3f& v : mesh.velocity) speed.push_back(norm(v));
  VtpContent content;
  content.position = &mesh.vertex;
  content.triangles = &mesh.triangle;
  content.field = {{"TimeValue", ScalarType::float64, 1, &time, 1}, {"offset", ScalarType::float64, 3, place, 1}};
  content.points = {vtp_array("velocity", mesh.velocity), vtp_array("speed", speed)};
  write_vtp(path, content);
}

}  // namespace gdesp::analysis
