// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>

#include "analysis/frame_source.hpp"
#include "analysis/run_record.hpp"
#include "analysis/table.hpp"
#include "checkpoint_files.hpp"
#include "cli/cli.hpp"
#include "core/error.hpp"
#include "geometry/body_builder.hpp"
#include "geometry/file_check.hpp"
#include "geometry/mesh_reader.hpp"
#include "geometry/raster_reader.hpp"
#include "geometry/terrain_loader.hpp"
#include "io/case.hpp"
#include "io/frame.hpp"
#include "options.hpp"
#include "scene/scene.hpp"
#include "seeds.hpp"
#include "support/tank.hpp"
#include "target.hpp"

namespace gdesp::fuzz {
namespace {

namespace fs = std::filesystem;

/// What a reader made of the bytes must be finite and sound as far as its header promises.
void expect(bool sound, const char* what) {
  if (!sound) throw std::logic_error(std::string("accepted although ") + what);
}

void read_scene_file(const std::string&, const std::string& path) {
  const Scene scene = read_scene(path, {});
  expect(scene.dp > 0.0, "dp is not positive");
  const std::string again = fs::path(path).parent_path().string() + "/again.toml", text = scene_to_toml(scene);
  std::ofstream(again) << text;
  expect(scene_to_toml(read_scene(again, {})) == text, "the scene written back reads differently");
}

void read_override(const std::string& bytes, const std::string& path) {
  const std::string scene = fs::path(path).parent_path().string() + "/scene.toml";
  if (!fs::exists(scene)) std::ofstream(scene) << small_scene();
  read_scene(scene, {cli::parse_override(bytes)});
}

void read_raster_file(const std::string&, const std::string& path) {
  const geometry::Raster r = geometry::read_raster(path, {});
  expect(r.field.z.size() == static_cast<std::size_t>(r.field.nx) * r.field.ny && r.field.dx > 0.0 && r.field.dy > 0.0,
         "the raster has no sound grid");
}

void read_point_file(const std::string&, const std::string& path) {
  geometry::triangulate_points(geometry::read_points(path, {}));
}

void read_mesh_file(const std::string&, const std::string& path) {
  geometry::MeshOptions options;
  options.mesh_size = 0.7;
  geometry::TriangleMesh mesh = geometry::read_mesh(path, options);
  for (const auto& t : mesh.triangle) {
    for (int c = 0; c < 3; ++c)
      expect(t[c] >= 0 && static_cast<std::size_t>(t[c]) < mesh.vertex.size(),
             "a triangle names a vertex that is not there");
  }
  geometry::check_and_repair(mesh, geometry::MeshPurpose::any);
}

void read_frame_file(const std::string&, const std::string& path) {
  FrameMeta meta;
  const FluidTable fluid = read_fluid_frame(path, {}, &meta);
  expect(fluid.velocity.empty() || fluid.velocity.size() == fluid.position.size(),
         "a column has another length than the positions");
  read_grain_frame(path, {}, &meta);
}

void read_triangle_file(const std::string&, const std::string& path) {
  const TriangleTable t = read_triangles_vtp(path);
  for (const auto& corner : t.triangle) {
    for (int c = 0; c < 3; ++c)
      expect(corner[c] >= 0 && static_cast<std::size_t>(corner[c]) < t.vertex.size(),
             "a triangle names a vertex that is not there");
  }
  read_body_states(path);
}

/// One file of a good case is replaced by the damaged one.
void read_case_folder(const std::string&, const std::string& path) {
  const fs::path folder = fs::path(path).parent_path(), damaged = folder / "damaged.case";
  fs::remove_all(damaged);
  fs::copy(folder / "good.case", damaged);
  fs::copy_file(path, damaged / fs::path(path).filename(), fs::copy_options::overwrite_existing);
  read_case(damaged.string());
}

/// The checksum is made to fit, or nothing behind it would ever be reached; every fourth keeps what it has.
void read_checkpoint(const std::string& bytes, const std::string& path) {
  const std::string run = fs::path(path).parent_path().string() + "/run";
  fs::create_directories(run + "/checkpoints");
  std::ofstream(run + "/checkpoints/step_000000000001.state", std::ios::binary)
      << (bytes.size() % 4 ? with_sound_trailer(bytes) : bytes);
  const std::unique_ptr<Simulation> simulation = make_simulation(small_tank(), "cpu");
  tool::CheckpointFiles(run, checkpoint_fingerprint).load_newest(*simulation);
}

/// Paths in the records are taken from the scratch folder, where the seeds' frames and case are.
void read_record_stream(const std::string& bytes, const std::string& path) {
  fs::current_path(fs::path(path).parent_path());
  struct Input {
    std::istringstream text;
    int line = 0;
  };
  const auto in =
      std::make_shared<Input>(std::istringstream(bytes));  // the source's own thread may still read when this returns
  analysis::SourceOptions options;
  options.inputs = {"-"};
  options.next_record = [in] { return cli::read_record(in->text, in->line); };
  analysis::FrameSource source(options);
  for (int k = 0; k < 10 && source.next(); ++k) {}
}

void read_run_files(const std::string&, const std::string& path) {
  const std::string folder = fs::path(path).parent_path().string();
  analysis::read_run_record(folder);
  analysis::read_run_log(folder);
}

void read_table_file(const std::string&, const std::string& path) {
  const analysis::Table table = analysis::read_table(path);
  for (const auto& row : table.row)
    expect(row.size() == table.column.size(), "a row has another length than the header");
  for (const auto& name : table.column) table.numbers(name);
}

void read_motion_file(const std::string&, const std::string& path) {
  const PrescribedMotion motion = geometry::read_motion(path);
  for (std::size_t k = 1; k < motion.time.size(); ++k)
    expect(motion.time[k] > motion.time[k - 1], "times do not increase");
}

/// Words split at blanks; what would only print (--help) is not asked for.
void read_command_line(const std::string& bytes, const std::string&) {
  std::istringstream in(bytes);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  if (words.empty()) return;
  const std::string program = words.front();
  words.erase(words.begin());
  for (const auto& w : words) {
    if (w.find("-h") != std::string::npos || w.find("-v") != std::string::npos) return;
  }
  cli::parse_override(words.empty() ? "" : words.back());
  tool::parse_options(words);
}

}  // namespace

const std::vector<Target>& targets() {
  static const std::vector<Target> all = {
      {"scene", true, read_scene_file, nullptr},           {"override", false, read_override, nullptr},
      {"command-line", false, read_command_line, nullptr}, {"records", false, read_record_stream, record_seeds},
      {"run-files", true, read_run_files, nullptr},        {"table", true, read_table_file, nullptr},
      {"motion", true, read_motion_file, nullptr},         {"points", true, read_point_file, nullptr},
      {"raster", true, read_raster_file, raster_seeds},    {"mesh", true, read_mesh_file, mesh_seeds},
      {"frame", true, read_frame_file, frame_seeds},       {"triangles", true, read_triangle_file, triangle_seeds},
      {"case", true, read_case_folder, case_seeds},        {"checkpoint", true, read_checkpoint, checkpoint_seeds},
  };
  return all;
}

}  // namespace gdesp::fuzz
