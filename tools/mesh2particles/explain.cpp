// SPDX-License-Identifier: GPL-3.0-or-later
// --explain: what would be built, and what running it would take.
#include <cmath>
#include <cstdio>
#include <iostream>

#include "geometry/case_estimate.hpp"
#include "options.hpp"

namespace gdesp::tool {
namespace {

std::string text_of(const char* format, double value) {
  char text[80];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

void print_text(const geometry::CaseEstimate& e, const Scene& scene) {
  std::cout << (scene.title.empty() ? scene.path : scene.title) << "\n";
  std::cout << "  fluid particles     " << e.fluid << "\n  wall particles      " << e.boundary << "\n  grains              " << e.grains
            << "\n  wall triangles      " << e.triangles << "\n  bodies              " << e.bodies << "\n";
  std::cout << "  domain              " << text_of("%.6g", e.size.x) << " x " << text_of("%.6g", e.size.y) << " x " << text_of("%.6g", e.size.z) << " m\n";
  std::cout << "  case on disk        " << text_of("%.3g MB", e.disk_bytes / 1e6) << "\n  memory of a run     " << text_of("%.3g MB", e.memory_bytes / 1e6) << "\n";
  std::cout << "  speed of sound      " << text_of("%.4g m/s", e.sound_speed) << " (largest speed expected " << text_of("%.4g m/s)", e.largest_speed) << "\n";
  std::cout << "  fluid step          " << text_of("%.3g s", e.fluid_step) << "\n";
  if (e.grains > 0) std::cout << "  grain step          " << text_of("%.3g s", e.grain_step) << "\n";
  std::cout << "  fluid steps to " << text_of("%.4g s", scene.time.end) << "  " << text_of("%.3g", e.fluid_steps) << "\n";
  std::cout << "  cost                " << text_of("%.3g", e.particle_steps) << " particle steps; at 4e6 a second (two cores) " << text_of("%.3g s", e.particle_steps / 4e6) << "\n";
  for (const auto& line : e.models) std::cout << "  " << line << "\n";
  for (const auto& note : e.notes.done) std::cout << "  note: " << note << "\n";
  for (const auto& warning : e.notes.warnings) std::cout << "  warning: " << warning << "\n";
}

}  // namespace

int explain(const MeshOptions& o) {
  const Scene scene = read_scene(o.scene, o.overrides);
  print_text(geometry::estimate_case(scene), scene);
  std::cout << std::flush;
  return 0;
}

}  // namespace gdesp::tool
