// SPDX-License-Identifier: GPL-3.0-or-later
// The key table and the page that documents it.
#include <map>
#include <set>
#include <sstream>

#include "core/text.hpp"
#include "scene_fixture.hpp"

namespace gdesp::test {
namespace {

std::string row_of(const SceneKey& key) {
  std::string standard = key.default_value.empty() ? "" : "`" + key.default_value + "`";
  if (key.default_value == "required") standard = "**required**";
  return "| `" + key.key + "` | " + key.type + " | " + key.unit + " | " + standard + " | " + key.meaning + " |";
}

TEST(SceneKeys, are_named_once_with_meaning) {
  std::set<std::string> names;
  for (const SceneKey& key : scene_keys()) {
    EXPECT_TRUE(names.insert(key.key).second) << key.key << " twice";
    EXPECT_FALSE(key.meaning.empty()) << key.key;
    EXPECT_FALSE(key.type.empty()) << key.key;
  }
  for (const char* name : {"resolution.dp", "slide.diameter", "slide.sieve.mass_share", "fluid.fill.level", "gate.box",
                           "piston.motion_csv", "body.mesh", "numerics.preset", "time.end", "region.polygon"})
    EXPECT_TRUE(names.count(name)) << name;
}

TEST(SceneKeys, defaults_are_those_of_the_structs) {
  std::map<std::string, SceneKey> keys;
  for (const SceneKey& key : scene_keys()) keys[key.key] = key;
  EXPECT_EQ(keys["contact.restitution"].default_value, "0.5");
  EXPECT_EQ(keys["numerics.walls"].default_value, "\"extrapolated\"");
  EXPECT_EQ(keys["resolution.dp"].default_value, "required");
  EXPECT_EQ(keys["slide.porosity"].type, "number >= 0 and <= 1");
  EXPECT_EQ(keys["resolution.dp"].unit, "m");
}

/// docs/formats/scene.md lists exactly these keys, with these types, units, defaults and meanings.
TEST(SceneKeys, page_lists_exactly_the_keys) {
  const std::string page = text_of_file(GDESP_SOURCE_DIR "/docs/formats/scene.md");
  ASSERT_FALSE(page.empty()) << "docs/formats/scene.md is missing";
  std::vector<std::string> documented, expected;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("| `")) documented.push_back(line);
  for (const SceneKey& key : scene_keys()) expected.push_back(row_of(key));
  const std::set<std::string> there(documented.begin(), documented.end()), due(expected.begin(), expected.end());
  for (const std::string& row : expected) EXPECT_TRUE(there.count(row)) << "the page lacks:\n" << row;
  for (const std::string& row : documented) EXPECT_TRUE(due.count(row)) << "the page has in excess:\n" << row;
}

/// The example at the head of the page is a scene.
TEST(SceneKeys, example_of_the_page_is_accepted) {
  const std::string page = text_of_file(GDESP_SOURCE_DIR "/docs/formats/scene.md");
  const std::size_t start = page.find("```toml\n"), end = page.find("\n```", start + 8);
  ASSERT_NE(start, std::string::npos);
  ASSERT_NE(end, std::string::npos);
  const TempFolder folder;
  folder.write("valley.tif", "x");
  const Scene scene = read_scene(folder.write("s.toml", page.substr(start + 8, end - start - 7)), {});
  EXPECT_EQ(scene.fluid.fill.at(0).level, 2125.0);
  EXPECT_EQ(scene.slides.at(0).shape.uniform_thickness, 12.0);
}

TEST(DidYouMean, finds_the_near_and_leaves_the_far) {
  const std::vector<std::string> words{"density", "diameter", "kind", "box"};
  EXPECT_EQ(did_you_mean("denstiy", words), "density");
  EXPECT_EQ(did_you_mean("diamter", words), "diameter");
  EXPECT_EQ(did_you_mean("bx", words), "box");
  EXPECT_EQ(did_you_mean("temperature", words), "");
  EXPECT_EQ(did_you_mean("", words), "");
  EXPECT_EQ(did_you_mean("x", {}), "");
  EXPECT_EQ(did_you_mean(std::string(100000, 'x'), words), "");
}

TEST(EditDistance, hand_counted) {
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("abc", "abc"), 0u);
  EXPECT_EQ(edit_distance("abcd", "abdc"), 1u) << "neighbours swapped";
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

}  // namespace
}  // namespace gdesp::test
