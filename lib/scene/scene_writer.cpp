// SPDX-License-Identifier: GPL-3.0-or-later
// A scene as TOML, every default filled in; and the key table, which is the same walk over an empty scene.
#include <charconv>
#include <cmath>

#include "core/text.hpp"
#include "scene/scene_source.hpp"
#include "scene/scene_visitor.hpp"

namespace gdesp {

std::string toml_number(double value) {
  char buffer[64];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  std::string text(buffer, end);
  if (std::isfinite(value) && text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string toml_string(const std::string& text) {
  static const char* digits = "0123456789ABCDEF";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte == 0x7F) {
      out += "\\u00";
      out += digits[byte >> 4];
      out += digits[byte & 15];
    } else {
      out += c;
    }
  }
  return out + '"';
}

namespace scene_detail {
namespace {

std::string text_of(const Vec3d& v) {
  return "[" + toml_number(v.x) + ", " + toml_number(v.y) + ", " + toml_number(v.z) + "]";
}
std::string text_of(const Point2& p) { return "[" + toml_number(p.x) + ", " + toml_number(p.y) + "]"; }
std::string text_of(const Box& b) { return "{lower = " + text_of(b.lower) + ", upper = " + text_of(b.upper) + "}"; }
std::string text_of(const std::vector<std::string>& words) {
  std::vector<std::string> quoted;
  quoted.reserve(words.size());
  for (const std::string& word : words) quoted.push_back(toml_string(word));
  return "[" + join(quoted) + "]";
}
std::string text_of(const std::vector<Point2>& points) {
  std::vector<std::string> texts;
  texts.reserve(points.size());
  for (const Point2& point : points) texts.push_back(text_of(point));
  return "[" + join(texts) + "]";
}

class Writer : public SceneVisitor {
 public:
  std::string out;

  void number(const Key& key, double& value, const Range&) override { line(key, toml_number(value)); }
  void integer(const Key& key, std::uint64_t& value, std::uint64_t, std::uint64_t) override {
    line(key, std::to_string(value));
  }
  void boolean(const Key& key, bool& value) override { line(key, value ? "true" : "false"); }
  void text(const Key& key, std::string& value) override {
    if (!value.empty()) line(key, toml_string(value));
  }
  void choice(const Key& key, std::string& value, const std::vector<std::string>&) override {
    line(key, toml_string(value));
  }
  void choices(const Key& key, std::vector<std::string>& value, const std::vector<std::string>&) override {
    line(key, text_of(value));
  }
  void path(const Key& key, std::string& value) override { text(key, value); }
  void paths(const Key& key, std::vector<std::string>& value) override {
    if (!value.empty()) line(key, text_of(value));
  }
  void vector(const Key& key, Vec3d& value) override { line(key, text_of(value)); }
  void optional_vector(const Key& key, std::optional<Vec3d>& value) override {
    if (value) line(key, text_of(*value));
  }
  void place(const Key& key, Vec3d& value, bool& has_z) override {
    line(key, has_z ? text_of(value) : text_of(Point2{value.x, value.y}));
  }
  void point(const Key& key, Point2& value) override { line(key, text_of(value)); }
  void optional_point(const Key& key, std::optional<Point2>& value) override {
    if (value) line(key, text_of(*value));
  }
  void polygon(const Key& key, std::vector<Point2>& value) override {
    if (!value.empty()) line(key, text_of(value));
  }
  void box(const Key& key, std::optional<Box>& value) override {
    if (value) line(key, text_of(*value));
  }
  void enter(const char* table) override {
    push(table);
    out += "\n[" + prefix_ + "]\n";
  }
  void leave() override { prefix_.resize(prefix_.rfind('.') == std::string::npos ? 0 : prefix_.rfind('.')); }

 protected:
  std::size_t count_tables(const char*, std::size_t present) override { return present; }
  void enter_item(const char* name, std::size_t) override {
    push(name);
    out += "\n[[" + prefix_ + "]]\n";
  }

 private:
  void push(const char* name) { prefix_ += (prefix_.empty() ? "" : ".") + std::string(name); }
  void line(const Key& key, const std::string& value) { out += std::string(key.name) + " = " + value + "\n"; }
  std::string prefix_;
};

class Lister : public SceneVisitor {
 public:
  std::vector<SceneKey> keys;
  std::vector<std::string> arrays;

  void number(const Key& key, double& value, const Range& range) override {
    add(key, "number" + text_of_range(range), toml_number(value));
  }
  void integer(const Key& key, std::uint64_t& value, std::uint64_t, std::uint64_t) override {
    add(key, "integer", std::to_string(value));
  }
  void boolean(const Key& key, bool& value) override { add(key, "true or false", value ? "true" : "false"); }
  void text(const Key& key, std::string& value) override { add(key, "text", value.empty() ? "" : toml_string(value)); }
  void choice(const Key& key, std::string& value, const std::vector<std::string>& valid) override {
    add(key, "one of: " + join(valid), toml_string(value));
  }
  void choices(const Key& key, std::vector<std::string>&, const std::vector<std::string>& valid) override {
    add(key, "list of: " + join(valid), "[]");
  }
  void path(const Key& key, std::string&) override { add(key, "path", ""); }
  void paths(const Key& key, std::vector<std::string>&) override { add(key, "list of paths", ""); }
  void vector(const Key& key, Vec3d& value) override { add(key, "[x, y, z]", text_of(value)); }
  void optional_vector(const Key& key, std::optional<Vec3d>&) override { add(key, "[x, y, z]", ""); }
  void place(const Key& key, Vec3d&, bool&) override { add(key, "[x, y] or [x, y, z]", ""); }
  void point(const Key& key, Point2&) override { add(key, "[x, y]", ""); }
  void optional_point(const Key& key, std::optional<Point2>&) override { add(key, "[x, y]", ""); }
  void polygon(const Key& key, std::vector<Point2>&) override { add(key, "[[x, y], ...]", ""); }
  void box(const Key& key, std::optional<Box>&) override { add(key, "{lower, upper}", ""); }
  void enter(const char* table) override { prefix_ += std::string(table) + "."; }
  void leave() override {
    prefix_.pop_back();
    prefix_.resize(prefix_.rfind('.') == std::string::npos ? 0 : prefix_.rfind('.') + 1);
  }

 protected:
  std::size_t count_tables(const char*, std::size_t) override { return 1; }
  void enter_item(const char* name, std::size_t) override {
    arrays.push_back(prefix_ + name);
    enter(name);
  }

 private:
  static std::string text_of_range(const Range& range) {
    const bool below = std::isfinite(range.lower), above = std::isfinite(range.upper);
    const std::string lower = below ? (range.lower_open ? " > " : " >= ") + short_number(range.lower) : "";
    return lower + (below && above ? " and" : "") + (above ? " <= " + short_number(range.upper) : "");
  }
  static std::string short_number(double value) {
    std::string text = toml_number(value);
    if (text.size() > 2 && text.ends_with(".0")) text.resize(text.size() - 2);
    return text;
  }
  void add(const Key& key, const std::string& type, const std::string& standard) {
    keys.push_back({prefix_ + key.name, type, key.unit, key.required ? "required" : standard, key.meaning});
  }
  std::string prefix_;
};

}  // namespace
}  // namespace scene_detail

std::string scene_to_toml(const Scene& scene) {
  Scene copy = scene;
  scene_detail::Writer writer;
  scene_detail::describe_scene(writer, copy);
  return writer.out;
}

namespace {
const scene_detail::Lister& listed() {
  static const scene_detail::Lister lister = [] {
    Scene defaults;
    scene_detail::Lister walk;
    scene_detail::describe_scene(walk, defaults);
    return walk;
  }();
  return lister;
}
}  // namespace

const std::vector<SceneKey>& scene_keys() { return listed().keys; }
const std::vector<std::string>& scene_detail::table_arrays() { return listed().arrays; }

}  // namespace gdesp
