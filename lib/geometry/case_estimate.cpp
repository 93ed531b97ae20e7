// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/case_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/slide_builder.hpp"

namespace gdesp::geometry {
namespace {

constexpr double pi = 3.14159265358979323846;

double mean_grain_volume(const Slide& s, int dimensions) {
  const auto of = [&](double d) { return dimensions == 2 ? pi * d * d / 4.0 : pi * d * d * d / 6.0; };
  if (s.sieve.empty()) return of(s.diameter);
  double shares = 0.0, per_volume = 0.0;
  for (const auto& c : s.sieve) shares += c.mass_share, per_volume += c.mass_share / of(c.diameter);
  return shares / per_volume;
}

double smallest_diameter(const Slide& s) {
  double d = s.diameter - 3.0 * s.diameter_deviation;
  for (const auto& c : s.sieve) d = s.diameter > 0.0 ? std::min(d, c.diameter) : c.diameter;
  return d;
}

/// Rayleigh time (Hertz) or contact time (linear) of the smallest grain.
double grain_step(const Scene& scene) {
  double step = 1e300;
  for (const auto& s : scene.slides) {
    if (s.kind != "granular") continue;
    const double d = smallest_diameter(s), nu = scene.contact.poisson_ratio;
    if (scene.contact.law == "linear") {
      const double mass = s.density * pi * d * d * d / 6.0;
      step = std::min(step, pi * std::sqrt(0.5 * mass / scene.contact.stiffness));
    } else {
      const double shear = scene.contact.youngs_modulus / (2.0 * (1.0 + nu));
      step = std::min(step, pi * 0.5 * d / (0.1631 * nu + 0.8766) * std::sqrt(s.density / shear));
    }
  }
  return step < 1e300 ? step * scene.numerics.grain_time_step_share : 0.0;
}

void estimate_time(CaseEstimate& e, const Scene& scene, const Case& built) {
  const double g = norm(scene.gravity);
  double top = built.still_water_level, bottom = 1e300;
  for (const auto& p : built.fluid.position) bottom = std::min(bottom, p.z);
  for (const auto& p : built.grains.position) top = std::max(top, p.z), bottom = std::min(bottom, p.z);
  for (const auto& v : built.walls.vertex) {
    if (built.fluid.position.empty()) bottom = std::min(bottom, v.z);
  }
  e.largest_speed = scene.numerics.expected_speed > 0.0 ? scene.numerics.expected_speed : std::sqrt(2.0 * g * std::max(top - bottom, scene.dp));
  e.sound_speed = scene.numerics.sound_speed > 0.0 ? scene.numerics.sound_speed : 10.0 * e.largest_speed;
  const double h = scene.numerics.smoothing_ratio * scene.dp;
  const double cfl = scene.numerics.cfl > 0.0 ? scene.numerics.cfl : 0.25;
  e.fluid_step = scene.numerics.time_step > 0.0 ? scene.numerics.time_step : cfl * h / (e.sound_speed + e.largest_speed);
  e.grain_step = grain_step(scene);
  if (e.fluid == 0 && e.grain_step > 0.0) e.fluid_step = e.grain_step;
  e.fluid_steps = scene.time.end / e.fluid_step;
  const double sub_steps = e.grain_step > 0.0 ? std::max(1.0, e.fluid_step / e.grain_step) : 0.0;
  e.particle_steps = e.fluid_steps * (static_cast<double>(e.fluid) + 0.3 * static_cast<double>(e.boundary) + sub_steps * static_cast<double>(e.grains));
}

void name_models(CaseEstimate& e, const Scene& scene) {
  e.models.push_back(e.fluid ? "fluid: on, preset " + scene.numerics.preset : "fluid: off (the scene has none)");
  e.models.push_back(e.grains ? "grains: on, contact law " + scene.contact.law : "grains: off (no granular slide)");
  const bool coupled = e.fluid && e.grains && scene.coupling.enabled;
  e.models.push_back(coupled ? "coupling: on, drag " + scene.coupling.drag : "coupling: off");
  if (scene.dimensions == 2) e.models.push_back("two dimensions: the plane y = 0");
}

}  // namespace

CaseEstimate estimate_case(const Scene& scene) {
  CaseEstimate e;
  BuildReport report;
  const Case built = build_case(scene, report, {}, {}, BuildScope::counts_only);
  e.notes = report.notes;
  e.fluid = built.fluid.position.size();
  e.boundary = built.boundary.position.size();
  e.triangles = built.walls.triangle.size();
  e.bodies = built.bodies.size();
  for (std::size_t k = 0; k < report.slides.size(); ++k) {
    const Slide& s = scene.slides[k];
    if (s.kind == "granular") e.grains += static_cast<std::size_t>(report.slides[k].volume * (1.0 - s.porosity) / mean_grain_volume(s, scene.dimensions));
  }
  e.size = extent(built.domain);
  e.disk_bytes = 4.0 / 3.0 * (24.0 * static_cast<double>(e.fluid) + 44.0 * static_cast<double>(e.boundary) + 48.0 * static_cast<double>(e.grains) + 28.0 * static_cast<double>(e.triangles));
  e.memory_bytes = 450.0 * static_cast<double>(e.fluid + e.boundary) + 900.0 * static_cast<double>(e.grains) + 200.0 * static_cast<double>(e.triangles);
  estimate_time(e, scene, built);
  name_models(e, scene);
  return e;
}

}  // namespace gdesp::geometry
