// SPDX-License-Identifier: GPL-3.0-or-later
// One description of the scene's keys (scene_description.cpp), walked by three visitors: the reader, the writer
// and the lister that makes the key table. A key is therefore written down exactly once.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace gdesp::scene_detail {

/// What a number may be; both bounds belong to the range unless `lower_open`.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = false;
};
inline constexpr Range any_number{};
inline constexpr Range positive{0.0, std::numeric_limits<double>::infinity(), true};
inline constexpr Range not_negative{0.0, std::numeric_limits<double>::infinity(), false};
inline constexpr Range share{0.0, 1.0, false};

/// What is said of a key besides its type.
struct Key {
  const char* name;
  const char* unit;
  const char* meaning;
  bool required = false;
};

/// Visits every key. Leaves take the value by reference: a reader changes it, the others look.
class SceneVisitor {
 public:
  virtual ~SceneVisitor() = default;
  virtual bool reads() const { return false; }

  virtual void number(const Key&, double&, const Range&) = 0;
  virtual void integer(const Key&, std::uint64_t&, std::uint64_t lower, std::uint64_t upper) = 0;
  virtual void boolean(const Key&, bool&) = 0;
  virtual void text(const Key&, std::string&) = 0;
  virtual void choice(const Key&, std::string&, const std::vector<std::string>& valid) = 0;
  virtual void choices(const Key&, std::vector<std::string>&, const std::vector<std::string>& valid) = 0;
  virtual void path(const Key&, std::string&) = 0;
  virtual void paths(const Key&, std::vector<std::string>&) = 0;
  virtual void vector(const Key&, Vec3d&) = 0;
  virtual void optional_vector(const Key&, std::optional<Vec3d>&) = 0;
  virtual void place(const Key&, Vec3d&, bool& has_z) = 0;
  virtual void point(const Key&, Point2&) = 0;
  virtual void optional_point(const Key&, std::optional<Point2>&) = 0;
  virtual void polygon(const Key&, std::vector<Point2>&) = 0;
  virtual void box(const Key&, std::optional<Box>&) = 0;

  /// A table of its own: the keys between enter and leave belong to it.
  virtual void enter(const char* table) = 0;
  virtual void leave() = 0;

  /// An array of tables; `describe(visitor, item)` visits the keys of one.
  template <class Item, class Describe>
  void tables(const char* name, std::vector<Item>& items, Describe describe) {
    items.resize(count_tables(name, items.size()));
    for (std::size_t i = 0; i < items.size(); ++i) {
      enter_item(name, i);
      describe(*this, items[i]);
      leave();
    }
  }

 protected:
  virtual std::size_t count_tables(const char* name, std::size_t present) = 0;
  virtual void enter_item(const char* name, std::size_t index) = 0;
};

/// Visits every key of the scene, in the order in which they are documented and written.
void describe_scene(SceneVisitor& visitor, Scene& scene);

/// Names of the arrays of tables: "slide", "slide.sieve", "fluid.fill", ...
const std::vector<std::string>& table_arrays();

/// Options set by a preset; keys given by the user override them. Returns false when there is no such preset.
bool apply_preset(const std::string& preset, Scene& scene);
const std::vector<std::string>& preset_names();

/// Where keys came from: "slide.0.diameter" -> "lake.toml:12". Also tells whether a key was given at all.
class KeySources {
 public:
  explicit KeySources(std::string file) : file_(std::move(file)) {}
  void add(const std::string& key, const std::string& where) { entries_.push_back({key, where}); }
  bool given(const std::string& key) const { return find(key) != nullptr; }
  /// Place of the key, else of the nearest table around it, else the file.
  std::string where(std::string key) const {
    for (;;) {
      if (const std::string* place = find(key)) return *place;
      const std::size_t dot = key.rfind('.');
      if (dot == std::string::npos) return file_;
      key.resize(dot);
    }
  }

 private:
  struct Entry {
    std::string key, where;
  };
  const std::string* find(const std::string& key) const {
    for (const Entry& entry : entries_)
      if (entry.key == key) return &entry.where;
    return nullptr;
  }
  std::string file_;
  std::vector<Entry> entries_;
};

/// What no single key can say: exactly one shape, required keys by kind, unique names. Fills in names and kinds
/// that were left out. Throws Error(input).
void check_scene(Scene& scene, const KeySources& sources);

}  // namespace gdesp::scene_detail
