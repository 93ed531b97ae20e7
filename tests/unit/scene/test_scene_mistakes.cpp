// SPDX-License-Identifier: GPL-3.0-or-later
// Mistakes in a scene file: each refused with a message that names file, line, key, what was found and what is valid.
#include <filesystem>

#include "scene_fixture.hpp"

namespace gdesp::test {
namespace {

class SceneMistakes : public SceneTest {
 protected:
  const std::string dp = "[resolution]\ndp = 5\n";  // lines 1 and 2
};

TEST_F(SceneMistakes, missing_file) {
  try {
    read_scene(folder / "nothing.toml", {});
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_TRUE(mentions(error.what(), {"nothing.toml", "no such file"}));
  }
  EXPECT_THROW(read_scene(folder.path(), {}), Error) << "a folder";
}

TEST_F(SceneMistakes, not_toml) {
  EXPECT_TRUE(mentions(refusal(dp + "title = \"open\n"), {"lake.toml:3", "not TOML"}));
  EXPECT_TRUE(mentions(refusal(dp + "dp = 6\n"), {"lake.toml:3"})) << "a key twice";
  EXPECT_TRUE(mentions(refusal(std::string("\xff\xfe\0\1", 4)), {"lake.toml:1", "not TOML"}));
  refusal(dp + "title = " + std::string(5000, '['));
}

TEST_F(SceneMistakes, required_key) {
  EXPECT_TRUE(mentions(refusal("title = \"x\"\n"), {"lake.toml", "resolution.dp", "required", "(m)"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[gauge]]\nname = \"g\"\n"), {"lake.toml:3", "gauge.0.at", "required"}));
}

TEST_F(SceneMistakes, unknown_key_with_suggestion) {
  EXPECT_TRUE(mentions(refusal(dp + "[fluid]\ndenstiy = 3\n"),
                       {"lake.toml:4", "unknown key \"fluid.denstiy\"", "did you mean \"fluid.density\"?"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[slides]]\n"), {"lake.toml:3", "did you mean \"slide\"?"}));
  EXPECT_TRUE(mentions(refusal("dp = 5\n"), {"lake.toml:1", "did you mean \"resolution.dp\"?"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[slide]]\nporsity = 0.4\n"), {"lake.toml:4", "slide.porosity"}));
  EXPECT_TRUE(mentions(refusal(dp + "[time]\nzzzzzz = 1\n"), {"valid here: end, output_interval"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[wall]]\ntank = {lower = [0,0,0], upper = [1,1,1], top = 3}\n"),
                       {"lake.toml:4", "wall.0.tank.top", "unknown key"}));
}

TEST_F(SceneMistakes, planes_of_symmetry) {
  const std::string tank = dp + "[[wall]]\ntank = {lower = [0,0,0], upper = [1,1,1]}\n";
  folder.write("a.stl", "solid");
  EXPECT_TRUE(mentions(refusal(dp + "[[wall]]\nmesh = \"a.stl\"\nsymmetry = [\"y+\"]\n"),
                       {"lake.toml:5", "wall.0.symmetry", "only with tank"}));
  EXPECT_TRUE(mentions(refusal(tank + "open = [\"y+\"]\nsymmetry = [\"y+\"]\n"), {"wall.0.symmetry", "left out"}));
  EXPECT_TRUE(mentions(refusal(tank + "symmetry = [\"left\"]\n"), {"wall.0.symmetry", "x-"}));
}

TEST_F(SceneMistakes, wrong_type) {
  EXPECT_TRUE(mentions(refusal("[resolution]\ndp = \"five\"\n"),
                       {"lake.toml:2", "resolution.dp", "'five'", "a number", "(m)"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[slide]]\nseed = 1.5\n"), {"lake.toml:4", "slide.0.seed", "whole number"}));
  EXPECT_TRUE(mentions(refusal(dp + "[coupling]\nenabled = 1\n"), {"coupling.enabled", "true or false"}));
  EXPECT_TRUE(mentions(refusal("gravity = [0, -9.81]\n" + dp), {"gravity", "[x, y, z]", "(m/s2)"}));
  EXPECT_TRUE(mentions(refusal("gravity = -9.81\n" + dp), {"gravity", "found -9.81"}));
  EXPECT_TRUE(mentions(refusal("title = 3\n" + dp), {"title", "text in quotes"}));
  EXPECT_TRUE(mentions(refusal("fluid = 3\n" + dp), {"fluid", "a table [fluid]"}));
  EXPECT_TRUE(mentions(refusal("slide = [1, 2]\n" + dp), {"slide.0", "[[slide]]"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[region]]\npolygon = [1, 2, 3]\n"), {"region.0.polygon", "[x, y]"}));
  EXPECT_TRUE(mentions(refusal(dp + "[terrain]\nfiles = \"a\"\n"), {"terrain.files", "a list of paths"}));
}

TEST_F(SceneMistakes, out_of_range) {
  EXPECT_TRUE(mentions(refusal("[resolution]\ndp = 0\n"), {"resolution.dp", "found 0", "above 0.0", "(m)"}));
  EXPECT_TRUE(mentions(refusal("[resolution]\ndp = -1\n"), {"found -1"}));
  EXPECT_TRUE(mentions(refusal("[resolution]\ndp = nan\n"), {"found nan", "finite"}));
  EXPECT_TRUE(mentions(refusal("[resolution]\ndp = inf\n"), {"found inf", "finite"}));
  EXPECT_TRUE(mentions(refusal("dimensions = 4\n" + dp), {"dimensions", "from 2 to 3"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[slide]]\nporosity = 1.5\n"), {"porosity", "at least 0.0 and at most 1.0"}));
  EXPECT_TRUE(mentions(refusal(dp + "[contact]\nrestitution = 0\n"), {"contact.restitution", "above 0.0"}));
  EXPECT_TRUE(mentions(refusal("gravity = [0, 0, inf]\n" + dp), {"gravity", "finite"}));
  EXPECT_TRUE(mentions(refusal(dp + "[terrain]\nvertical_scale = 0\n"), {"lake.toml:4", "terrain.vertical_scale"}));
  EXPECT_TRUE(mentions(refusal(dp + "[time]\nend = 1\noutput_interval = 2\n"), {"lake.toml:5", "output_interval"}));
}

TEST_F(SceneMistakes, word_that_is_no_choice) {
  EXPECT_TRUE(mentions(refusal(dp + "[numerics]\npreset = \"papr\"\n"),
                       {"lake.toml:4", "numerics.preset", "'papr'", "accurate, paper", "did you mean \"paper\"?"}));
  EXPECT_TRUE(mentions(refusal(dp + "[domain]\nperiodic = [\"w\"]\n"), {"domain.periodic", "'w'", "x, y, z"}));
}

TEST_F(SceneMistakes, missing_input_file) {
  EXPECT_TRUE(mentions(refusal(dp + "[terrain]\nfile = \"no.tif\"\n"),
                       {"lake.toml:4", "terrain.file", "there is no file", folder / "no.tif"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[slide]]\nmesh = \"no.stl\"\n"), {"slide.0.mesh", "no.stl"}));
  EXPECT_TRUE(mentions(refusal(dp + "[terrain]\nfile = \"a\\u0000b\"\n"), {"NUL"}));
}

TEST_F(SceneMistakes, shapes) {
  const std::string slide = dp + "[[slide]]\ndiameter = 1\n";
  folder.write("a.stl", "x");
  EXPECT_TRUE(mentions(refusal(slide), {"lake.toml:3", "slide.0", "no shape", "box"}));
  EXPECT_TRUE(mentions(refusal(slide + "mesh = \"a.stl\"\nbox = {lower = [0,0,0], upper = [1,1,1]}\n"),
                       {"more than one shape"}));
  EXPECT_TRUE(mentions(refusal(slide + "box = {lower = [0,0,2], upper = [1,1,1]}\n"), {"lower.z", "not below"}));
  EXPECT_TRUE(mentions(refusal(slide + "box = {lower = [0,0,2]}\n"), {"upper"}));
  EXPECT_TRUE(mentions(refusal(slide + "surface_below = \"a.stl\"\n"), {"surface_above", "missing"}));
  EXPECT_TRUE(mentions(refusal(slide + "polygon = [[0,0],[1,0],[1,1]]\n"), {"thickness", "uniform_thickness"}));
  EXPECT_TRUE(mentions(refusal(slide + "polygon = [[0,0],[1,0]]\nuniform_thickness = 1\n"), {"at least 3"}));
  EXPECT_TRUE(mentions(refusal(slide + "mesh = \"a.stl\"\nuniform_thickness = 1\n"), {"without polygon"}));
}

TEST_F(SceneMistakes, in_two_dimensions_a_box_needs_no_width) {
  const std::string flat = "dimensions = 2\n" + dp + "[[wall]]\ntank = {lower = [0,0,0], upper = [1,0,1]}\n";
  EXPECT_NO_THROW(read(flat));
  EXPECT_TRUE(mentions(refusal("dimensions = 3\n" + flat.substr(15)), {"lower.y", "not below"}));
  EXPECT_TRUE(mentions(refusal(flat + "[domain]\nperiodic = [\"y\"]\n"), {"domain.periodic", "no meaning"}));
}

TEST_F(SceneMistakes, keys_that_do_not_go_together) {
  const std::string box = "box = {lower = [0,0,0], upper = [1,1,1]}\n";
  folder.write("m.csv", "x");
  EXPECT_TRUE(mentions(refusal(dp + "[[slide]]\n" + box), {"slide.0", "needs diameter"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[slide]]\ndiameter = 1\ndiameter_deviation = 0.5\n" + box), {"a third"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[slide]]\ndiameter = 1\ndiameter_half_width = 1\n" + box), {"below diameter"}));
  EXPECT_TRUE(
      mentions(refusal(dp + "[[slide]]\ndiameter = 1\ndiameter_deviation = 0.1\ndiameter_half_width = 0.2\n" + box),
               {"give one of them"}));
  EXPECT_TRUE(
      mentions(refusal(dp + "[[slide]]\ndiameter = 1\nrelaxation = \"gravty\"\n" + box), {"in-place, gravity"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[slide]]\ndiameter = 1\nporosity = 0.05\n" + box), {"0.2 to 0.95"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[slide]]\nkind = \"prescribed\"\n" + box), {"needs motion_csv"}));
  EXPECT_TRUE(
      mentions(refusal(dp + "[[slide]]\nkind = \"rigid\"\nmotion_csv = \"m.csv\"\n" + box), {"only with kind"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[gate]]\nvelocity = [0,0,1]\nmotion_csv = \"m.csv\"\n" + box), {"either"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[gate]]\nstart = 2\nstop = 1\n" + box), {"gate.0.stop", "before start"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[fluid.fill]]\n"), {"fluid.fill.0", "needs level"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[fluid.fill]]\nkind = \"box\"\n"), {"needs box"}));
  EXPECT_TRUE(
      mentions(refusal(dp + "[[fluid.fill]]\nkind = \"level\"\nlevel = 1\n" + box), {"only with kind \"box\""}));
  EXPECT_TRUE(mentions(refusal(dp + "[[fluid.fill]]\nseed = [0,0]\n" + box), {"only for kind \"level\""}));
  EXPECT_TRUE(mentions(refusal(dp + "[[wall]]\n"), {"wall.0", "exactly one of"}));
  EXPECT_TRUE(mentions(refusal(dp + "[domain]\nlower = [0,0,0]\n"), {"domain", "upper is missing"}));
}

TEST_F(SceneMistakes, far_lake) {
  const std::string box = "box = {lower = [0,0,0], upper = [1,1,1]}\n", piston = dp + "[[piston]]\n",
                    lake = "far_lake = {length = 80, depth = 1}\n";
  const Scene scene = read(piston + box + "far_lake = {length = 80, depth = 1, columns = 50, side = \"x-\"}\n");
  EXPECT_EQ(scene.moving[0].far_lake.length, 80.0);
  EXPECT_EQ(scene.moving[0].far_lake.columns, 50u);
  EXPECT_EQ(scene.moving[0].far_lake.side, "x-");
  EXPECT_EQ(read(scene_to_toml(scene)).moving[0].far_lake.depth, 1.0);
  EXPECT_EQ(read(scene_to_toml(read(piston + box))).moving[0].far_lake.length, 0.0);
  EXPECT_TRUE(mentions(refusal(piston + box + "far_lake = {length = 80}\n"),
                       {"lake.toml:5", "piston.0.far_lake", "depth > 0"}));
  EXPECT_TRUE(mentions(refusal(piston + box + "far_lake = {length = 80, depth = 1, columns = 1}\n"),
                       {"piston.0.far_lake.columns", "at least 2"}));
  EXPECT_TRUE(mentions(refusal(piston + box + "far_lake = {length = -80, depth = 1}\n"),
                       {"piston.0.far_lake.length", "at least 0"}));
  EXPECT_TRUE(mentions(refusal(piston + box + "far_lake = {lenght = 80, depth = 1}\n"), {"did you mean", "length"}));
  EXPECT_TRUE(mentions(refusal(piston + box + lake + "velocity = [1,0,0]\n"), {"piston.0", "no wave, velocity"}));
  EXPECT_TRUE(mentions(refusal(piston + box + lake + "wave = {kind = \"solitary\", height = 0.1, depth = 1}\n"),
                       {"piston.0", "no wave, velocity"}));
  EXPECT_TRUE(mentions(refusal("gravity = [1, 0, -9.81]\n" + piston + box + lake), {"gravity along -z"}));
  EXPECT_TRUE(mentions(refusal(piston + box + lake + "[domain]\nperiodic = [\"x\"]\n"), {"periodic along x"}));
  folder.write("a.stl", "x");
  EXPECT_TRUE(mentions(refusal(piston + lake + "mesh = \"a.stl\"\n"), {"piston.0", "a box"}));
  EXPECT_TRUE(mentions(refusal(dp + "[[gate]]\n" + box + lake), {"unknown key", "far_lake"}));
}

TEST_F(SceneMistakes, names) {
  const std::string g = "[[gauge]]\nat = [0, 0]\nname = ";
  EXPECT_TRUE(mentions(refusal(dp + g + "\"a\"\n" + g + "\"a\"\n"), {"lake.toml:8", "gauge.1.name", "used twice"}));
  EXPECT_TRUE(mentions(refusal(dp + g + "\"../../etc\"\n"), {"gauge.0.name", "no '/'"}));
  EXPECT_TRUE(mentions(refusal(dp + g + "\"" + std::string(65, 'a') + "\"\n"), {"64"}));
}

}  // namespace
}  // namespace gdesp::test
