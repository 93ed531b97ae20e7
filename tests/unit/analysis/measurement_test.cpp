// SPDX-License-Identifier: GPL-3.0-or-later
// Measurements over frames made in memory, and plots.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "analysis/energy_measurement.hpp"
#include "analysis/front_measurement.hpp"
#include "analysis/gauge_measurement.hpp"
#include "analysis/map_measurement.hpp"
#include "analysis/profile_measurement.hpp"
#include "analysis/run_up_measurement.hpp"
#include "core/error.hpp"
#include "exact_fields.hpp"

namespace gdesp::analysis {
namespace {

using analysis_test::fill;
const auto everywhere = [](const Vec3d&) { return true; };

RunInfo tank(double dp) {
  RunInfo info;
  info.name = "tank";
  info.dp = dp;
  info.offset = {1000, 2000, 500};
  info.domain = {{0, 0, 0}, {4, 2, 3}};
  info.still_water_level = 1.0;
  return info;
}

Table run(Measurement& m, const RunInfo& info, const std::vector<Frame>& frames) {
  Table table;
  table.column = m.begin(info);
  const RowSink emit = [&](const std::vector<Cell>& row) { table.row.push_back(row); };
  for (const Frame& f : frames) {
    FrameView view(f, info);
    m.add(view, emit);
  }
  m.finish(emit);
  return table;
}

Frame block(double t, double length, double height, double dp) {
  Frame f;
  f.time = t;
  f.fluid.position = fill({0, 0, 0}, {length, 2, height}, dp, 3, everywhere);
  for (const Vec3d& p : f.fluid.position) f.fluid.pressure.push_back(static_cast<float>(9810.0 * (height - p.z)));
  f.fluid.velocity.assign(f.fluid.position.size(), Vec3f{2, 0, 0});
  return f;
}

TEST(GaugeMeasurement, LevelInAFarLakeIsThatOfItsColumns) {
  const double dp = 0.1;
  Frame frame = block(0, 2.0, 1.0, dp);
  frame.far_lakes = {{{2.5, 3.5, 4.5}, {1.2, 1.4, 1.0}, {0, 0, 0}}, {{-0.5, -1.5}, {0.9, 0.7}, {0, 0}}};
  GaugeOptions options;
  options.gauges = {{"water", {1001, 2001, 0}, false},      {"first", {1002.1, 2001, 0}, false},
                    {"between", {1003.25, 2001, 0}, false}, {"last", {1004.9, 2001, 0}, false},
                    {"behind", {1005.1, 2001, 0}, false},   {"other side", {999.0, 2001, 0}, false}};
  GaugeMeasurement m(options);
  const Table t = run(m, tank(dp), {frame});
  const std::vector<double> level = t.numbers("level");
  EXPECT_NEAR(level[0], 501.0, 0.5 * dp);
  EXPECT_NEAR(level[1], 501.2, 1e-12);
  EXPECT_NEAR(level[2], 501.35, 1e-12);
  EXPECT_NEAR(level[3], 501.0, 1e-12);
  EXPECT_TRUE(std::isnan(level[4]));
  EXPECT_NEAR(level[5], 500.8, 1e-12);
}

TEST(GaugeMeasurement, LevelPressureAndArrivalInSceneCoordinates) {
  const double dp = 0.1;
  GaugeOptions options;
  options.gauges = {{"wall", {1000 + 3.0, 2001, 500.2}, true}, {"dry", {1003.9, 2001, 0}, false}};
  GaugeMeasurement m(options);
  const Table t = run(m, tank(dp), {block(0, 3.5, 1.0, dp), block(1, 3.5, 1.0, dp), block(2, 4.0, 1.2, dp)});
  EXPECT_NEAR(t.numbers("level")[0], 501.0, 0.1 * dp);
  EXPECT_NEAR(t.numbers("rise")[4], 0.2, 0.1 * dp);
  EXPECT_NEAR(t.numbers("pressure")[0], 9810.0 * 0.8, 30.0);
  EXPECT_TRUE(std::isnan(t.numbers("level")[1]));
  options.arrivals = true;
  GaugeMeasurement again(options);
  const Table a = run(again, tank(dp), {block(0, 3.5, 1.0, dp), block(1, 3.5, 1.0, dp), block(2, 4.0, 1.2, dp)});
  EXPECT_NEAR(a.numbers("t_arrival")[0], 1.25, 0.06);  // 0.05 of 0.2 m between t = 1 and 2
  EXPECT_NEAR(a.numbers("t_arrival")[1], 2.0, 1e-12);
}

TEST(FrontMeasurement, ScalesOfTheColumn) {
  const double dp = 0.1;
  RunInfo info = tank(dp);
  const Frame first = block(0, 2.0, 1.0, dp);
  complete_from_fluid(info, first.fluid);
  FrontOptions options;
  options.fraction = 0.0;
  FrontMeasurement m(options);
  const Table t = run(m, info, {first, block(0.5, 3.0, 1.0, dp)});
  EXPECT_NEAR(t.numbers("x_front")[1], 1003.0, 1e-6);
  EXPECT_NEAR(t.numbers("x*")[1], 1.0, 1e-6);
  EXPECT_NEAR(t.numbers("t*")[1], 0.5 * std::sqrt(9.81), 1e-6);
  EXPECT_NEAR(t.numbers("x*")[0], 0.0, 1e-6);
}

TEST(ProfileMeasurement, NearestFrameToEachTime) {
  const double dp = 0.1;
  ProfileOptions options;
  options.line = Section{"l", {1000, 2001}, {1004, 2001}};
  options.times = {0.4, 1.9, 7.0};
  options.step = 0.5;
  ProfileMeasurement m(options);
  run(m, tank(dp), {block(0, 4, 1.0, dp), block(1, 4, 1.1, dp), block(2, 4, 1.2, dp), block(3, 4, 1.3, dp)});
  ASSERT_EQ(m.curves().size(), 3u);
  EXPECT_EQ(m.curves()[0].time, 0.0);
  EXPECT_EQ(m.curves()[1].time, 2.0);
  EXPECT_EQ(m.curves()[2].time, 3.0);
  EXPECT_NEAR(m.curves()[1].water[3], 1.2, 0.1 * dp);
}

TEST(ProfileMeasurement, TopOfGrainsIsTheSphere) {
  GrainTable g;
  g.position = {{0, 0, 1}, {5, 0, 2}};
  g.diameter = {2.0f, 1.0f};
  const auto top = top_of_grains(g, {{0, 0}, {0.6, 0}, {5, 0}, {2.5, 0}}, 3);
  EXPECT_NEAR(top[0], 2.0, 1e-6);
  EXPECT_NEAR(top[1], 1.8, 1e-6);
  EXPECT_NEAR(top[2], 2.5, 1e-6);
  EXPECT_TRUE(std::isnan(top[3]));
}

TEST(EnergyMeasurement, KineticPotentialAndCompression) {
  const double dp = 0.1;
  RunInfo info = tank(dp);
  Frame f = block(0, 1, 1, dp);
  const double b = 1e5, r = 1.01;
  f.fluid.density.assign(f.fluid.position.size(), static_cast<float>(1000 * r));
  f.fluid.pressure.assign(f.fluid.position.size(), static_cast<float>(b * (std::pow(r, 7) - 1)));
  const EnergyState e = measure_energy(f, info);
  EXPECT_NEAR(e.water_kinetic, 0.5 * 2000.0 * 4.0, 1e-3);  // 2 m3 at 2 m/s
  EXPECT_NEAR(e.water_potential, 2000.0 * 9.81 * 0.5, 1e-3);
  // int p/rho^2 drho from 1000 to 1010, by Simpson.
  double sum = 0.0;
  const int n = 200;
  for (int k = 0; k <= n; ++k) {
    const double rho = 1000.0 + 10.0 * k / n, p = b * (std::pow(rho / 1000.0, 7) - 1.0);
    sum += p / (rho * rho) * (k == 0 || k == n ? 1 : (k % 2 ? 4 : 2)) * 10.0 / n / 3.0;
  }
  EXPECT_NEAR(e.water_compression, 2000.0 * sum, 2e-3 * 2000.0 * sum);
  Frame g;
  g.grains.position = {{0, 0, 2}};
  g.grains.diameter = {1.0f};
  g.grains.density = {6000.0f / 3.14159265f};  // 1000 kg
  g.grains.velocity = {{0, 3, 0}};
  g.grains.angular_velocity = {{0, 0, 2}};
  const EnergyState s = measure_energy(g, info);
  EXPECT_NEAR(s.solid_kinetic, 4500.0, 0.1);
  EXPECT_NEAR(s.solid_rotation, 0.5 * 100.0 * 4.0, 0.1);
  EXPECT_NEAR(s.solid_potential, 9810.0 * 2, 1.0);
}

TEST(MapMeasurement, LevelDepthAndArrival) {
  const double dp = 0.1;
  RunInfo info = tank(dp);
  info.walls.vertex = {{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 2, 0}};
  info.walls.triangle = {{0, 1, 2}, {0, 2, 3}};
  MapMeasurement m({});
  run(m, info, {block(0, 3.0, 1.0, dp), block(1, 3.0, 1.2, dp), block(2, 4.0, 1.0, dp)});
  const auto cell = [&](const Raster& r, double x, double y) {
    return r.at(static_cast<int>(std::lround((x - r.x0) / r.dx)), static_cast<int>(std::lround((y - r.y0) / r.dx)));
  };
  EXPECT_NEAR(cell(m.level_max(), 1.55, 1.05), 1.2, 0.1 * dp);
  EXPECT_NEAR(cell(m.depth_max(), 1.55, 1.05), 1.2, 0.1 * dp);
  EXPECT_NEAR(cell(m.arrival(), 1.55, 1.05), 0.25, 0.06);
  EXPECT_NEAR(cell(m.arrival(), 3.65, 1.05), 2.0, 1e-6);
  EXPECT_NEAR(cell(m.level_max(), 3.65, 1.05), 1.0, 0.1 * dp);
}

// Elevations of the scene (500 m) are rounded to 1e-13 m: contours a hundredth of that apart would never come to the top.
TEST(MapMeasurement, GroundThatIsFlatButForRoundingHasFewContours) {
  RunInfo info = tank(0.1);
  info.walls.vertex = {{0, 0, 0}, {4, 0, 0}, {4, 2, 4e-13}, {0, 2, 4e-13}};
  info.walls.triangle = {{0, 1, 2}, {0, 2, 3}};
  MapMeasurement m({});
  run(m, info, {block(0, 3.0, 1.0, 0.1), block(1, 3.0, 1.2, 0.1)});
  EXPECT_LT(m.figure().map.size(), 3u);
}

TEST(RunUpMeasurement, DrawsAShoreOnlyWhereSomethingClimbsIt) {
  const double dp = 0.1;
  RunInfo info = tank(dp);
  info.walls.vertex = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0},
                       {0, 2, 0}, {4, 0, 2}, {4, 2, 2}};  // a beach of 45 degrees from x = 2
  info.walls.triangle = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  info.walls.body = {0, 0, 0, 0};
  for (const auto& [name, low, high] : {std::tuple{"beach", 1002.0, 1004.0}, std::tuple{"far bank", 999.0, 1000.5}}) {
    Region region;
    region.name = name;
    region.polygon = {{low, 1999}, {high, 1999}, {high, 2003}, {low, 2003}};
    info.scene.regions.push_back(region);
  }
  Frame tongue;
  tongue.fluid.position = fill({0, 0, 0}, {4, 2, 2}, dp, 3, [](const Vec3d& p) {
    const double bed = std::max(0.0, p.x - 2.0);
    return p.z > bed && (p.z < 1.0 || (p.x < 3.5 && p.z < bed + 0.25));
  });
  tongue.fluid.velocity.assign(tongue.fluid.position.size(), Vec3f{});
  for (const auto& [region, panels] : {std::pair{"beach", 2u}, std::pair{"far bank", 1u}}) {
    RunUpOptions options;
    options.region = region;
    RunUpMeasurement m(options);
    run(m, info, {tongue});
    EXPECT_NEAR(m.maxima()[0].height, 0.7, 2 * dp);
    ASSERT_EQ(m.figure().panel.size(), panels) << region;
    EXPECT_EQ(m.figure().panel[0].note.find("nothing climbs the far bank") != std::string::npos, panels == 1u);
  }
}

TEST(Plot, WritesEachKindAndRefusesOthers) {
  Figure figure;
  Panel panel;
  panel.title = "a \"title\" with $signs` and 100 %";
  panel.x_label = "x (m)";
  panel.y_label = "y (m)";
  panel.series.push_back({"line", {0, 1, 2}, {0, std::nan(""), 3}, {}, {}, MarkStyle::line, {}, -1});
  panel.series.push_back({"constant", {0, 1}, {2, 2}, {1, 1}, {3, 3}, MarkStyle::band, {}, -1});
  panel.series.push_back({"empty", {}, {}, {}, {}, MarkStyle::line, {}, -1});
  figure.panel.push_back(panel);
  const auto folder = std::filesystem::temp_directory_path() / "gdesp_plot_test";
  std::filesystem::create_directories(folder);
  for (const auto& [name, start] : {std::pair{"p.svg", "<?xml"}, {"p.png", "\x89PNG"}, {"p.pdf", "%PDF"}}) {
    write_figure(figure, (folder / name).string());
    std::ifstream in(folder / name, std::ios::binary);
    std::string head(std::string(start).size(), ' ');
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    EXPECT_EQ(head, start);
  }
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files += entry.is_regular_file();
  EXPECT_EQ(files, 3u) << "nothing aside is left";
  for (const std::string kind : {".svg", ".png", ".pdf"}) {  // a disk without room: gnuplot says nothing of it
    if (!std::filesystem::exists("/dev/full")) break;
    const std::string path = (folder / ("full" + kind)).string();
    std::filesystem::create_symlink("/dev/full", path + ".part-" + std::to_string(::getpid()) + kind);
    EXPECT_THROW(write_figure(figure, path), Error);
    EXPECT_FALSE(std::filesystem::exists(path));
  }
  EXPECT_EQ(figure_as_svg(figure).rfind("<svg", 0), 0u);
  std::filesystem::remove_all(folder);
  EXPECT_THROW(write_figure(figure, "p.jpg"), Error);
  EXPECT_THROW(check_plot_path("/dev/null/folder/p.svg"), Error);
}

}  // namespace
}  // namespace gdesp::analysis
