// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/case_toml.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/version.hpp"
#include "scene/scene_source.hpp"

namespace gdesp {
namespace {

using nlohmann::json;

std::string text_of(const double* values, std::size_t count) {
  std::string out = "[";
  for (std::size_t i = 0; i < count; ++i) out += (i ? ", " : "") + toml_number(values[i]);
  return out + "]";
}
std::string text_of(const Vec3d& v) {
  const double xyz[3] = {v.x, v.y, v.z};
  return text_of(xyz, 3);
}

const char* kind_name(BodyKind kind) {
  return kind == BodyKind::free ? "\"free\"" : kind == BodyKind::far_lake ? "\"far-lake\"" : "\"prescribed\"";
}

std::string far_lake_table(const FarLakeShape& lake) {
  return "far_lake = {length = " + toml_number(lake.length) + ", depth = " + toml_number(lake.depth) +
         ", width = " + toml_number(lake.width) + ", columns = " + std::to_string(lake.columns) +
         ", side = " + toml_number(lake.side) + ", wall = " + toml_number(lake.wall) +
         ", level = " + toml_number(lake.level) + "}\n";
}

std::string body_table(const Body& body) {
  std::string out = "\n[[case.body]]\nname = " + toml_string(body.name) + "\n";
  out += std::string("kind = ") + kind_name(body.kind) + "\n";
  out += "centre = " + text_of(body.centre) + "\n";
  out += "velocity = " + text_of(body.velocity) + "\n";
  out += "angular_velocity = " + text_of(body.angular_velocity) + "\n";
  out += "mass = " + toml_number(body.mass) + "\n";
  out += "inertia = " + text_of(body.inertia, 9) + "\n";
  out += "release_at = " + toml_number(body.release_at) + "\n";
  out += "fixed = [";  // along x, y, z; rotation
  for (int k = 0; k < 4; ++k) out += std::string(k ? ", " : "") + (body.fixed[k] ? "true" : "false");
  out += "]\nremove_at = " + toml_number(body.motion.remove_at) + "\n";
  out += "motion = [";  // rows of t, dx, dy, dz
  for (std::size_t i = 0; i < body.motion.time.size(); ++i) {
    const Vec3d& d = body.motion.displacement[i];
    const double row[4] = {body.motion.time[i], d.x, d.y, d.z};
    out += (i ? ", " : "") + text_of(row, 4);
  }
  return out + "]\n" + (body.kind == BodyKind::far_lake ? far_lake_table(body.far_lake) : "");
}

/// Reads values out of the [case] table; messages name file and key.
class Values {
 public:
  Values(const std::string& path, const json& table, std::string prefix)
      : path_(path), table_(table), prefix_(std::move(prefix)) {}

  [[noreturn]] void fail(const std::string& key, const std::string& expected) const {
    throw Error(ErrorKind::input, path_ + ": " + prefix_ + key + ": expected " + expected);
  }
  const json* find(const std::string& key) const {
    const auto found = table_.find(key);
    return found == table_.end() ? nullptr : &*found;
  }
  double number(const std::string& key, double standard) const {
    const json* value = find(key);
    if (!value) return standard;
    if (!value->is_number()) fail(key, "a finite number");
    return value->get<double>();
  }
  std::uint64_t count(const std::string& key) const {
    const json* value = find(key);
    if (!value) return 0;
    if (!value->is_number_integer() || value->get<std::int64_t>() < 0) fail(key, "a whole number from 0");
    return value->get<std::uint64_t>();
  }
  std::string text(const std::string& key) const {
    const json* value = find(key);
    if (!value || !value->is_string()) fail(key, "text");
    return value->get<std::string>();
  }
  std::vector<double> numbers(const json& value, const std::string& key, std::size_t count) const {
    const std::string expected = std::to_string(count) + " finite numbers";
    if (!value.is_array() || value.size() != count) fail(key, expected);
    std::vector<double> out;
    for (const json& one : value) {
      if (!one.is_number()) fail(key, expected);
      out.push_back(one.get<double>());
    }
    return out;
  }
  Vec3d vector(const std::string& key) const {
    const json* value = find(key);
    if (!value) fail(key, "[x, y, z]");
    const std::vector<double> xyz = numbers(*value, key, 3);
    return {xyz[0], xyz[1], xyz[2]};
  }
  Values table(const std::string& key) const {
    const json* value = find(key);
    if (!value || !value->is_object()) fail(key, "a table");
    return Values(path_, *value, prefix_ + key + ".");
  }
  std::vector<Values> tables(const std::string& key) const {
    std::vector<Values> out;
    const json* value = find(key);
    if (!value) return out;
    if (!value->is_array()) fail(key, "tables");
    for (const json& one : *value) {
      if (!one.is_object()) fail(key, "tables");
      out.emplace_back(path_, one, prefix_ + key + "." + std::to_string(out.size()) + ".");
    }
    return out;
  }

 private:
  const std::string& path_;
  const json& table_;
  std::string prefix_;
};

PrescribedMotion motion_of(const Values& values) {
  PrescribedMotion motion;
  motion.remove_at = values.number("remove_at", -1.0);
  const json* rows = values.find("motion");
  if (!rows) return motion;
  if (!rows->is_array()) values.fail("motion", "rows [t, dx, dy, dz]");
  for (const json& row : *rows) {
    const std::vector<double> r = values.numbers(row, "motion", 4);
    if (!motion.time.empty() && r[0] <= motion.time.back()) values.fail("motion", "times that increase (s)");
    motion.time.push_back(r[0]);
    motion.displacement.push_back({r[1], r[2], r[3]});
  }
  return motion;
}

void read_hold(const Values& values, Body& body) {
  body.release_at = values.number("release_at", 0.0);
  const json* fixed = values.find("fixed");
  if (!fixed) return;
  const auto is_truth = [](const json& one) { return one.is_boolean(); };
  if (!fixed->is_array() || fixed->size() != 4 || !std::all_of(fixed->begin(), fixed->end(), is_truth))
    values.fail("fixed", "4 of true, false");
  for (std::size_t k = 0; k < 4; ++k) body.fixed[k] = (*fixed)[k].get<bool>();
}

FarLakeShape far_lake_of(const Values& values) {
  FarLakeShape lake;
  lake.length = values.number("length", 0.0);
  lake.depth = values.number("depth", 0.0);
  lake.width = values.number("width", 0.0);
  lake.columns = static_cast<int>(std::min<std::uint64_t>(values.count("columns"), 10000000));
  lake.side = values.number("side", 0.0);
  lake.wall = values.number("wall", 0.0);
  lake.level = values.number("level", 0.0);
  for (const auto& [key, value] : {std::pair{"length", lake.length}, {"depth", lake.depth}, {"width", lake.width}})
    if (!(value > 0.0)) values.fail(key, "a number above 0 (m)");
  if (lake.columns < 2) values.fail("columns", "a whole number from 2");
  if (std::abs(lake.side) != 1.0) values.fail("side", "1 or -1");
  return lake;
}

Body body_of(const Values& values) {
  Body body;
  body.name = values.text("name");
  const std::string kind = values.text("kind");
  if (kind == "free")
    body.kind = BodyKind::free;
  else if (kind == "far-lake")
    body.kind = BodyKind::far_lake;
  else if (kind != "prescribed")
    values.fail("kind", "\"free\", \"prescribed\" or \"far-lake\"");
  if (body.kind == BodyKind::far_lake) body.far_lake = far_lake_of(values.table("far_lake"));
  body.motion = motion_of(values);
  body.centre = values.vector("centre");
  body.velocity = values.vector("velocity");
  body.angular_velocity = values.vector("angular_velocity");
  read_hold(values, body);
  body.mass = values.number("mass", 0.0);
  const json* inertia = values.find("inertia");
  if (!inertia) values.fail("inertia", "9 finite numbers");
  const std::vector<double> entries = values.numbers(*inertia, "inertia", 9);
  std::copy(entries.begin(), entries.end(), body.inertia);
  if (body.kind == BodyKind::free && body.mass <= 0.0) values.fail("mass", "a number above 0 (kg)");
  return body;
}

}  // namespace

CaseCounts counts_of(const Case& c) {
  return {c.fluid.position.size(), c.boundary.position.size(), c.grains.position.size(),
          c.walls.vertex.size(),   c.walls.triangle.size(),    c.bodies.size()};
}

std::string case_table(const Case& c, const std::vector<std::string>& files) {
  const CaseCounts n = counts_of(c);
  std::string out =
      "\n# Written by mesh2particles; positions in the files are scene coordinates minus offset.\n[case]\n";
  out += "format = " + std::to_string(case_format) + "\n";
  out += "written_by = " + toml_string(std::string("gdesp ") + version + " " + commit) + "\n";
  out += "scene = " + toml_string(c.scene.path) + "\n";
  out += "offset = " + text_of(c.offset) + "\n";
  out += "domain = {lower = " + text_of(c.domain.lower) + ", upper = " + text_of(c.domain.upper) + "}\n";
  if (std::isfinite(c.still_water_level)) out += "still_water_level = " + toml_number(c.still_water_level) + "\n";
  if (std::isfinite(c.terrain_top)) out += "terrain_top = " + toml_number(c.terrain_top) + "\n";
  out += "counts = {fluid = " + std::to_string(n.fluid) + ", boundary = " + std::to_string(n.boundary) +
         ", grains = " + std::to_string(n.grains) + ", wall_vertices = " + std::to_string(n.wall_vertices) +
         ", wall_triangles = " + std::to_string(n.wall_triangles) + ", bodies = " + std::to_string(n.bodies) + "}\n";
  out += "files = [";
  for (std::size_t i = 0; i < files.size(); ++i) out += (i ? ", " : "") + toml_string(files[i]);
  out += "]\n";
  for (const Body& body : c.bodies) out += body_table(body);
  for (const SourceFile& source : c.sources)
    out += "\n[[case.source]]\npath = " + toml_string(source.path) + "\nsha256 = " + toml_string(source.sha256) + "\n";
  return out;
}

CaseCounts read_case_table(const std::string& path, Case& c) {
  const std::string text = toml_table_as_json(path, "case");
  if (text.empty()) throw Error(ErrorKind::input, path + ": has no [case] table: not written by mesh2particles");
  const json table = json::parse(text, nullptr, false);
  if (table.is_discarded()) throw Error(ErrorKind::input, path + ": the [case] table cannot be understood");
  const Values values(path, table, "case.");
  if (values.count("format") != std::uint64_t(case_format))
    values.fail("format", std::to_string(case_format) + ": the case was written by another version");
  c.scene.path = values.find("scene") ? values.text("scene") : "";
  c.offset = values.vector("offset");
  const Values domain = values.table("domain");
  c.domain = {domain.vector("lower"), domain.vector("upper")};
  c.still_water_level = values.number("still_water_level", 0.0);
  c.terrain_top = values.number("terrain_top", 0.0);
  for (const Values& body : values.tables("body")) c.bodies.push_back(body_of(body));
  for (const Values& source : values.tables("source"))
    c.sources.push_back({source.text("path"), source.text("sha256")});
  const Values counts = values.table("counts");
  return {counts.count("fluid"),         counts.count("boundary"),       counts.count("grains"),
          counts.count("wall_vertices"), counts.count("wall_triangles"), counts.count("bodies")};
}

}  // namespace gdesp
