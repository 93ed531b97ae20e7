// SPDX-License-Identifier: GPL-3.0-or-later
// Walks the scene's description with a parsed TOML table at hand: types, ranges, places of mistakes.
#include "scene/scene_reader.hpp"

#include <cmath>
#include <filesystem>
#include <sstream>

#include "core/error.hpp"
#include "core/text.hpp"
#include "scene/scene_source.hpp"

namespace gdesp {
namespace scene_detail {
namespace fs = std::filesystem;

std::string where_is(const toml::node& node) {
  const toml::source_region& source = node.source();
  std::string place = source.path ? *source.path : std::string("scene");
  if (place.starts_with("--set ") || source.begin.line == 0) return place;
  return place + ":" + std::to_string(source.begin.line);
}

namespace {

/// The value as the user wrote it, short enough for a message.
std::string shown(const toml::node& node) {
  std::ostringstream out;
  out << toml::toml_formatter{node};
  std::string text = out.str();
  for (char& c : text)
    if (c == '\n') c = ' ';
  if (text.size() > 60) text.replace(57, std::string::npos, "...");
  return text;
}

[[noreturn]] void fail(const std::string& place, const std::string& key, const std::string& what) {
  throw Error(ErrorKind::input, place + ": " + (key.empty() ? "" : key + ": ") + what);
}

[[noreturn]] void wrong_value(const toml::node& node, const std::string& key, const std::string& expected) {
  fail(where_is(node), key, "found " + shown(node) + ", expected " + expected);
}

std::string with_unit(const std::string& what, const char* unit) {
  return *unit == '\0' || std::string(unit) == "1" ? what : what + " (" + unit + ")";
}

class Reader : public SceneVisitor {
 public:
  Reader(const toml::table& root, const std::string& file, bool check_files)
      : sources_(file), folder_(fs::path(file).parent_path()), check_files_(check_files) {
    levels_.push_back({&root, ""});
  }
  const KeySources& sources() const { return sources_; }
  bool reads() const override { return true; }

  void number(const Key& key, double& value, const Range& range) override {
    if (const toml::node* node = take(key)) value = number_of(*node, full(key), key.unit, range);
  }

  void integer(const Key& key, std::uint64_t& value, std::uint64_t lower, std::uint64_t upper) override {
    const toml::node* node = take(key);
    if (!node) return;
    const auto found = node->value_exact<std::int64_t>();
    if (!found || *found < 0 || std::uint64_t(*found) < lower || std::uint64_t(*found) > upper)
      wrong_value(*node, full(key), "a whole number from " + std::to_string(lower) + " to " + std::to_string(upper));
    value = static_cast<std::uint64_t>(*found);
  }

  void boolean(const Key& key, bool& value) override {
    const toml::node* node = take(key);
    if (!node) return;
    if (!node->is_boolean()) wrong_value(*node, full(key), "true or false");
    value = **node->as_boolean();
  }

  void text(const Key& key, std::string& value) override {
    if (const toml::node* node = take(key)) value = string_of(*node, full(key), "text in quotes");
  }

  void choice(const Key& key, std::string& value, const std::vector<std::string>& valid) override {
    if (const toml::node* node = take(key)) value = choice_of(*node, full(key), valid);
  }

  void choices(const Key& key, std::vector<std::string>& value, const std::vector<std::string>& valid) override {
    const toml::node* node = take(key);
    if (!node) return;
    value.clear();
    for_each_element(*node, full(key), "a list of: " + join(valid),
                     [&](const toml::node& one) { value.push_back(choice_of(one, full(key), valid)); });
  }

  void path(const Key& key, std::string& value) override {
    if (const toml::node* node = take(key)) value = path_of(*node, full(key));
  }

  void paths(const Key& key, std::vector<std::string>& value) override {
    if (std::string(key.name) == "files") {
      const toml::node* one = current().table ? current().table->get("file") : nullptr;
      if (one && current().table->get("files")) wrong_value(*one, full({"file", "", ""}), "either file or files");
      if (one) {
        sources_.add(full(key), where_is(*one));
        value = {path_of(*one, full({"file", "", ""}))};
        return;
      }
    }
    const toml::node* node = take(key);
    if (!node) return;
    value.clear();
    for_each_element(*node, full(key), "a list of paths",
                     [&](const toml::node& one) { value.push_back(path_of(one, full(key))); });
  }

  void vector(const Key& key, Vec3d& value) override {
    if (const toml::node* node = take(key)) value = vector_of(*node, full(key), key.unit);
  }
  void optional_vector(const Key& key, std::optional<Vec3d>& value) override {
    if (const toml::node* node = take(key)) value = vector_of(*node, full(key), key.unit);
  }
  void place(const Key& key, Vec3d& value, bool& has_z) override {
    const toml::node* node = take(key);
    if (!node) return;
    const std::vector<double> c = components(*node, full(key), key.unit, 2, 3);
    has_z = c.size() == 3;
    value = {c[0], c[1], has_z ? c[2] : 0.0};
  }
  void point(const Key& key, Point2& value) override {
    if (const toml::node* node = take(key)) value = point_of(*node, full(key), key.unit);
  }
  void optional_point(const Key& key, std::optional<Point2>& value) override {
    if (const toml::node* node = take(key)) value = point_of(*node, full(key), key.unit);
  }
  void polygon(const Key& key, std::vector<Point2>& value) override {
    const toml::node* node = take(key);
    if (!node) return;
    value.clear();
    for_each_element(*node, full(key), with_unit("points [[x, y], [x, y], ...]", key.unit),
                     [&](const toml::node& one) { value.push_back(point_of(one, full(key), key.unit)); });
  }

  void box(const Key& key, std::optional<Box>& value) override {
    const toml::node* node = take(key);
    if (!node) return;
    const std::string expected = with_unit("{lower = [x, y, z], upper = [x, y, z]}", key.unit);
    const toml::table* table = node->as_table();
    if (!table) wrong_value(*node, full(key), expected);
    for (const auto& [name, child] : *table)
      if (name.str() != "lower" && name.str() != "upper")
        fail(where_is(child), full(key) + "." + std::string(name.str()), "unknown key, expected " + expected);
    const toml::node *lower = table->get("lower"), *upper = table->get("upper");
    if (!lower || !upper) wrong_value(*node, full(key), expected);
    value = Box{vector_of(*lower, full(key) + ".lower", key.unit), vector_of(*upper, full(key) + ".upper", key.unit)};
  }

  void enter(const char* name) override {
    const toml::node* node = current().table ? current().table->get(name) : nullptr;
    const std::string path = current().path + name;
    if (node && !node->is_table()) wrong_value(*node, path, std::string("a table [") + name + "]");
    if (node) sources_.add(path, where_is(*node));
    levels_.push_back({node ? node->as_table() : nullptr, path + "."});
  }
  void leave() override { levels_.pop_back(); }

 protected:
  std::size_t count_tables(const char* name, std::size_t) override {
    const toml::node* node = current().table ? current().table->get(name) : nullptr;
    if (!node) return 0;
    if (node->is_table()) return 1;
    const toml::array* array = node->as_array();
    if (!array) wrong_value(*node, current().path + name, std::string("tables [[") + name + "]]");
    return array->size();
  }

  void enter_item(const char* name, std::size_t index) override {
    const toml::node* node = current().table->get(name);
    const std::string path = current().path + name + "." + std::to_string(index);
    const toml::node* item = node->is_table() ? node : node->as_array()->get(index);
    if (!item->is_table()) wrong_value(*item, path, std::string("a table [[") + name + "]]");
    sources_.add(path, where_is(*item));
    levels_.push_back({item->as_table(), path + "."});
  }

 private:
  struct Level {
    const toml::table* table;
    std::string path;
  };
  const Level& current() const { return levels_.back(); }
  std::string full(const Key& key) const { return current().path + key.name; }

  const toml::node* take(const Key& key) {
    const toml::node* node = current().table ? current().table->get(key.name) : nullptr;
    if (node) sources_.add(full(key), where_is(*node));
    if (!node && key.required)
      fail(sources_.where(full(key)), full(key), with_unit("is required", key.unit) + ": " + key.meaning);
    return node;
  }

  static double number_of(const toml::node& node, const std::string& key, const char* unit, const Range& range) {
    const auto found = node.is_number() ? node.value<double>() : std::nullopt;
    if (!found) wrong_value(node, key, with_unit("a number", unit));
    if (!std::isfinite(*found)) wrong_value(node, key, with_unit("a finite number", unit));
    const bool low = range.lower_open ? *found <= range.lower : *found < range.lower;
    if (low || *found > range.upper) {
      std::string valid;
      if (std::isfinite(range.lower)) valid = (range.lower_open ? "above " : "at least ") + toml_number(range.lower);
      if (std::isfinite(range.upper)) valid += (valid.empty() ? "" : " and ") + ("at most " + toml_number(range.upper));
      wrong_value(node, key, with_unit("a number " + valid, unit));
    }
    return *found;
  }

  static std::string string_of(const toml::node& node, const std::string& key, const std::string& expected) {
    if (!node.is_string()) wrong_value(node, key, expected);
    return **node.as_string();
  }

  static std::string choice_of(const toml::node& node, const std::string& key, const std::vector<std::string>& valid) {
    std::string found = string_of(node, key, "one of: " + join(valid));
    for (const std::string& one : valid)
      if (one == found) return found;
    const std::string near = did_you_mean(found, valid);
    wrong_value(node, key, "one of: " + join(valid) + (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
  }

  std::string path_of(const toml::node& node, const std::string& key) const {
    std::string found = string_of(node, key, "a path in quotes");
    if (found.empty()) return found;
    if (found.find('\0') != std::string::npos) wrong_value(node, key, "a path without NUL characters");
    const fs::path whole = fs::absolute(folder_ / found).lexically_normal();
    std::error_code ignored;
    if (check_files_ && !fs::exists(whole, ignored))
      fail(where_is(node), key,
           "there is no file \"" + whole.string() + "\" (a relative path starts at the folder of " + "the scene file)");
    return whole.string();
  }

  static std::vector<double> components(const toml::node& node, const std::string& key, const char* unit,
                                        std::size_t fewest, std::size_t most) {
    const std::string expected =
        with_unit(most == 2 ? "[x, y]" : (fewest == 2 ? "[x, y] or [x, y, z]" : "[x, y, z]"), unit);
    const toml::array* array = node.as_array();
    if (!array || array->size() < fewest || array->size() > most) wrong_value(node, key, expected);
    std::vector<double> out;
    for (const toml::node& one : *array) out.push_back(number_of(one, key, unit, any_number));
    return out;
  }
  static Vec3d vector_of(const toml::node& node, const std::string& key, const char* unit) {
    const std::vector<double> c = components(node, key, unit, 3, 3);
    return {c[0], c[1], c[2]};
  }
  static Point2 point_of(const toml::node& node, const std::string& key, const char* unit) {
    const std::vector<double> c = components(node, key, unit, 2, 2);
    return {c[0], c[1]};
  }

  template <class Use>
  static void for_each_element(const toml::node& node, const std::string& key, const std::string& expected, Use use) {
    const toml::array* array = node.as_array();
    if (!array) wrong_value(node, key, expected);
    for (const toml::node& one : *array) use(one);
  }

  KeySources sources_;
  fs::path folder_;
  bool check_files_;
  std::vector<Level> levels_;
};

}  // namespace

KeySources read_scene_table(const toml::table& root, const std::string& file, bool check_files, Scene& scene) {
  Reader reader(root, file, check_files);
  describe_scene(reader, scene);
  return reader.sources();
}

}  // namespace scene_detail
}  // namespace gdesp
