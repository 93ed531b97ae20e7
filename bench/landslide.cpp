// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's landslide at its size (386,468 grains and 698,699 particles of water and walls, 7 s), made without files
// from the reconstruction of its flume: 4 m long, slope of 45 degrees, water 1.6 m deep, width 0.6 m, a prism of grains of
// 0.9 m x 0.9 m / 2 above the water. Some steps are timed, from the fall of the grains into the water on, and the whole is
// projected from them; --run runs it. The case for results is data/cases/landslide-granular; this is for speed.
// usage: bench_landslide [--device cpu|cuda|cuda:N] [--threads N] [--scale S] [--steps N] [--youngs-modulus E] [--warm-up T] [--run]
//   --scale S: S times the particles (spacing and diameter by the cube root)
//   --youngs-modulus E: Pa, of grains; 2e8 in the paper
//   --warm-up T: s, simulated before steps are timed (0.05: the grains are out of their lattice, at the water)
// cpu_ms_per_step is processor time of all threads: on a shared machine it says more than the time that passes.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>

#include "bench.hpp"
#include "core/error.hpp"
#include "exec/array.hpp"
#include "exec/backend.hpp"
#include "simulation/simulation.hpp"

namespace gdesp {
namespace {

constexpr double length = 4.0, depth = 1.6, width = 0.6, slide_side = 0.9, toe = 2.0;  // m; the slope is z = x - toe
constexpr double paper_seconds = 2.52 * 3600.0, paper_end = 7.0;
constexpr double roof = 2.8;  // m, of the domain

struct Options {
  std::string device = "cpu";
  int threads = 0, steps = 100;
  double scale = 1.0, youngs_modulus = 2.0e8, warm_up = 0.05;
  bool run = false;
};

double below_slope(double x, double z) { return (x - toe - z) / std::sqrt(2.0); }  // m, > 0 in the slope

void fill(SimulationInput& input, double dp) {
  const int layers = 3, across = static_cast<int>(std::lround(width / dp));
  const auto cells = [&](double extent) { return static_cast<int>(std::ceil(extent / dp)); };
  for (int i = -layers; i < cells(length + 1.0); ++i)
    for (int j = -layers; j < across + layers; ++j)
      for (int k = -layers; k < cells(2.0); ++k) {
        const Vec3d r{(i + 0.5) * dp, (j + 0.5) * dp, (k + 0.5) * dp};
        const double inside = below_slope(r.x, r.z);
        if (inside > layers * dp) continue;
        const bool wall = i < 0 || j < 0 || j >= across || k < 0 || inside > -0.25 * dp;
        if (wall)
          input.boundary.position.push_back(r);
        else if (r.z < depth)
          input.fluid.position.push_back(r);
      }
}

// A face-centred lattice stretched to a porosity of 0.4, inside the prism.
void drop(GrainTable& grains, double d) {
  const double cell = 1.0725 * std::sqrt(2.0) * d, foot = depth + 0.02;
  const Vec3d corner[4] = {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}};
  const int n = static_cast<int>(std::ceil(slide_side / cell)), across = static_cast<int>(width / cell);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < across; ++j)
      for (int k = 0; k <= n; ++k)
        for (const Vec3d& c : corner) {
          const Vec3d r{toe + foot + d + (i + c.x) * cell, 0.6 * d + (j + c.y) * cell, foot + (k + c.z) * cell};
          if (below_slope(r.x, r.z) > -0.51 * d || r.z > foot + slide_side) continue;
          grains.position.push_back(r);
          grains.diameter.push_back(static_cast<float>(d));
          grains.density.push_back(2650.0f);
        }
}

void rectangle(TriangleTable& table, const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& e) {
  const auto base = static_cast<std::int32_t>(table.vertex.size());
  table.vertex.insert(table.vertex.end(), {a, b, c, e});
  table.triangle.push_back({base, base + 1, base + 2});
  table.triangle.push_back({base, base + 2, base + 3});
  table.body.insert(table.body.end(), 2, 0);
}

SimulationInput landslide(double scale, double youngs_modulus) {
  const double dp = 0.01818 / std::cbrt(scale), d = 0.00909 / std::cbrt(scale);
  SimulationInput input;
  const double margin = std::max(0.1, 4.0 * dp);
  input.lower = {-margin, -margin, -margin};
  input.upper = {length + 1.0 + margin, width + margin, roof + margin};
  auto& p = input.fluid_parameters;
  p.dp = dp;
  p.h = 1.3 * dp;
  p.sound_speed = 10.0 * std::sqrt(2.0 * 9.81 * depth);
  p.kinematic_viscosity = 1.0e-6;
  p.artificial_viscosity = 0.05;
  p.level = depth;
  fill(input, dp);
  drop(input.grains, d);
  const double far = length + 0.8, top = far - toe;
  rectangle(input.walls, {0, 0, 0}, {toe, 0, 0}, {toe, width, 0}, {0, width, 0});
  rectangle(input.walls, {toe, 0, 0}, {far, 0, top}, {far, width, top}, {toe, width, 0});
  rectangle(input.walls, {0, 0, 0}, {0, width, 0}, {0, width, roof}, {0, 0, roof});
  rectangle(input.walls, {0, 0, 0}, {0, 0, roof}, {far, 0, roof}, {far, 0, 0});
  rectangle(input.walls, {0, width, 0}, {far, width, 0}, {far, width, roof}, {0, width, roof});
  input.contact.youngs_modulus = youngs_modulus;
  input.contact.poisson_ratio = 0.3;
  input.contact.friction = 0.364;
  return input;
}

int run(const Options& options) {
  const int threads = exec::set_threads(options.threads);
  const auto simulation = make_simulation(landslide(options.scale, options.youngs_modulus), options.device);
  if (!options.run) simulation->advance_to(options.warm_up);
  const Diagnostics before = simulation->diagnostics();
  bench::start_profile();
  const std::clock_t processor = std::clock();
  const auto start = std::chrono::steady_clock::now();
  if (options.run)
    simulation->advance_to(paper_end);
  else
    for (int k = 0; k < options.steps; ++k) simulation->step(1.0e3);
  const Diagnostics after = simulation->diagnostics();
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double cpu = static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC;
  bench::print_profile();
  const double simulated = after.time - before.time, steps = static_cast<double>(after.step - before.step);
  const double substeps = static_cast<double>(after.grain_substeps - before.grain_substeps);
  const double sph = static_cast<double>(after.fluid_particles + after.wall_particles),
               grains = static_cast<double>(after.grains);
  const double seven = wall * paper_end / simulated;
  std::printf(
      "{\"bench\":\"landslide\",\"device\":\"%s\",\"threads\":%d,\"grains\":%.0f,\"water\":%ld,\"walls\":%ld,\"steps\":"
      "%.0f,"
      "\"substeps_per_step\":%.1f,\"dt\":%.3g,\"ms_per_step\":%.4g,\"cpu_ms_per_step\":%.4g,\"sph_particle_steps_per_"
      "s\":%.4g,\"grain_substeps_per_s\":%.4g,"
      "\"memory_bytes\":%zu,\"seconds_for_7s\":%.4g,\"projected\":%s,\"score\":%.4g,\"times_the_paper\":%.4g}\n",
      options.device.c_str(), threads, grains, static_cast<long>(after.fluid_particles),
      static_cast<long>(after.wall_particles), steps, substeps / steps, simulated / steps, 1e3 * wall / steps,
      1e3 * cpu / steps, sph * steps / wall, grains * substeps / wall, exec::peak_allocated_bytes(), seven,
      options.run ? "false" : "true", (sph + grains) * paper_end / seven, paper_seconds / seven);
  return 0;
}

}  // namespace
}  // namespace gdesp

int main(int argc, char** argv) {
  gdesp::Options options;
  for (int k = 1; k < argc; ++k) {
    const auto is = [&](const char* name) { return std::strcmp(argv[k], name) == 0 && (k + 1 < argc); };
    if (std::strcmp(argv[k], "--run") == 0)
      options.run = true;
    else if (is("--device"))
      options.device = argv[++k];
    else if (is("--threads"))
      options.threads = std::atoi(argv[++k]);
    else if (is("--scale"))
      options.scale = std::atof(argv[++k]);
    else if (is("--youngs-modulus"))
      options.youngs_modulus = std::atof(argv[++k]);
    else if (is("--warm-up"))
      options.warm_up = std::atof(argv[++k]);
    else if (is("--steps"))
      options.steps = std::atoi(argv[++k]);
    else {
      std::fprintf(stderr,
                   "usage: bench_landslide [--device cpu|cuda|cuda:N] [--threads N] [--scale S] [--steps N] "
                   "[--youngs-modulus E] [--warm-up T] [--run]\n");
      return 2;
    }
  }
  try {
    return gdesp::run(options);
  } catch (const gdesp::Error& problem) {
    std::fprintf(stderr, "bench_landslide: %s\n", problem.what());
    return 1;
  }
}
