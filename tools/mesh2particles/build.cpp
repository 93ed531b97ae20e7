// SPDX-License-Identifier: GPL-3.0-or-later
// Scene to case.
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>

#include "case_to_input.hpp"
#include "dem/settle_grains.hpp"
#include "geometry/case_builder.hpp"
#include "geometry/preview.hpp"
#include "io/case.hpp"
#include "options.hpp"

namespace gdesp::tool {
namespace {

namespace fs = std::filesystem;

/// A folder for files made before the case is; gone at the end.
class Workspace {
 public:
  explicit Workspace(const std::string& output)
      : folder_(fs::absolute(fs::path(output).lexically_normal()).parent_path()) {
    if (fs::path(output).filename().empty()) folder_ = folder_.parent_path();
    folder_ /= ".mesh2particles-" + std::to_string(::getpid());
    std::error_code failed;
    fs::create_directories(folder_, failed);
    if (failed)
      throw Error(ErrorKind::resource,
                  folder_.parent_path().string() + ": cannot be written to (" + failed.message() + ")");
  }
  ~Workspace() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
  std::string file(const char* name) const { return (folder_ / name).string(); }

 private:
  fs::path folder_;
};

std::string number(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", v);
  return text;
}

void tell(const Case& c, const geometry::BuildReport& report) {
  const char* unit = c.scene.dimensions == 2 ? " m2" : " m3";
  for (const auto& n : report.notes.done) cli::info(n);
  for (std::size_t k = 0; k < report.fills.size(); ++k) {
    const auto& f = report.fills[k];
    std::string text = "fluid.fill." + std::to_string(k) + " (" + f.kind + "): " + std::to_string(f.particles) +
                       " particles, " + number(f.volume) + unit + " (geometry: " + number(f.exact_volume) + unit;
    if (f.kind == "level")
      text += ", surface " + number(f.surface_area) + (c.scene.dimensions == 2 ? " m" : " m2") + ", deepest " +
              number(f.level - f.lowest_ground) + " m";
    cli::info(text + ")");
  }
  for (const auto& s : report.slides) {
    std::string text =
        "slide \"" + s.name + "\" (" + s.kind + "): " + number(s.volume) + unit + ", " + number(s.mass) + " kg";
    if (s.kind == "granular") {
      text += ", " + std::to_string(s.grains) + " grains, porosity " + number(s.porosity) + ", largest overlap " +
              number(100.0 * s.largest_overlap) + " % of a diameter, packed in " + number(s.seconds) + " s";
      if (s.settled) {
        text += "; settled under gravity for " + number(s.settled->settlement.time) + " s: fell by " +
                number(s.settled->fall) + " m (mean), porosity of the bed " + number(s.settled->porosity);
      }
    }
    cli::info(text);
  }
  cli::info("walls: " + std::to_string(c.boundary.position.size()) + " particles, " +
            std::to_string(c.walls.triangle.size()) + " triangles; bodies: " + std::to_string(c.bodies.size()) +
            "; boundary grid: " + std::to_string(report.band_voxels) + " voxels");
  if (norm(c.offset) > 0.0) {
    char text[120];
    std::snprintf(text, sizeof text, "coordinates re-centred: scene = case + (%.10g, %.10g, %.10g) m", c.offset.x,
                  c.offset.y, c.offset.z);
    cli::info(text);
  }
  for (const auto& [stage, seconds] : report.seconds) cli::detail(stage + ": " + number(seconds) + " s");
  for (const auto& w : report.notes.warnings) cli::warning(w);
}

nlohmann::ordered_json record_of(const std::string& path, const Case& c, const geometry::BuildReport& report,
                                 double seconds) {
  nlohmann::ordered_json r;
  r["record"] = "case";
  r["path"] = path;
  r["title"] = c.scene.title;
  r["dimensions"] = c.scene.dimensions;
  r["dp"] = c.scene.dp;
  r["fluid"] = c.fluid.position.size();
  r["boundary"] = c.boundary.position.size();
  r["grains"] = c.grains.position.size();
  r["triangles"] = c.walls.triangle.size();
  r["bodies"] = c.bodies.size();
  double water = 0.0;
  for (const auto& f : report.fills) water += f.volume;
  r["water_volume"] = water;
  r["fills"] = nlohmann::ordered_json::array();
  for (const auto& f : report.fills) {
    r["fills"].push_back({{"kind", f.kind},
                          {"particles", f.particles},
                          {"volume", f.volume},
                          {"exact_volume", f.exact_volume},
                          {"surface_area", f.surface_area},
                          {"level", f.level + c.offset.z}});
  }
  r["slides"] = nlohmann::ordered_json::array();
  for (const auto& s : report.slides) {
    r["slides"].push_back({{"name", s.name},
                           {"kind", s.kind},
                           {"volume", s.volume},
                           {"mass", s.mass},
                           {"grains", s.grains},
                           {"porosity", s.porosity},
                           {"largest_overlap", s.largest_overlap}});
    if (s.settled)
      r["slides"].back().update({{"settling_time", s.settled->settlement.time},
                                 {"fall", s.settled->fall},
                                 {"bed_porosity", s.settled->porosity}});
  }
  r["offset"] = {c.offset.x, c.offset.y, c.offset.z};
  r["warnings"] = report.notes.warnings.size();
  r["seconds"] = seconds;
  return r;
}

/// An output that stands in the way is found before the work is done.
void check_output(const MeshOptions& o) {
  if (fs::exists(o.output) && !o.force)
    throw Error(ErrorKind::usage, o.output + ": exists already; --force replaces it");
}

/// Builds; where that fails, what was warned of before is said with it.
Case build_or_warn(const Scene& scene, geometry::BuildReport& report, const geometry::BuildOptions& how) {
  try {
    return geometry::build_case(scene, report, how);
  } catch (...) {
    for (const auto& w : report.notes.warnings) cli::warning(w);
    throw;
  }
}

}  // namespace

int build(const MeshOptions& o) {
  const auto start = std::chrono::steady_clock::now();
  const Scene scene = read_scene(o.scene, o.overrides);
  check_output(o);
  const Workspace workspace(o.output);
  const std::string vdb = workspace.file("boundary.vdb");
  geometry::BuildReport report;
  geometry::BuildOptions how;
  how.vdb_path = vdb;
  how.on_stage = [](const std::string& stage) { cli::detail(stage + " ..."); };
  how.settler = [&scene](GrainTable& grains, const TriangleTable& walls) {
    SimulationInput bed;
    bed.grains = grains;
    bed.contact = contact_parameters(scene.contact);
    bed.fluid_parameters.gravity = scene.gravity;
    bed.fluid_parameters.dimensions = scene.dimensions;
    choose_youngs_modulus(bed, 0.0);
    return dem::settle_grains(grains, walls, {bed.contact, scene.gravity, scene.dimensions});
  };
  const Case built = build_or_warn(scene, report, how);
  if (!o.preview.empty()) geometry::write_preview(built, o.preview);
  write_case(o.output, built, o.force, {vdb});
  tell(built, report);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string path = fs::canonical(o.output).string();
  cli::info("case " + path + " in " + number(seconds) + " s");
  cli::write_record(record_of(path, built, report, seconds));
  return 0;
}

}  // namespace gdesp::tool
