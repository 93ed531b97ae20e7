// SPDX-License-Identifier: GPL-3.0-or-later
// What is written in a scene file arrives in the Scene, and a Scene written out reads back the same.
#include <filesystem>

#include "scene/scene_source.hpp"
#include "scene_fixture.hpp"

namespace gdesp::test {
namespace {

constexpr const char* everything = R"(
title = "every key"
dimensions = 3
gravity = [0.1, 0, -9.8]

[domain]
lower = [-1, -2, -3]
upper = [10.5, 20, 30]
periodic = ["y"]

[resolution]
dp = 0.25

[fluid]
density = 998.2
kinematic_viscosity = 1.1e-6
velocity_x = "0.5*z"
velocity_y = "x*y"
velocity_z = "0"

[[fluid.fill]]
level = 2.5
seed = [1, 2]
polygon = [[0, 0], [4, 0], [4, 4], [0, 4]]

[[fluid.fill]]
box = {lower = [0, 0, 0], upper = [1, 1, 0.5]}

[[fluid.fill]]
mesh = "solid.stl"

[terrain]
files = ["a.tif", "b.tif"]
scale = 0.001
vertical_scale = -1
vertical_offset = 12.5
crs = "EPSG:2193"
bathymetry = "depth.xyz"
bathymetry_crs = "EPSG:4167"
bathymetry_scale = -1
bathymetry_offset = 313.3
condition = "no-slip"

[[wall]]
name = "tank"
tank = {lower = [0, 0, 0], upper = [1, 1, 1]}
open = ["top", "x+"]
symmetry = ["y-"]

[[wall]]
mesh = "solid.stl"
mesh_size = 0.1
scale = 0.001
translate = [1, 2, 3]
condition = "no-slip"

[[slide]]
name = "upper"
surface_below = "a.tif"
surface_above = "b.tif"
density = 2700
diameter = 0.02
diameter_deviation = 0.001
real_diameter = 0.005
porosity = 0.4
seed = 7
relaxation = "gravity"
release_at = 1.5
velocity = [1, 0, -1]
[[slide.sieve]]
diameter = 0.01
mass_share = 0.25
[[slide.sieve]]
diameter = 0.02
mass_share = 0.75

[[slide]]
kind = "rigid"
polygon = [[0, 0], [1, 0], [1, 1]]
thickness = "a.tif"

[[slide]]
kind = "prescribed"
mesh = "solid.stl"
motion_csv = "motion.csv"

[[gate]]
box = {lower = [1, 0, 0], upper = [1.1, 1, 1]}
velocity = [0, 0, 0.68]
start = 0.5
stop = 2
remove_at = 3

[[piston]]
name = "paddle"
box = {lower = [1, 0, 0], upper = [1.1, 1, 1]}
motion_csv = "motion.csv"
condition = "no-slip"

[[body]]
mesh = "solid.stl"

[[floating]]
name = "barge"
box = {lower = [0, 0, 0], upper = [1, 1, 1]}
density = 600
velocity = [0.5, 0, 0]

[contact]
law = "linear"
youngs_modulus = 2e8
poisson_ratio = 0.25
stiffness = 900
stiffness_ratio = 0.5
restitution = 0.9
friction = 0.2
wall_friction = 0.1
rolling_friction = 0.05
cohesion = 0.01

[coupling]
enabled = false
drag = "ergun-wen-yu"
smoothing_length = 0.5
added_mass = 0.4

[numerics]
preset = "accurate"
smoothing_ratio = 1.5
sound_speed = 40
expected_speed = 4
time_scheme = "verlet"
walls = "dynamic"
viscosity = "none"
artificial_viscosity = 0.05
density_diffusion = 0.2
shifting = 0.3
tension = "kept"
cfl = 0.15
time_step = 1e-5
grain_time_step_share = 0.1
multirate = false
skin = 0.01

[time]
end = 12
output_interval = 0.5

[[gauge]]
name = "g"
at = [1, 2]

[[gauge]]
at = [1, 2, 3]

[[section]]
from = [0, 0]
to = [10, 5]

[[region]]
name = "left bank"
polygon = [[0, 0], [1, 0], [1, 1]]
)";

class SceneRead : public SceneTest {
 protected:
  void SetUp() override {
    for (const char* name : {"a.tif", "b.tif", "depth.xyz", "solid.stl", "motion.csv"}) folder.write(name, "x");
  }
};

TEST_F(SceneRead, every_general_key_arrives) {
  const Scene s = read(everything);
  EXPECT_EQ(s.title, "every key");
  EXPECT_EQ(s.gravity, (Vec3d{0.1, 0.0, -9.8}));
  ASSERT_TRUE(s.domain);
  EXPECT_EQ(s.domain->upper, (Vec3d{10.5, 20.0, 30.0}));
  EXPECT_EQ(s.periodic, std::vector<std::string>{"y"});
  EXPECT_EQ(s.dp, 0.25);
  EXPECT_EQ(s.time.end, 12.0);
  EXPECT_EQ(s.time.output_interval, 0.5);
  EXPECT_EQ(s.path, folder / "lake.toml");
}

TEST_F(SceneRead, fluid_and_terrain_arrive) {
  const Scene s = read(everything);
  EXPECT_EQ(s.fluid.density, 998.2);
  ASSERT_EQ(s.fluid.fill.size(), 3u);
  EXPECT_EQ(s.fluid.fill[0].kind, "level");
  EXPECT_EQ(s.fluid.fill[0].level, 2.5);
  ASSERT_TRUE(s.fluid.fill[0].seed);
  EXPECT_EQ(s.fluid.fill[0].seed->y, 2.0);
  EXPECT_EQ(s.fluid.fill[0].polygon.size(), 4u);
  EXPECT_EQ(s.fluid.fill[1].kind, "box") << "the kind follows from the keys given";
  EXPECT_EQ(s.fluid.fill[2].kind, "mesh");
  EXPECT_EQ(s.terrain.files, (std::vector<std::string>{folder / "a.tif", folder / "b.tif"}));
  EXPECT_EQ(s.terrain.vertical_scale, -1.0);
  EXPECT_EQ(s.terrain.bathymetry, folder / "depth.xyz");
  EXPECT_EQ(s.terrain.bathymetry_offset, 313.3);
  EXPECT_EQ(s.terrain.condition, "no-slip");
}

TEST_F(SceneRead, solids_arrive) {
  const Scene s = read(everything);
  ASSERT_EQ(s.walls.size(), 2u);
  EXPECT_EQ(s.walls[0].open, (std::vector<std::string>{"top", "x+"}));
  EXPECT_EQ(s.walls[0].symmetry, (std::vector<std::string>{"y-"}));
  EXPECT_EQ(s.walls[1].name, "wall2");
  EXPECT_EQ(s.walls[1].translate, (Vec3d{1.0, 2.0, 3.0}));
  ASSERT_EQ(s.slides.size(), 3u);
  EXPECT_EQ(s.slides[0].shape.surface_above, folder / "b.tif");
  EXPECT_EQ(s.slides[0].sieve.size(), 2u);
  EXPECT_EQ(s.slides[0].sieve[1].mass_share, 0.75);
  EXPECT_EQ(s.slides[0].seed, 7u);
  EXPECT_EQ(s.slides[1].kind, "rigid");
  EXPECT_EQ(s.slides[1].name, "slide2") << "unnamed slides are told apart";
  EXPECT_EQ(s.slides[2].motion_csv, folder / "motion.csv");
  ASSERT_EQ(s.moving.size(), 3u);
  EXPECT_EQ(s.moving[0].kind, "gate");
  EXPECT_EQ(s.moving[0].velocity, (Vec3d{0.0, 0.0, 0.68}));
  EXPECT_EQ(s.moving[1].kind, "piston");
  EXPECT_EQ(s.moving[2].kind, "body");
  EXPECT_EQ(s.moving[2].stop, 1e30) << "default";
  ASSERT_EQ(s.floating.size(), 1u);
  EXPECT_EQ(s.floating[0].density, 600.0);
}

TEST_F(SceneRead, models_arrive) {
  const Scene s = read(everything);
  EXPECT_EQ(s.contact.law, "linear");
  EXPECT_EQ(s.contact.youngs_modulus, 2e8);
  EXPECT_EQ(s.contact.cohesion, 0.01);
  EXPECT_FALSE(s.coupling.enabled);
  EXPECT_EQ(s.coupling.added_mass, 0.4);
  EXPECT_EQ(s.numerics.sound_speed, 40.0);
  EXPECT_EQ(s.numerics.time_step, 1e-5);
  EXPECT_FALSE(s.numerics.multirate);
}

TEST_F(SceneRead, places_arrive) {
  const Scene s = read(everything);
  ASSERT_EQ(s.gauges.size(), 2u);
  EXPECT_FALSE(s.gauges[0].has_z);
  EXPECT_TRUE(s.gauges[1].has_z);
  EXPECT_EQ(s.gauges[1].at.z, 3.0);
  EXPECT_EQ(s.gauges[1].name, "gauge2");
  EXPECT_EQ(s.sections.at(0).to.x, 10.0);
  EXPECT_EQ(s.regions.at(0).polygon.size(), 3u);
}

TEST_F(SceneRead, written_scene_reads_back_the_same) {
  const Scene first = read(everything);
  const std::string text = scene_to_toml(first);
  const Scene second = read_scene(folder.write("again.toml", text), {});
  EXPECT_EQ(scene_to_toml(second), text);
  EXPECT_EQ(second.slides[0].diameter_deviation, first.slides[0].diameter_deviation);
  EXPECT_EQ(second.moving.size(), first.moving.size());
  EXPECT_EQ(second.fluid.kinematic_viscosity, first.fluid.kinematic_viscosity);
}

TEST_F(SceneRead, written_scene_holds_every_key_that_was_given) {
  const std::string text = "\n" + scene_to_toml(read(everything));
  for (const SceneKey& key : scene_keys()) {
    if (key.key.ends_with("uniform_thickness")) continue;  // excluded by thickness
    const std::string name = key.key.substr(key.key.rfind('.') + 1);
    EXPECT_NE(text.find("\n" + name + " = "), std::string::npos) << key.key;
  }
}

TEST_F(SceneRead, numbers_survive_writing_to_the_last_bit) {
  Scene s = read("[resolution]\ndp = 1\n");
  s.dp = 0.1 + 0.2;
  s.gravity.z = -9.80665000000001;
  s.title = "quote \" backslash \\ tab \t line\nend";
  const Scene back = read_scene(folder.write("again.toml", scene_to_toml(s)), {});
  EXPECT_EQ(back.dp, s.dp);
  EXPECT_EQ(back.gravity.z, s.gravity.z);
  EXPECT_EQ(back.title, s.title);
}

TEST_F(SceneRead, smallest_scene_has_the_defaults) {
  const Scene s = read("[resolution]\ndp = 5\n");
  const Scene standard;
  EXPECT_EQ(s.dp, 5.0) << "a whole number is a number";
  EXPECT_EQ(s.numerics.time_scheme, standard.numerics.time_scheme);
  EXPECT_EQ(s.contact.youngs_modulus, standard.contact.youngs_modulus);
  EXPECT_FALSE(s.domain);
  EXPECT_TRUE(s.fluid.fill.empty());
}

TEST_F(SceneRead, paper_preset_sets_its_options_and_single_keys_win) {
  const Scene s = read("[resolution]\ndp = 5\n[numerics]\nartificial_viscosity = 0.07\npreset = \"paper\"\n");
  EXPECT_EQ(s.numerics.time_scheme, "verlet");
  EXPECT_EQ(s.numerics.walls, "dynamic");
  EXPECT_EQ(s.numerics.viscosity, "morris");
  EXPECT_EQ(s.numerics.smoothing_ratio, 1.3);
  EXPECT_EQ(s.numerics.density_diffusion, 0.0);
  EXPECT_FALSE(s.numerics.multirate);
  EXPECT_EQ(s.numerics.time_step, 0.0) << "fixed only when the user says so";
  EXPECT_EQ(s.coupling.drag, "ergun-wen-yu");
  EXPECT_EQ(s.coupling.added_mass, 0.0);
  EXPECT_EQ(s.numerics.artificial_viscosity, 0.07);
}

TEST_F(SceneRead, one_terrain_file_and_one_plain_table_will_do) {
  const Scene s =
      read("[resolution]\ndp = 5\n[terrain]\nfile = \"a.tif\"\n[slide]\nmesh = \"solid.stl\"\ndiameter = 1\n");
  EXPECT_EQ(s.terrain.files, std::vector<std::string>{folder / "a.tif"});
  EXPECT_EQ(s.slides.size(), 1u);
}

TEST_F(SceneRead, relative_paths_start_at_the_scene_file) {
  std::filesystem::create_directory(folder / "sub");
  folder.write("sub/s.toml", "[resolution]\ndp = 5\n[terrain]\nfile = \"../a.tif\"\n");
  EXPECT_EQ(read_scene(folder / "sub/s.toml", {}).terrain.files.at(0), folder / "a.tif");
}

/// The examples that come with the project are scenes.
TEST_F(SceneRead, examples_are_accepted) {
  namespace fs = std::filesystem;
  const fs::path cases = fs::path(GDESP_SOURCE_DIR) / "data/cases";
  int read_files = 0;
  if (fs::exists(cases))
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(cases)) {
      if (entry.path().extension() != ".toml" || entry.path().filename() == "validation.toml") continue;
      SceneReadOptions options;
      options.check_files = false;
      EXPECT_NO_THROW(read_scene(entry.path().string(), {}, options)) << entry.path();
      ++read_files;
    }
  if (read_files == 0) GTEST_SKIP() << "no scene files under data/cases";
}

}  // namespace
}  // namespace gdesp::test
