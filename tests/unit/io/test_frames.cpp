// SPDX-License-Identifier: GPL-3.0-or-later
// Frames of a run: written, listed, read, gone on with.
#include "io/run_folder.hpp"
#include "io_fixture.hpp"

namespace gdesp::test {
namespace {

class FramesTest : public ::testing::Test {
 protected:
  TempFolder folder;
  std::string run = folder / "lake.run";

  static Frame some_frame(double time, std::int64_t step) {
    Frame f;
    f.time = time;
    f.step = step;
    f.fluid = some_fluid(20);
    f.grains = some_grains(10);
    f.bodies = some_triangles();
    f.body_states = {{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {0.5, 0.5, -0.5, 0.5}, {}, {}},
                     {{-1, 0, 1e6}, {}, {}, {1, 0, 0, 0}, {}, {}}};
    return f;
  }
  FrameWriter writer(bool force = false, bool resume = false) { return {run, {5e5, 5e6, 1}, 0.25, force, resume}; }
};

TEST_F(FramesTest, come_back) {
  FrameWriter out = writer();
  const Frame frame = some_frame(0.1, 12345678901);
  const FramePaths paths = out.write(frame);
  EXPECT_EQ(paths.fluid, run + "/frames/fluid_00000.vtp");
  FrameMeta meta;
  expect_same(read_fluid_frame(paths.fluid, {}, &meta), frame.fluid);
  EXPECT_TRUE(meta.has_time);
  EXPECT_EQ(meta.time, 0.1);
  EXPECT_EQ(meta.dp, 0.25);
  EXPECT_EQ(meta.offset, (Vec3d{5e5, 5e6, 1}));
  expect_same(read_grain_frame(paths.grains, {}, &meta), frame.grains);
  expect_same(read_triangles_vtp(paths.bodies), frame.bodies);
}

TEST_F(FramesTest, body_states_come_back) {
  const Frame frame = some_frame(0.1, 1);
  FrameWriter out = writer();
  const std::vector<BodyState> states = read_body_states(out.write(frame).bodies);
  ASSERT_EQ(states.size(), 2u);
  EXPECT_EQ(states[0].centre, frame.body_states[0].centre);
  EXPECT_EQ(states[0].velocity, frame.body_states[0].velocity);
  EXPECT_EQ(states[0].angular_velocity, frame.body_states[0].angular_velocity);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(states[0].orientation[i], frame.body_states[0].orientation[i]);
  EXPECT_EQ(states[1].centre.z, 1e6);
}

TEST_F(FramesTest, are_listed_in_time_order_while_the_run_goes_on) {
  FrameWriter out = writer();
  for (int i = 0; i < 12; ++i) {
    out.write(some_frame(0.1 * i, 100 * i));
    ASSERT_EQ(list_frames(run).size(), std::size_t(i + 1));
  }
  const std::vector<FramePaths> frames = list_frames(run);
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(frames[std::size_t(i)].time, 0.1 * i) << "the listed time is exact";
    EXPECT_EQ(frames[std::size_t(i)].step, 100 * i);
    EXPECT_TRUE(std::filesystem::exists(frames[std::size_t(i)].grains));
  }
}

TEST_F(FramesTest, far_lakes_come_back) {
  FrameWriter out = writer();
  Frame frame = some_frame(0.0, 0);
  out.write(frame);
  frame.time = 0.5;
  frame.far_lakes = {{{1.0, 2.0}, {0.5, 0.25}, {0.1, -0.1}}, {{-3.0}, {0.75}, {0.0}}};
  out.write(frame);
  const std::vector<FramePaths> frames = list_frames(run);
  Frame none, back;
  read_bodies_frame(frames[0].bodies, none);
  read_bodies_frame(frames[1].bodies, back);
  EXPECT_TRUE(none.far_lakes.empty());
  EXPECT_EQ(back.bodies.triangle.size(), frame.bodies.triangle.size());
  ASSERT_EQ(back.far_lakes.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(back.far_lakes[k].x, frame.far_lakes[k].x);
    EXPECT_EQ(back.far_lakes[k].level, frame.far_lakes[k].level);
    EXPECT_EQ(back.far_lakes[k].velocity, frame.far_lakes[k].velocity);
  }
}

TEST_F(FramesTest, parts_may_be_missing) {
  FrameWriter out = writer();
  Frame frame = some_frame(0.0, 0);
  frame.grains = {};
  frame.bodies = {};
  frame.body_states.clear();
  out.write(frame);
  out.write(some_frame(0.5, 5));
  const std::vector<FramePaths> frames = list_frames(run);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_TRUE(frames[0].grains.empty());
  EXPECT_TRUE(frames[0].bodies.empty());
  EXPECT_FALSE(frames[1].grains.empty());
}

TEST_F(FramesTest, series_is_what_paraview_expects) {
  FrameWriter out = writer();
  out.write(some_frame(0.25, 3));
  const std::string pvd = text_of_file(run + "/fluid.pvd");
  EXPECT_NE(pvd.find("<VTKFile type=\"Collection\" version=\"0.1\">"), std::string::npos);
  EXPECT_NE(pvd.find("<DataSet timestep=\"0.25\" part=\"0\" file=\"frames/fluid_00000.vtp\"/>"), std::string::npos)
      << pvd;
}

TEST_F(FramesTest, existing_run_stays_unless_forced_or_resumed) {
  writer().write(some_frame(0.0, 0));
  expect_error(ErrorKind::usage, {"lake.run", "--force", "--resume"}, [&] { writer(); });
  EXPECT_EQ(list_frames(run).size(), 1u);
  writer(true, false);
  EXPECT_TRUE(list_frames(run).empty());
}

TEST_F(FramesTest, what_is_no_run_is_not_replaced_even_by_force) {
  std::filesystem::create_directory(run);
  folder.write("lake.run/thesis.txt", "precious");
  expect_error(ErrorKind::usage, {"no run"}, [&] { writer(true, false); });
  EXPECT_EQ(text_of_file(run + "/thesis.txt"), "precious");
  run = folder.write("file.run", "x");
  expect_error(ErrorKind::usage, {"is a file"}, [&] { writer(true, false); });
}

/// A run taken up at t = 0.2 writes its frames over the ones that an interrupted run had written past it.
TEST_F(FramesTest, resumed_run_goes_on_where_its_checkpoint_stands) {
  {
    FrameWriter out = writer();
    for (int i = 0; i < 5; ++i) out.write(some_frame(0.1 * i, i));
  }
  FrameWriter out = writer(false, true);
  out.write(some_frame(0.1 * 2, 77));
  const std::vector<FramePaths> frames = list_frames(run);
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[2].step, 77);
  EXPECT_EQ(frames[2].fluid, run + "/frames/fluid_00002.vtp");
  EXPECT_EQ(out.write(some_frame(0.3, 78)).fluid, run + "/frames/fluid_00003.vtp");
}

/// Grains that only the abandoned frames had are in no list afterwards.
TEST_F(FramesTest, resumed_run_forgets_parts_of_abandoned_frames) {
  Frame water = some_frame(0.0, 0);
  water.grains = {};
  {
    FrameWriter out = writer();
    out.write(water);
    out.write(some_frame(0.1, 1));
  }
  water.time = 0.1;
  writer(false, true).write(water);
  const std::vector<FramePaths> frames = list_frames(run);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_TRUE(frames[1].grains.empty());
}

TEST_F(FramesTest, case_of_a_run) {
  expect_error(ErrorKind::input, {"no such run"}, [&] { run_case_path(run); });
  writer();
  expect_error(ErrorKind::input, {"case.link"}, [&] { run_case_path(run); });
  write_run_case_path(run, folder / "sub/../lake.case");
  EXPECT_EQ(run_case_path(run), folder / "lake.case");
  folder.write("lake.run/case.link", "a\nb\n");
  expect_error(ErrorKind::input, {"one line"}, [&] { run_case_path(run); });
}

TEST_F(FramesTest, what_is_no_run_is_refused) {
  expect_error(ErrorKind::input, {"lake.run", "no such run"}, [&] { list_frames(run); });
  std::filesystem::create_directory(run);
  expect_error(ErrorKind::input, {"no run folder"}, [&] { list_frames(run); });
  folder.write("lake.run/fluid.pvd", "<DataSet timestep=\"x\" file=\"frames/fluid_00001.vtp\"/>\n");
  expect_error(ErrorKind::input, {"fluid.pvd:1"}, [&] { list_frames(run); });
  folder.write("lake.run/fluid.pvd", "<DataSet timestep=\"1\" file=\"../../fluid_00001.vtp\"/>\n");
  expect_error(ErrorKind::input, {"not a frame of this run"}, [&] { list_frames(run); });
}

TEST_F(FramesTest, vanished_folder_is_a_resource_error) {
  FrameWriter out = writer();
  std::filesystem::remove_all(run);
  expect_error(ErrorKind::resource, {"fluid_00000.vtp"}, [&] { out.write(some_frame(0.0, 0)); });
}

TEST_F(FramesTest, fields_can_be_mapped) {
  FrameWriter out = writer();
  const FramePaths paths = out.write(some_frame(0.0, 0));
  const FluidTable f = read_fluid_frame(paths.fluid, {{"density", "pressure"}}, nullptr);
  EXPECT_TRUE(f.density == some_fluid(20).pressure);
  expect_error(ErrorKind::input, {"no field \"Vel\"", "velocity, density"}, [&] {
    read_fluid_frame(paths.fluid, {{"velocity", "Vel"}}, nullptr);
  });
  expect_error(ErrorKind::input, {"field density has 1 components, expected 3"}, [&] {
    read_fluid_frame(paths.fluid, {{"velocity", "density"}}, nullptr);
  });
  const GrainTable g = read_grain_frame(paths.fluid, {{"radius", "density"}}, nullptr);
  EXPECT_EQ(g.diameter.at(3), 2.0f * some_fluid(20).density.at(3));
}

TEST_F(FramesTest, other_endings_are_refused) {
  expect_error(ErrorKind::input, {"x.csv", ".vtp, .vtu, .vtk and .vdb"},
               [&] { read_fluid_frame(folder.write("x.csv", "a"), {}, nullptr); });
}

}  // namespace
}  // namespace gdesp::test
