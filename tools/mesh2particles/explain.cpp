// SPDX-License-Identifier: GPL-3.0-or-later
// --explain: what would be built, and what running it would take, by the estimate of gdesp-run itself.
#include <iostream>

#include "case_estimate.hpp"
#include "geometry/case_builder.hpp"
#include "options.hpp"

namespace gdesp::tool {
namespace {

/// Bytes on disk, as written: arrays of 32-bit numbers in base64.
double case_bytes(const Case& c) {
  const auto n = [](const auto& list) { return static_cast<double>(list.size()); };
  return 4.0 / 3.0 *
         (24.0 * n(c.fluid.position) + 44.0 * n(c.boundary.position) + 48.0 * n(c.grains.position) +
          28.0 * n(c.walls.triangle));
}

void print_counts(const Case& c) {
  const Vec3d size = c.domain.upper - c.domain.lower;
  std::cout << (c.scene.title.empty() ? c.scene.path : c.scene.title) << "\nfluid particles   "
            << c.fluid.position.size() << "\nwall particles    " << c.boundary.position.size() << "\ngrains            "
            << c.grains.position.size() << "\nwall triangles    " << c.walls.triangle.size() << "\nbodies            "
            << c.bodies.size() << "\ndomain            " << number_text(size.x, 6) << " x " << number_text(size.y, 6)
            << " x " << number_text(size.z, 6) << " m\ncase on disk      about " << memory_text(case_bytes(c)) << "\n";
}

}  // namespace

int explain(const MeshOptions& o) {
  geometry::BuildReport report;
  Case built =
      geometry::build_case(read_scene(o.scene, o.overrides), report, {.scope = geometry::BuildScope::counts_only});
  print_counts(built);
  for (const auto& note : report.notes.done) std::cout << "note: " << note << "\n";
  for (const auto& warning : report.notes.warnings) std::cout << "warning: " << warning << "\n";
  if (!built.fluid.position.empty() || !built.grains.position.empty()) {
    std::cout << "\nif run (gdesp-run):\n";
    for (const auto& line : estimate_here(built).lines) std::cout << line << "\n";
  }
  std::cout << std::flush;
  return 0;
}

}  // namespace gdesp::tool
