// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "io/case.hpp"
#include "io/case_toml.hpp"
#include "io/safe_file.hpp"
#include "io/tables.hpp"
#include "scene/scene_source.hpp"

namespace gdesp {
namespace {

namespace fs = std::filesystem;

/// A folder that is made aside and takes its name when everything in it is complete.
class SafeFolder {
 public:
  SafeFolder(fs::path path, bool force) : path_(std::move(path)) {
    while (!path_.has_filename() && path_.has_parent_path() && path_ != path_.root_path()) path_ = path_.parent_path();
    if (fs::exists(path_)) check_replaceable(force);
    aside_ = path_;
    aside_ += ".part-" + std::to_string(::getpid());
    fs::remove_all(aside_);
    if (path_.has_parent_path()) fs::create_directories(path_.parent_path());
    fs::create_directory(aside_);
  }
  ~SafeFolder() {
    std::error_code ignored;
    if (!aside_.empty()) fs::remove_all(aside_, ignored);
  }
  std::string in(const std::string& name) const { return (aside_ / name).string(); }

  void commit() {
    fs::path old;
    if (fs::exists(path_)) {
      old = path_;
      old += ".old-" + std::to_string(::getpid());
      fs::rename(path_, old);
    }
    fs::rename(aside_, path_);
    aside_.clear();
    if (!old.empty()) fs::remove_all(old);
  }

 private:
  void check_replaceable(bool force) const {
    if (!force) throw Error(ErrorKind::usage, path_.string() + ": exists already; --force replaces it");
    if (!fs::is_directory(path_)) throw Error(ErrorKind::usage, path_.string() + ": is a file, expected a case folder");
    if (!fs::is_empty(path_) && !fs::exists(path_ / "case.toml"))
      throw Error(ErrorKind::usage, path_.string() + ": is a folder but no case (it has no case.toml): not replaced");
  }
  fs::path path_, aside_;
};

/// The triangles of moving bodies alone, for people's eyes.
TriangleTable body_triangles(const TriangleTable& walls) {
  TriangleTable out;
  std::vector<std::int32_t> number(walls.vertex.size(), -1);
  for (std::size_t i = 0; i < walls.triangle.size(); ++i) {
    if (i >= walls.body.size() || walls.body[i] <= 0) continue;
    Vec3<std::int32_t> corners = walls.triangle[i];
    for (const int k : {0, 1, 2}) {
      std::int32_t& renamed = number[std::size_t(corners[k])];
      if (renamed < 0) {
        renamed = std::int32_t(out.vertex.size());
        out.vertex.push_back(walls.vertex[std::size_t(corners[k])]);
      }
      corners[k] = renamed;
    }
    out.triangle.push_back(corners);
    out.body.push_back(walls.body[i]);
  }
  return out;
}

void move_file(const std::string& from, const std::string& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (!error) return;
  fs::copy_file(from, to);
  fs::remove(from);
}

void write_parts(const SafeFolder& folder, const Case& c, const std::vector<std::string>& extra_files) {
  const double offset[3] = {c.offset.x, c.offset.y, c.offset.z};
  const std::vector<VtpArray> field{{"offset", ScalarType::float64, 3, offset, 1},
                                    {"dp", ScalarType::float64, 1, &c.scene.dp, 1}};
  std::vector<std::string> files;
  const auto part = [&](const char* name, std::size_t count, auto write) {
    if (count == 0) return;
    files.emplace_back(name);
    write(folder.in(name));
  };
  part("fluid.vtp", c.fluid.position.size(), [&](const std::string& p) { write_fluid(p, c.fluid, field); });
  part("boundary.vtp", c.boundary.position.size(), [&](const std::string& p) { write_boundary(p, c.boundary, field); });
  part("grains.vtp", c.grains.position.size(), [&](const std::string& p) { write_grains(p, c.grains, field); });
  part("walls.vtp", c.walls.triangle.size(), [&](const std::string& p) { write_triangles(p, c.walls, field); });
  const TriangleTable bodies = body_triangles(c.walls);
  part("bodies.vtp", bodies.triangle.size(), [&](const std::string& p) { write_triangles(p, bodies, field); });
  for (const std::string& extra : extra_files) {
    files.push_back(fs::path(extra).filename().string());
    move_file(extra, folder.in(files.back()));
  }
  write_text_file(folder.in("case.toml"), scene_to_toml(c.scene) + case_table(c, files));
}

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw Error(ErrorKind::input, path + ": " + what);
}

void check_count(const std::string& path, const char* what, std::size_t found, std::uint64_t stated) {
  if (found != stated)
    refuse(path, "holds " + std::to_string(found) + " " + what + ", case.toml says " + std::to_string(stated));
}

void check_finite(const std::string& path, const char* what, const float* values, std::size_t count,
                  std::size_t parts) {
  for (std::size_t i = 0; i < count * parts; ++i)
    if (!std::isfinite(values[i]))
      refuse(path, std::string(what) + " of point " + std::to_string(i / parts) + " is not finite");
}
void check_finite(const std::string& path, const char* what, const std::vector<float>& values) {
  check_finite(path, what, values.data(), values.size(), 1);
}
void check_finite(const std::string& path, const char* what, const std::vector<Vec3f>& values) {
  if (!values.empty()) check_finite(path, what, &values[0].x, values.size(), 3);
}

void check_bodies(const std::string& path, const std::vector<std::int32_t>& body, std::size_t bodies) {
  for (std::size_t i = 0; i < body.size(); ++i)
    if (body[i] < 0 || std::size_t(body[i]) > bodies)
      refuse(path, "item " + std::to_string(i) + " names body " + std::to_string(body[i]) + ", valid: 0 to " +
                       std::to_string(bodies));
}

void check_positive(const std::string& path, const char* what, const char* unit, const std::vector<float>& values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!(values[i] > 0.0f))
      refuse(path, std::string(what) + " of grain " + std::to_string(i) + " is " + std::to_string(values[i]) + " " +
                       unit + ", expected above 0");
}

/// Parts of a case are this project's own: neither VTK nor OpenVDB is needed to read them.
std::unique_ptr<PointSource> open_part(const std::string& path) {
  std::unique_ptr<PointSource> part = open_plain_vtp(path);
  if (!part) refuse(path, "is VTP of another kind than mesh2particles writes (inline binary, not compressed)");
  return part;
}

void read_fluid(const std::string& path, Case& c) {
  c.fluid = fluid_of(*open_part(path), path, {});
  check_finite(path, "velocity", c.fluid.velocity);
  check_finite(path, "density", c.fluid.density);
}

void read_boundary(const std::string& path, Case& c) {
  c.boundary = boundary_of(*open_part(path), path);
  check_finite(path, "normal", c.boundary.normal);
  check_finite(path, "depth", c.boundary.depth);
  check_finite(path, "friction", c.boundary.friction);
  check_bodies(path, c.boundary.body, c.bodies.size());
}

void read_grains(const std::string& path, Case& c) {
  c.grains = grains_of(*open_part(path), path, {});
  if (c.grains.diameter.empty()) refuse(path, "has no field \"diameter\" (m)");
  if (c.grains.density.empty()) refuse(path, "has no field \"density\" (kg/m3)");
  check_finite(path, "diameter", c.grains.diameter);
  check_finite(path, "density", c.grains.density);
  check_finite(path, "velocity", c.grains.velocity);
  check_finite(path, "angular_velocity", c.grains.angular_velocity);
  check_positive(path, "diameter", "m", c.grains.diameter);
  check_positive(path, "density", "kg/m3", c.grains.density);
  for (std::size_t i = 0; i < c.grains.group.size(); ++i)
    if (c.grains.group[i] < 0 || std::size_t(c.grains.group[i]) >= std::max<std::size_t>(1, c.scene.slides.size()))
      refuse(path, "grain " + std::to_string(i) + " belongs to slide " + std::to_string(c.grains.group[i]) + " of " +
                       std::to_string(c.scene.slides.size()));
}

void read_walls(const std::string& path, Case& c) {
  c.walls = triangles_of(*open_part(path), path);
  check_bodies(path, c.walls.body, c.bodies.size());
}

void read_parts(const fs::path& folder, const CaseCounts& stated, Case& c) {
  const auto part = [&](const char* name, const char* what, std::uint64_t count, auto read, const auto& table) {
    const std::string path = (folder / name).string();
    if (count > 0) read(path, c);
    check_count(path, what, table.size(), count);
  };
  part("fluid.vtp", "particles", stated.fluid, read_fluid, c.fluid.position);
  part("boundary.vtp", "particles", stated.boundary, read_boundary, c.boundary.position);
  part("grains.vtp", "grains", stated.grains, read_grains, c.grains.position);
  part("walls.vtp", "triangles", stated.wall_triangles, read_walls, c.walls.triangle);
}

/// Keys that may change after the particles were made.
void check_overrides(const std::vector<Override>& overrides) {
  for (const Override& o : overrides) {
    bool free = o.key == "fluid.kinematic_viscosity";
    for (const char* table : {"time.", "numerics.", "coupling.", "contact.", "economy."})
      free = free || o.key.starts_with(table);
    if (free) continue;
    throw Error(ErrorKind::input, "--set " + o.key + ": the case's particles were made with it; give it to " +
                                      "mesh2particles (here: time.*, numerics.*, coupling.*, contact.*, economy.*, " +
                                      "fluid.kinematic_viscosity)");
  }
}

}  // namespace

void write_case(const std::string& path, const Case& c, bool force, const std::vector<std::string>& extra_files) {
  try {
    SafeFolder folder(path, force);
    write_parts(folder, c, extra_files);
    folder.commit();
  } catch (const fs::filesystem_error& problem) {
    throw Error(ErrorKind::resource, path + ": cannot be written: " + problem.code().message());
  }
}

Case read_case(const std::string& path, const std::vector<Override>& overrides) {
  check_overrides(overrides);
  std::error_code ignored;
  const fs::path folder(path);
  if (!fs::exists(folder, ignored)) throw Error(ErrorKind::input, path + ": there is no such case folder");
  if (!fs::is_directory(folder, ignored))
    throw Error(ErrorKind::input, path + ": is a file, expected a case folder (mesh2particles SCENE -o NAME.case)");
  const std::string toml = (folder / "case.toml").string();
  if (!fs::exists(toml, ignored)) throw Error(ErrorKind::input, path + ": is no case: it has no case.toml");
  SceneReadOptions options;
  options.check_files = false;
  options.foreign_tables = {"case"};
  options.replace_preset = true;
  Case c;
  c.scene = read_scene(toml, overrides, options);
  const CaseCounts stated = read_case_table(toml, c);
  check_count(toml, "bodies", c.bodies.size(), stated.bodies);
  for (const int axis : {0, 1, 2})
    if (!(c.domain.lower[axis] <= c.domain.upper[axis]))
      throw Error(ErrorKind::input, toml + ": case.domain: lower is not below upper");
  read_parts(folder, stated, c);
  return c;
}

}  // namespace gdesp
