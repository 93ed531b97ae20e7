// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "analysis/surface_mesh.hpp"
#include "command.hpp"
#include "core/error.hpp"
#include "options.hpp"

namespace gdesp::tool {
namespace {

/// Writes one surface per frame; the table names the files.
class SurfaceExport : public analysis::Measurement {
 public:
  SurfaceExport(std::string folder, bool vdb, double voxel, bool splash)
      : folder_(std::move(folder)), vdb_(vdb), voxel_(voxel), splash_(splash) {}

  std::vector<std::string> begin(const analysis::RunInfo& info) override {
    info_ = info;
    info_.walls = {};
    if (info.dimensions == 2)
      throw Error(ErrorKind::input, info.name + ": a surface needs a run in three dimensions; see profile");
    std::filesystem::create_directories(folder_);
    return {"t[s]", "file", "triangles", "volume[m3]"};
  }

  void add(analysis::FrameView& view, const analysis::RowSink& emit) override {
    std::vector<Vec3d> position;
    std::vector<Vec3f> velocity;
    choose(view, position, velocity);
    const analysis::SurfaceOptions options{info_.dp, voxel_};
    char name[64];
    std::snprintf(name, sizeof name, "/surface_%05zu.", count_++);
    const std::string stem = folder_ + name;
    const analysis::SurfaceMesh mesh = analysis::extract_surface(position, velocity, options);
    analysis::write_surface_vtp(mesh, info_.offset, view.time(), stem + "vtp");
    if (vdb_) analysis::write_surface_vdb(position, options, info_.offset, view.time(), stem + "vdb");
    time_.push_back(view.time());
    volume_.push_back(analysis::enclosed_volume(mesh));
    emit({view.time(), stem + "vtp", static_cast<double>(mesh.triangle.size()), volume_.back()});
  }

  analysis::Figure figure() const override {
    analysis::Panel panel;
    panel.title = "Volume inside the surface, " + analysis::plain_text(info_.name);
    panel.x_label = "time t (s)";
    panel.y_label = "volume (m^3)";
    panel.series.push_back({"", time_, volume_, {}, {}, analysis::MarkStyle::line, {}, 0});
    analysis::Figure figure;
    figure.panel.push_back(std::move(panel));
    return figure;
  }

 private:
  void choose(analysis::FrameView& view, std::vector<Vec3d>& position, std::vector<Vec3f>& velocity) const {
    const FluidTable& fluid = view.frame().fluid;
    if (splash_ || fluid.position.empty()) {
      position = fluid.position;
      velocity = fluid.velocity;
      return;
    }
    const auto& main = view.connected().main;
    for (std::size_t k = 0; k < main.size(); ++k) {
      if (!main[k]) continue;
      position.push_back(fluid.position[k]);
      if (k < fluid.velocity.size()) velocity.push_back(fluid.velocity[k]);
    }
  }

  std::string folder_;
  bool vdb_;
  double voxel_;
  bool splash_;
  analysis::RunInfo info_;
  std::size_t count_ = 0;
  std::vector<double> time_, volume_;
};

}  // namespace

int run_surface(const std::vector<std::string>& arguments) {
  po::options_description own("Surface");
  own.add_options()("output,o", po::value<std::string>()->value_name("FOLDER"),
                    "where surface_00000.vtp ... go (made if missing)");
  own.add_options()("vdb", "also the level set as surface_00000.vdb (OpenVDB, scene coordinates)");
  own.add_options()("voxel", po::value<double>()->value_name("M")->default_value(0.0, "dp/2"), "of the level set");
  own.add_options()("connected", "the connected water only, without splash");
  CommandLine line("surface", own);
  const char* definition =
      "Free surface as triangles with velocity and speed at the vertices. Every particle is a ball of radius 1.3 dp; "
      "the signed\n"
      "distance to their union, smoothed over 27 voxels, is moved inwards by 0.72 dp: a closing (J. Serra 1982, Image "
      "Analysis\n"
      "and Mathematical Morphology, Academic Press), which joins what is up to 2.6 dp apart and puts still water's "
      "surface\n"
      "where profile reads it, within 0.1 dp. Sparse level set and triangles: OpenVDB (K. Museth 2013, ACM Trans. "
      "Graph. 32,\n"
      "27, doi 10.1145/2487228.2487235). VTP coordinates are the case's (offset as field data), VDB the scene's.\n";
  if (!line.parse(arguments, definition, "surge-analyze surface lake.run -o lake.surface --every 5 --vdb")) return 0;
  if (!line.has("output")) throw Error(ErrorKind::usage, "surface: -o FOLDER is needed");
  SurfaceExport measurement(line.get<std::string>("output"), line.has("vdb"), line.get<double>("voxel"),
                            !line.has("connected"));
  return run_measurement(line, measurement);
}

}  // namespace gdesp::tool
