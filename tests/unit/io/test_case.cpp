// SPDX-License-Identifier: GPL-3.0-or-later
// A case written and read back; cases that are not what they should be.
#include <cmath>

#include "io/point_source.hpp"
#include "io/tables.hpp"
#include "io_fixture.hpp"

namespace gdesp::test {
namespace {

class CaseTest : public ::testing::Test {
 protected:
  TempFolder folder;
  std::string path = folder / "lake.case";

  Case some_case() {
    Case c;
    c.scene = read_scene(folder.write("lake.toml", R"(
[resolution]
dp = 0.5
[[slide]]
box = {lower = [0, 0, 0], upper = [1, 1, 1]}
diameter = 0.1
[[slide]]
box = {lower = [2, 0, 0], upper = [3, 1, 1]}
diameter = 0.1
[[gauge]]
at = [1, 2]
)"),
                         {});
    c.offset = {5e6, 1e5, 1953.25};
    c.domain = {{-1, -1, -1}, {1e7, 1e7, 1e3}};
    c.still_water_level = 0.1 + 0.2;
    c.terrain_top = 500.5;
    c.fluid = some_fluid(100);
    c.grains = some_grains(40);
    c.walls = some_triangles();
    c.boundary.position = {{1, 2, 3}, {4, 5, 6}};
    c.boundary.normal = {{0, 0, 1}, {0, 1, 0}};
    c.boundary.depth = {0.25f, 0.75f};
    c.boundary.body = {0, 2};
    c.bodies = {gate(), box()};
    c.sources = {{"/data/valley.tif", std::string(64, 'a')}, {"/data/\"odd\".stl", std::string(64, 'b')}};
    return c;
  }

  static Body gate() {
    Body b;
    b.name = "gate1";
    b.motion.time = {0.0, 0.1, 2.5};
    b.motion.displacement = {{0, 0, 0}, {0, 0, 0.068}, {0, 0, 1.7}};
    b.motion.remove_at = 3.0;
    return b;
  }
  static Body box() {
    Body b;
    b.name = "box \"one\"";
    b.kind = BodyKind::free;
    b.mass = 12.5;
    b.centre = {1, 2, 3};
    b.velocity = {0.1, 0.2, 0.3};
    b.angular_velocity = {1e-9, 0, 1e9};
    for (int i = 0; i < 9; ++i) b.inertia[i] = 0.1 * i;
    return b;
  }

  void refused(const std::vector<std::string>& parts, const std::vector<Override>& overrides = {}) {
    expect_error(ErrorKind::input, parts, [&] { read_case(path, overrides); });
  }
  /// Replaces text in the case's case.toml; the text must be there.
  void edit(const std::string& from, const std::string& to) {
    std::string text = text_of_file(path + "/case.toml");
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    folder.write("lake.case/case.toml", text);
  }
};

TEST_F(CaseTest, particles_come_back) {
  const Case c = some_case();
  write_case(path, c, false);
  const Case back = read_case(path);
  expect_same(back.fluid, c.fluid);
  expect_same(back.grains, c.grains);
  expect_same(back.walls, c.walls);
  EXPECT_TRUE(back.boundary.position == c.boundary.position);
  EXPECT_TRUE(back.boundary.normal == c.boundary.normal);
  EXPECT_TRUE(back.boundary.depth == c.boundary.depth);
  EXPECT_TRUE(back.boundary.body == c.boundary.body);
}

TEST_F(CaseTest, smooth_walls_come_back) {
  Case c = some_case();
  c.walls.smooth.assign(c.walls.triangle.size(), 0);
  c.walls.smooth[0] = 1;
  write_case(path, c, false);
  EXPECT_TRUE(read_case(path).walls.smooth == c.walls.smooth);
  EXPECT_TRUE(open_with_vtk(path + "/walls.vtp")->triangles().smooth == c.walls.smooth);
}

TEST_F(CaseTest, scene_and_frame_of_reference_come_back) {
  const Case c = some_case();
  write_case(path, c, false);
  const Case back = read_case(path);
  EXPECT_EQ(scene_to_toml(back.scene), scene_to_toml(c.scene));
  EXPECT_EQ(back.scene.path, c.scene.path);
  EXPECT_EQ(back.offset, c.offset);
  EXPECT_EQ(back.domain.lower, c.domain.lower);
  EXPECT_EQ(back.domain.upper, c.domain.upper);
  EXPECT_EQ(back.still_water_level, c.still_water_level);
  EXPECT_EQ(back.terrain_top, c.terrain_top);
  ASSERT_EQ(back.sources.size(), 2u);
  EXPECT_EQ(back.sources[1].path, "/data/\"odd\".stl");
  EXPECT_EQ(back.sources[1].sha256, std::string(64, 'b'));
}

TEST_F(CaseTest, bodies_come_back) {
  write_case(path, some_case(), false);
  const Case back = read_case(path);
  ASSERT_EQ(back.bodies.size(), 2u);
  const Body &g = back.bodies[0], &b = back.bodies[1];
  EXPECT_EQ(g.name, "gate1");
  EXPECT_EQ(g.kind, BodyKind::prescribed);
  EXPECT_EQ(g.motion.time, gate().motion.time);
  EXPECT_TRUE(g.motion.displacement == gate().motion.displacement);
  EXPECT_EQ(g.motion.remove_at, 3.0);
  EXPECT_EQ(b.name, "box \"one\"");
  EXPECT_EQ(b.kind, BodyKind::free);
  EXPECT_EQ(b.mass, 12.5);
  EXPECT_EQ(b.centre, box().centre);
  EXPECT_EQ(b.velocity, box().velocity);
  EXPECT_EQ(b.angular_velocity, box().angular_velocity);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(b.inertia[i], box().inertia[i]);
}

TEST_F(CaseTest, a_far_lake_comes_back) {
  Case c = some_case();
  c.bodies[0].kind = BodyKind::far_lake;
  c.bodies[0].motion = {};
  c.bodies[0].far_lake = {80.0, 1.25, 3.0, 400, -1.0, 7.5, 0.1};
  write_case(path, c, false);
  const Body b = read_case(path).bodies[0];
  EXPECT_EQ(b.kind, BodyKind::far_lake);
  EXPECT_EQ(b.far_lake.length, 80.0);
  EXPECT_EQ(b.far_lake.depth, 1.25);
  EXPECT_EQ(b.far_lake.width, 3.0);
  EXPECT_EQ(b.far_lake.columns, 400);
  EXPECT_EQ(b.far_lake.side, -1.0);
  EXPECT_EQ(b.far_lake.wall, 7.5);
  EXPECT_EQ(b.far_lake.level, 0.1);
  edit("columns = 400", "columns = 1");
  refused({"case.body.0.far_lake.columns", "from 2"});
  edit("columns = 1", "columns = 2");
  edit("depth = 1.25", "depth = 0.0");
  refused({"case.body.0.far_lake.depth", "above 0"});
}

TEST_F(CaseTest, case_without_grains_and_walls) {
  Case c = some_case();
  c.grains = {};
  c.walls = {};
  c.bodies.clear();
  c.boundary.body.clear();
  c.still_water_level = std::nan("");
  write_case(path, c, false);
  EXPECT_FALSE(std::filesystem::exists(path + "/grains.vtp"));
  const Case back = read_case(path);
  EXPECT_TRUE(back.grains.position.empty());
  EXPECT_TRUE(back.walls.triangle.empty());
  EXPECT_TRUE(back.boundary.body.empty());
  EXPECT_EQ(back.still_water_level, 0.0);
}

TEST_F(CaseTest, bodies_file_holds_the_moving_triangles_alone) {
  write_case(path, some_case(), false);
  const TriangleTable bodies = read_triangles_vtp(path + "/bodies.vtp");
  ASSERT_EQ(bodies.triangle.size(), 1u);
  EXPECT_EQ(bodies.vertex.size(), 3u);
  EXPECT_EQ(bodies.vertex[std::size_t(bodies.triangle[0].x)], (Vec3d{5, 5, 5}));
}

TEST_F(CaseTest, extra_files_move_in) {
  const std::string grid = folder.write("boundary.vdb", "grid");
  write_case(path, some_case(), false, {grid});
  EXPECT_EQ(text_of_file(path + "/boundary.vdb"), "grid");
  EXPECT_FALSE(std::filesystem::exists(grid));
}

TEST_F(CaseTest, existing_output_stays_unless_forced) {
  Case c = some_case();
  write_case(path, c, false);
  c.fluid = some_fluid(3);
  expect_error(ErrorKind::usage, {"lake.case", "--force"}, [&] { write_case(path, c, false); });
  EXPECT_EQ(read_case(path).fluid.position.size(), 100u);
  write_case(path + "/", c, true);
  EXPECT_EQ(read_case(path).fluid.position.size(), 3u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2) << "no scraps";
}

TEST_F(CaseTest, what_is_no_case_is_not_replaced_even_by_force) {
  std::filesystem::create_directory(path);
  folder.write("lake.case/thesis.txt", "precious");
  expect_error(ErrorKind::usage, {"no case"}, [&] { write_case(path, some_case(), true); });
  EXPECT_EQ(text_of_file(path + "/thesis.txt"), "precious");
  expect_error(ErrorKind::usage, {"is a file"}, [&] { write_case(path + "/thesis.txt", some_case(), true); });
}

TEST_F(CaseTest, folder_that_cannot_be_made) {
  folder.write("file", "x");
  expect_error(ErrorKind::resource, {"file/lake.case"},
               [&] { write_case(folder / "file/lake.case", some_case(), false); });
}

TEST_F(CaseTest, free_overrides_change_the_scene) {
  write_case(path, some_case(), false);
  const Case c = read_case(path, {{"time.end", "7"},
                                  {"numerics.cfl", "0.1"},
                                  {"contact.friction", "0.3"},
                                  {"coupling.enabled", "false"},
                                  {"fluid.kinematic_viscosity", "1e-3"}});
  EXPECT_EQ(c.scene.time.end, 7.0);
  EXPECT_EQ(c.scene.numerics.cfl, 0.1);
  EXPECT_EQ(c.scene.contact.friction, 0.3);
  EXPECT_FALSE(c.scene.coupling.enabled);
  EXPECT_EQ(c.scene.fluid.kinematic_viscosity, 1e-3);
}

TEST_F(CaseTest, overrides_that_need_other_particles_are_refused) {
  write_case(path, some_case(), false);
  refused({"--set resolution.dp", "mesh2particles"}, {{"resolution.dp", "1"}});
  refused({"slide.diameter"}, {{"slide.diameter", "1"}});
  refused({"fluid.density"}, {{"fluid.density", "1"}});
  refused({"did you mean \"time.end\""}, {{"time.ende", "1"}});
}

/// A case holds every key with its value; another preset must still bring its own values in.
TEST_F(CaseTest, preset_can_be_changed_when_the_case_is_read) {
  Case c = some_case();
  c.scene.numerics.artificial_viscosity = 0.07;
  write_case(path, c, false);
  const Case paper = read_case(path, {{"numerics.preset", "paper"}});
  EXPECT_EQ(paper.scene.numerics.walls, "dynamic");
  EXPECT_EQ(paper.scene.numerics.viscosity, "morris");
  EXPECT_EQ(paper.scene.coupling.drag, "ergun-wen-yu");
  EXPECT_FALSE(paper.scene.numerics.multirate);
  EXPECT_EQ(paper.scene.numerics.artificial_viscosity, 0.07) << "given by the user";
  EXPECT_EQ(read_case(path, {{"numerics.preset", "paper"}, {"numerics.walls", "extrapolated"}}).scene.numerics.walls,
            "extrapolated");
  EXPECT_EQ(read_case(path).scene.numerics.walls, "extrapolated");
}

/// Whatever the presets set: reading the case with another preset is reading its scene with that preset.
TEST_F(CaseTest, another_preset_leaves_nothing_of_the_old_one) {
  const std::string scene = folder.write("plain.toml", "[resolution]\ndp = 1\n");
  for (const char* made_with : {"accurate", "paper"})
    for (const char* read_with : {"accurate", "paper"}) {
      Case c;
      c.scene = read_scene(scene, {{"numerics.preset", made_with}});
      c.domain = {{0, 0, 0}, {1, 1, 1}};
      write_case(path, c, true);
      EXPECT_EQ(scene_to_toml(read_case(path, {{"numerics.preset", read_with}}).scene),
                scene_to_toml(read_scene(scene, {{"numerics.preset", read_with}})))
          << made_with << " read as " << read_with;
    }
}

TEST_F(CaseTest, what_is_no_case_is_refused) {
  refused({"lake.case", "no such case"});
  std::filesystem::create_directory(path);
  refused({"lake.case", "no case.toml"});
  folder.write("lake.case/case.toml", "[resolution]\ndp = 1\n");
  refused({"case.toml", "no [case] table"});
  path = folder.write("file.case", "x");
  refused({"is a file"});
}

TEST_F(CaseTest, missing_or_exchanged_part_is_refused) {
  write_case(path, some_case(), false);
  std::filesystem::rename(path + "/fluid.vtp", path + "/moved.vtp");
  refused({"fluid.vtp", "no such file"});
  write_fluid(path + "/fluid.vtp", some_fluid(99), {});
  refused({"fluid.vtp", "holds 99 particles", "case.toml says 100"});
  std::filesystem::rename(path + "/moved.vtp", path + "/fluid.vtp");
  EXPECT_NO_THROW(read_case(path));
  std::filesystem::copy_file(path + "/fluid.vtp", path + "/grains.vtp",
                             std::filesystem::copy_options::overwrite_existing);
  refused({"grains.vtp", "diameter"});
}

TEST_F(CaseTest, values_out_of_range_are_refused) {
  Case c = some_case();
  const auto broken = [&](auto change, const std::vector<std::string>& parts) {
    Case copy = c;
    change(copy);
    write_case(path, copy, true);
    refused(parts);
  };
  broken([](Case& k) { k.fluid.velocity[5].z = INFINITY; }, {"fluid.vtp", "velocity of point 5", "not finite"});
  broken([](Case& k) { k.grains.diameter[3] = 0.0f; }, {"grains.vtp", "diameter of grain 3", "above 0"});
  broken([](Case& k) { k.grains.density[3] = NAN; }, {"grains.vtp", "density of point 3"});
  broken([](Case& k) { k.grains.group[3] = 9; }, {"grain 3", "slide 9 of 2"});
  broken([](Case& k) { k.boundary.body[1] = 3; }, {"boundary.vtp", "body 3", "0 to 2"});
  broken([](Case& k) { k.walls.body[1] = -1; }, {"walls.vtp", "body -1"});
  broken([](Case& k) { k.walls.triangle[1].y = 7; }, {"walls.vtp", "vertex 7 of 7"});
  broken([](Case& k) { std::swap(k.domain.lower, k.domain.upper); }, {"case.domain"});
  broken([](Case& k) { k.bodies[1].mass = 0.0; }, {"case.body.1.mass", "above 0"});
  broken([](Case& k) { k.bodies[0].motion.time[2] = 0.1; }, {"case.body.0.motion", "increase"});
}

TEST_F(CaseTest, edited_case_table_is_refused) {
  write_case(path, some_case(), false);
  const std::string sound = text_of_file(path + "/case.toml");
  const auto edited = [&](const std::string& from, const std::string& to, const std::vector<std::string>& parts) {
    folder.write("lake.case/case.toml", sound);
    edit(from, to);
    refused(parts);
  };
  edited("format = 1", "format = 99", {"case.format", "another version"});
  edited("offset = [", "offset = [1.0, ", {"case.offset", "3 finite numbers"});
  edited("still_water_level = ", "still_water_level = nan #", {"case.still_water_level", "finite"});
  edited("fluid = 100", "fluid = 99999999999999", {"fluid.vtp", "holds 100", "99999999999999"});
  edited("fluid = 100", "fluid = -1", {"case.counts.fluid"});
  edited("kind = \"free\"", "kind = \"frei\"", {"case.body.1.kind", "\"free\", \"prescribed\" or \"far-lake\""});
  edited("[case]", "[cose]", {"cose", "unknown key"});
}

}  // namespace
}  // namespace gdesp::test
