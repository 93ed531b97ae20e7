// SPDX-License-Identifier: GPL-3.0-or-later
// From a file and the command line's overrides to a scene: parsing, overriding, unknown keys.
#include "scene/scene_source.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "core/error.hpp"
#include "core/text.hpp"
#include "scene/scene_reader.hpp"

namespace gdesp {
namespace {

using scene_detail::where_is;
namespace fs = std::filesystem;

constexpr std::uintmax_t largest_file = 64u << 20;  // bytes; a scene is text written by people

std::string file_text(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw Error(ErrorKind::input, path + ": there is no such file");
  if (fs::is_directory(status)) throw Error(ErrorKind::input, path + ": is a folder, expected a scene file (TOML)");
  std::ifstream in(path, std::ios::binary);
  std::string text;
  char block[65536];
  while (in.read(block, sizeof block) || in.gcount() > 0) {
    text.append(block, static_cast<std::size_t>(in.gcount()));
    if (text.size() > largest_file) throw Error(ErrorKind::input, path + ": larger than 64 MiB: not a scene file");
  }
  if (in.bad() || (!in.eof() && in.fail())) throw Error(ErrorKind::input, path + ": cannot be read");
  return text;
}

std::string describe(const toml::parse_error& error) { return std::string(error.description()); }

toml::table parse_file(const std::string& path) {
  const std::string text = file_text(path);
  try {
    return toml::parse(text, std::string_view(path));
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw Error(ErrorKind::input, path + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) +
                                      ": not TOML: " + describe(error));
  }
}

std::vector<std::string> split(const std::string& key) {
  std::vector<std::string> parts(1);
  for (const char c : key) {
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

bool is_index(const std::string& part) {
  return !part.empty() && part.size() < 7 && part.find_first_not_of("0123456789") == std::string::npos;
}

/// The table {value = ...}, whose nodes say "--set key=value" when asked where they are from.
toml::table override_value(const Override& override) {
  const std::string origin = "--set " + override.key + "=" + override.value;
  const auto control = [](unsigned char c) { return c < 0x20; };
  if (std::any_of(override.value.begin(), override.value.end(), control) || override.value.empty())
    throw Error(ErrorKind::input, origin + ": expected a value on one line");
  try {
    return toml::parse("value = " + override.value, std::string_view(origin));
  } catch (const toml::parse_error& error) {
    if (override.value.find_first_of("\"'[]{}") != std::string::npos)
      throw Error(ErrorKind::input, origin + ": not a TOML value: " + describe(error));
  }
  try {
    return toml::parse("value = " + toml_string(override.value), std::string_view(origin));
  } catch (const toml::parse_error& error) {  // bytes that are no UTF-8
    throw Error(ErrorKind::input, "--set " + override.key + ": not a TOML value: " + describe(error));
  }
}

bool is_table_array(const std::string& key) {
  const std::vector<std::string>& arrays = scene_detail::table_arrays();
  return std::find(arrays.begin(), arrays.end(), key) != arrays.end();
}

/// Known keys, and the tables on the way to them.
struct KnownKeys {
  std::set<std::string> leaves{"terrain.file"}, tables;
  std::vector<std::string> all;

  KnownKeys() {
    for (const SceneKey& key : scene_keys()) {
      all.push_back(key.key);
      leaves.insert(key.key);
      for (std::size_t dot = key.key.find('.'); dot != std::string::npos; dot = key.key.find('.', dot + 1))
        tables.insert(key.key.substr(0, dot));
    }
  }

  std::vector<std::string> children(const std::string& prefix) const {
    std::set<std::string> names;
    for (const std::string& key : leaves)
      if (key.starts_with(prefix))
        names.insert(key.substr(prefix.size(), key.find('.', prefix.size()) - prefix.size()));
    return {names.begin(), names.end()};
  }

  /// "did you mean": a sibling spelled alike, else a key of that very name elsewhere.
  std::string suggestion(const std::string& prefix, const std::string& name) const {
    const std::string near = did_you_mean(name, children(prefix));
    if (!near.empty()) return "; did you mean \"" + prefix + near + "\"?";
    for (const std::string& key : all)
      if (key.ends_with("." + name)) return "; did you mean \"" + key + "\"?";
    return "; valid here: " + join(children(prefix));
  }
};

/// Refuses an override of a key that no scene has, and says which was meant.
void refuse_unknown_override(const std::vector<std::string>& parts, const std::string& origin, const KnownKeys& known) {
  std::string prefix;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string full = prefix + parts[i];
    if (known.leaves.count(full)) return;  // what follows is inside a value such as box.upper
    if (!known.tables.count(full))
      throw Error(ErrorKind::input, origin + ": unknown key \"" + full + "\"" + known.suggestion(prefix, parts[i]));
    if (is_table_array(full) && i + 1 < parts.size() && is_index(parts[i + 1])) ++i;
    prefix = full + ".";
  }
}

/// One step down: into a table, or into an element of an array of tables (`part` moves past an index).
toml::table* step_down(toml::table& table, const std::vector<std::string>& parts, std::size_t& i, std::string& path,
                       const std::string& origin) {
  path += (path.empty() ? "" : ".") + parts[i];
  toml::node* node = table.get(parts[i]);
  const bool array_expected = is_table_array(path);
  const bool indexed = array_expected && i + 1 < parts.size() && is_index(parts[i + 1]);
  const std::size_t index = indexed ? std::stoul(parts[i + 1]) : 0;
  if (indexed) ++i;
  if (!node && array_expected) throw Error(ErrorKind::input, origin + ": the scene has no [[" + path + "]]");
  if (!node) node = &table.insert_or_assign(parts[i], toml::table{}).first->second;
  const std::size_t count = node->is_array() ? node->as_array()->size() : 1;
  if (index >= count)
    throw Error(ErrorKind::input,
                origin + ": the scene has " + std::to_string(count) + " [[" + path + "]], numbered from 0");
  if (toml::array* array = node->as_array()) node = array->get(index);
  if (!node->is_table()) throw Error(ErrorKind::input, origin + ": " + path + " is a value, not a table");
  return node->as_table();
}

void apply_override(toml::table& root, const Override& override, const KnownKeys& known) {
  const std::string origin = "--set " + override.key + "=" + override.value;
  const std::vector<std::string> parts = split(override.key);
  for (const std::string& part : parts)
    if (part.empty()) throw Error(ErrorKind::usage, origin + ": expected KEY=VALUE, such as resolution.dp=5");
  refuse_unknown_override(parts, origin, known);
  toml::table value = override_value(override);
  toml::table* table = &root;
  std::string path;
  std::size_t i = 0;
  for (; i + 1 < parts.size(); ++i) {
    table = step_down(*table, parts, i, path, origin);
    if (i + 1 >= parts.size()) throw Error(ErrorKind::usage, origin + ": names a table, not one of its keys");
  }
  if (path == "terrain" && (parts.back() == "file" || parts.back() == "files")) {
    table->erase("file");
    table->erase("files");
  }
  table->insert_or_assign(parts.back(), std::move(*value.get("value")));
}

void refuse_unknown(const toml::table& table, const std::string& prefix, const KnownKeys& known,
                    const std::vector<std::string>& foreign) {
  for (const auto& [name, node] : table) {
    const std::string key(name.str()), full = prefix + key;
    if (prefix.empty() && std::find(foreign.begin(), foreign.end(), key) != foreign.end()) continue;
    if (known.leaves.count(full)) continue;
    if (!known.tables.count(full))
      throw Error(ErrorKind::input, where_is(node) + ": unknown key \"" + full + "\"" + known.suggestion(prefix, key));
    if (const toml::table* child = node.as_table()) refuse_unknown(*child, full + ".", known, foreign);
    if (const toml::array* array = node.as_array())
      for (const toml::node& item : *array)
        if (const toml::table* child = item.as_table()) refuse_unknown(*child, full + ".", known, foreign);
  }
}

/// A case's scene has every key filled in. When its preset is overridden, the keys that still hold what the old
/// preset gave are taken out, so that the new preset's values come in.
void forget_old_preset(toml::table& root) {
  const auto preset = root["numerics"]["preset"].value<std::string>();
  Scene old;
  if (!preset || !scene_detail::apply_preset(*preset, old)) return;
  const auto drop = [&root](const char* table, const char* key, const auto& standard) {
    toml::table* in = root[table].as_table();
    if (!in) return;
    const auto found = (*in)[key].value<std::decay_t<decltype(standard)>>();
    if (found && *found == standard) in->erase(key);
  };
  drop("numerics", "time_scheme", old.numerics.time_scheme);
  drop("numerics", "walls", old.numerics.walls);
  drop("numerics", "wall_layers", old.numerics.wall_layers);
  drop("numerics", "viscosity", old.numerics.viscosity);
  drop("numerics", "smoothing_ratio", old.numerics.smoothing_ratio);
  drop("numerics", "artificial_viscosity", old.numerics.artificial_viscosity);
  drop("numerics", "density_diffusion", old.numerics.density_diffusion);
  drop("numerics", "tension", old.numerics.tension);
  drop("numerics", "multirate", old.numerics.multirate);
  drop("coupling", "drag", old.coupling.drag);
  drop("coupling", "added_mass", old.coupling.added_mass);
  drop("economy", "sleep", old.economy.sleep);
  drop("economy", "viscosity", old.economy.viscosity);
  drop("economy", "near_walls", old.economy.near_walls);
}

}  // namespace

Scene read_scene(const std::string& path, const std::vector<Override>& overrides, const SceneReadOptions& options) {
  static const KnownKeys known;
  toml::table root = parse_file(path);
  if (options.replace_preset)
    for (const Override& override : overrides)
      if (override.key == "numerics.preset") forget_old_preset(root);
  for (const Override& override : overrides) apply_override(root, override, known);
  refuse_unknown(root, "", known, options.foreign_tables);
  Scene scene;
  const scene_detail::KeySources sources = scene_detail::read_scene_table(root, path, options.check_files, scene);
  scene_detail::check_scene(scene, sources);
  scene.path = fs::absolute(path).lexically_normal().string();
  return scene;
}

Scene read_scene(const std::string& path, const std::vector<Override>& overrides) {
  return read_scene(path, overrides, SceneReadOptions{});
}

std::string toml_table_as_json(const std::string& path, const std::string& table) {
  const toml::table root = parse_file(path);
  const toml::table* found = root[table].as_table();
  if (!found) return {};
  std::ostringstream out;
  out << toml::json_formatter{*found};
  return out.str();
}

}  // namespace gdesp
