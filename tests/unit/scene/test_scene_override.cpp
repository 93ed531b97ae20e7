// SPDX-License-Identifier: GPL-3.0-or-later
// --set key=value over a scene file.
#include "scene_fixture.hpp"

namespace gdesp::test {
namespace {

class SceneOverride : public SceneTest {
 protected:
  void SetUp() override { folder.write("a.stl", "x"); }
  const std::string text =
      "[resolution]\ndp = 5\n"
      "[[slide]]\ndiameter = 1\nbox = {lower = [0,0,0], upper = [1,1,1]}\n"
      "[[slide]]\ndiameter = 2\nmesh = \"a.stl\"\n"
      "[[slide.sieve]]\ndiameter = 3\nmass_share = 1\n";
};

TEST_F(SceneOverride, plain_key) {
  EXPECT_EQ(read(text, {{"resolution.dp", "0.5"}}).dp, 0.5);
  EXPECT_EQ(read(text, {{"resolution.dp", "7"}}).dp, 7.0);
  EXPECT_EQ(read(text, {{"resolution.dp", "1"}, {"resolution.dp", "2"}}).dp, 2.0) << "the last one counts";
}

TEST_F(SceneOverride, key_in_a_table_that_the_file_lacks) {
  EXPECT_EQ(read(text, {{"time.end", "3"}}).time.end, 3.0);
  EXPECT_EQ(read("", {{"resolution.dp", "3"}}).dp, 3.0);
}

TEST_F(SceneOverride, element_of_an_array_of_tables) {
  const Scene first = read(text, {{"slide.diameter", "0.02"}});
  EXPECT_EQ(first.slides[0].diameter, 0.02);
  EXPECT_EQ(first.slides[1].diameter, 2.0);
  EXPECT_EQ(read(text, {{"slide.1.diameter", "0.02"}}).slides[1].diameter, 0.02);
  EXPECT_EQ(read(text, {{"slide.1.sieve.0.diameter", "9"}}).slides[1].sieve[0].diameter, 9.0);
  EXPECT_EQ(read(text, {{"slide.box.upper", "[2, 3, 4]"}}).slides[0].shape.box->upper.y, 3.0);
}

TEST_F(SceneOverride, values_are_toml_or_bare_words) {
  EXPECT_EQ(read(text, {{"numerics.preset", "paper"}}).numerics.walls, "dynamic");
  EXPECT_EQ(read(text, {{"numerics.preset", "\"paper\""}}).numerics.walls, "dynamic");
  EXPECT_EQ(read(text, {{"title", "two words"}}).title, "two words");
  EXPECT_EQ(read(text, {{"gravity", "[0, 0, -1]"}}).gravity.z, -1.0);
  EXPECT_EQ(read(text, {{"coupling.enabled", "false"}}).coupling.enabled, false);
  EXPECT_EQ(read(text, {{"gauge", "[{name = \"g\", at = [1, 2]}]"}}).gauges.at(0).name, "g");
  EXPECT_EQ(read(text, {{"terrain.file", "a.stl"}}).terrain.files.at(0), folder / "a.stl");
}

TEST_F(SceneOverride, a_terrain_file_replaces_those_of_the_scene) {
  folder.write("b.tif", "x");
  const std::string with = text + "[terrain]\nfiles = [\"a.stl\", \"b.tif\"]\n";
  EXPECT_EQ(read(with, {{"terrain.file", "b.tif"}}).terrain.files, std::vector<std::string>{folder / "b.tif"});
}

TEST_F(SceneOverride, mistakes_name_the_option) {
  EXPECT_TRUE(mentions(refusal(text, {{"title", "\xff\xfe"}}), {"--set title", "not a TOML value"}))
      << "bytes that are no UTF-8";
  EXPECT_TRUE(mentions(refusal(text, {{"resolution.dp", "-5"}}), {"--set resolution.dp=-5", "above 0.0"}));
  EXPECT_TRUE(mentions(refusal(text, {{"resolution.pd", "5"}}),
                       {"--set resolution.pd=5", "unknown key", "did you mean \"resolution.dp\"?"}));
  EXPECT_TRUE(mentions(refusal(text, {{"slde.diameter", "5"}}), {"--set slde.diameter=5", "did you mean \"slide\"?"}));
  EXPECT_TRUE(mentions(refusal(text, {{"dp", "5"}}), {"did you mean \"resolution.dp\"?"}));
  EXPECT_TRUE(mentions(refusal(text, {{"slide.2.diameter", "5"}}), {"2 [[slide]]", "numbered from 0"}));
  EXPECT_TRUE(mentions(refusal(text, {{"gate.start", "5"}}), {"no [[gate]]"}));
  EXPECT_TRUE(mentions(refusal(text, {{"gravity", "[0, 0"}}), {"--set gravity=[0, 0", "not a TOML value"}));
  EXPECT_TRUE(mentions(refusal(text, {{"title", ""}}), {"expected a value"}));
  EXPECT_TRUE(mentions(refusal(text, {{"title", "a\nb = 3"}}), {"on one line"}));
  EXPECT_TRUE(mentions(refusal(text, {{"slide.0", "5"}}, ErrorKind::usage), {"names a table"}));
  EXPECT_TRUE(mentions(refusal(text, {{"resolution..dp", "5"}}, ErrorKind::usage), {"KEY=VALUE"}));
}

}  // namespace
}  // namespace gdesp::test
