// SPDX-License-Identifier: GPL-3.0-or-later
// Real terrain and hard meshes that lie beside the repository (../shared/terrain); skipped where they do not.
#include "exact_basin.hpp"
#include "geometry/case_builder.hpp"
#include "geometry/file_check.hpp"
#include "geometry/raster_reader.hpp"
#include "geometry/terrain_loader.hpp"
#include "support.hpp"

namespace gdesp::geometry {
namespace {

const std::string terrain = std::string(GDESP_SOURCE_DIR) + "/../shared/terrain/";

#define NEEDS(path) \
  if (!std::filesystem::exists(terrain + path)) GTEST_SKIP() << "no " << terrain + path

Scene lake(const std::string& file, double level, double dp) {
  Scene s;
  s.dp = dp;
  s.terrain.files = {terrain + file};
  FluidFill fill;
  fill.level = level;
  s.fluid.fill = {fill};
  return s;
}

/// The triangles the program itself fills over, integrated exactly.
testing::Basin exact(const Scene& s) {
  Notes notes;
  return testing::exact_basin(load_terrain(s, notes).mesh, s.fluid.fill[0].level, s.fluid.fill[0].polygon);
}

/// Space and surface against the exact integrals: the columns' sampling error, below `tolerance` per spacing over 10 m.
void expect_basin(Scene s, std::initializer_list<double> spacings, double per_ten_metres) {
  const testing::Basin basin = exact(s);
  for (const double dp : spacings) {
    s.dp = dp;
    BuildReport report;
    build_case(s, report, {.scope = BuildScope::counts_only});
    EXPECT_NEAR(report.fills[0].exact_volume / basin.volume, 1.0, per_ten_metres * dp / 10.0) << dp;
    EXPECT_NEAR(report.fills[0].surface_area / basin.area, 1.0, 0.01) << dp;
  }
}

Scene alpe_gera() {
  Scene s = lake("alpe_gera_it/Alpe_Gera_dam_break_no_volume_correction.obj", 2125.0, 16.0);
  s.fluid.fill[0].polygon = {{65000, 37400}, {80000, 37400}, {72780, 35070}, {72500, 35150}};
  s.domain = Box{{72000, 34900, 1900}, {73938, 37409, 2200}};
  return s;
}

TEST(SharedTerrain, AlpeGeraVolumes) {
  NEEDS("alpe_gera_it");
  Scene s = alpe_gera();
  EXPECT_NEAR(exact(s).volume, 44.2e6,
              0.002 * 44.2e6);  // stated with three digits, from the vertices times their cells
  expect_basin(s, {16.0, 8.0}, 0.001);
  double last = 1.0;
  for (const double dp : {16.0, 8.0}) {
    s.dp = dp;
    BuildReport report;
    build_case(s, report);
    const double error = std::abs(report.fills[0].volume / report.fills[0].exact_volume - 1.0);
    EXPECT_LT(error, 0.01);
    EXPECT_LE(error, last + 0.002);
    last = error;
  }
}

TEST(SharedTerrain, CampoMoroVolume) {
  NEEDS("alpe_gera_it");
  Scene s = lake("alpe_gera_it/Alpe_Gera_dam_break_no_volume_correction.obj", 1953.0, 4.0);
  s.fluid.fill[0].polygon = {{71245, 34335}, {72045, 34335}, {72045, 33865}, {71245, 33865}};
  s.domain = Box{{71100, 33700, 1850}, {72200, 34500, 2050}};
  EXPECT_NEAR(exact(s).volume, 0.92e6, 0.01 * 0.92e6);  // stated with two digits
  expect_basin(s, {8.0, 4.0, 2.0}, 0.001);
  for (const double dp : {4.0, 2.0}) {  // a shallow lake with a flat bed: its depth is rounded to whole spacings
    s.dp = dp;
    BuildReport report;
    build_case(s, report);
    EXPECT_NEAR(report.fills[0].volume, exact(s).volume, 0.005 * dp * exact(s).volume) << dp;
  }
}

Scene rotoma(const std::string& bed) {
  Scene s = lake(bed, 313.30, 32.0);
  s.fluid.fill[0].seed = Point2{1915527, 5783671};
  s.domain = Box{{1911500, 5779500, 180}, {1918500, 5786500, 400}};
  return s;
}

/// 11.1 km2, the lake's surface by its source, is the area inside the shoreline, which is that of the raster's wet cells. Over the
/// triangles between its nodes the level is met at the outermost wet nodes, half a cell (16 m of 24.9 km) inside.
TEST(SharedTerrain, RotomaFromTheMergedBed) {
  NEEDS("rotoma_nz");
  const Scene s = rotoma("rotoma_nz/derived_bed_32m.tif");
  const testing::Basin basin = exact(s);
  EXPECT_NEAR(basin.volume, 436e6, 0.002 * 436e6);
  EXPECT_NEAR(basin.area, 11.1e6 - 0.5 * 32.0 * 24.9e3, 0.02 * 11.1e6);
  EXPECT_NEAR(testing::wet_cells_area(read_raster(s.terrain.files[0], {}).field, 313.30, 1915527, 5783671), 11.1e6,
              0.01 * 11.1e6);
  expect_basin(s, {32.0, 16.0}, 0.001);
}

/// Sonar points in longitude and latitude with negative depths, burned into a raster of another coordinate system.
TEST(SharedTerrain, RotomaWithItsBathymetryBurnedIn) {
  NEEDS("rotoma_nz");
  Scene s = rotoma("rotoma_nz/dem_32m.tif");
  s.terrain.bathymetry = terrain + "rotoma_nz/depth_points.csv.gz";
  s.terrain.bathymetry_crs = "EPSG:4326";
  s.terrain.bathymetry_offset = 313.30;
  const testing::Basin basin = exact(s);
  EXPECT_NEAR(basin.volume, 436e6, 0.01 * 436e6);
  EXPECT_NEAR(basin.area, 11.1e6, 0.03 * 11.1e6);
  expect_basin(s, {32.0, 16.0}, 0.001);
}

TEST(SharedTerrain, LandlabSlideVolume) {
  NEEDS("landlab_runout");
  Scene s;
  s.dp = 5.0;
  s.terrain.files = {terrain + "landlab_runout/pre_runout_DEM.asc"};
  Slide slide;
  slide.name = "slide";
  slide.diameter = 2.0;
  slide.shape.thickness = terrain + "landlab_runout/landslide_depth.asc";
  slide.shape.polygon = {{361000, 70000}, {362000, 70000}, {362000, 71500}, {361000, 71500}};
  s.slides = {slide};
  for (const double dp : {5.0, 2.5}) {
    s.dp = dp;
    BuildReport report;
    build_case(s, report, {.scope = BuildScope::counts_only});
    EXPECT_NEAR(report.slides[0].volume, 22481.0, 0.01 * 22481.0) << dp;
  }
}

TEST(SharedTerrain, GzippedUsgsDemAndXyz) {
  NEEDS("st_helens");
  const Raster r = read_raster(terrain + "st_helens/SainteHelens.dem.gz", {});
  EXPECT_EQ(r.driver, "USGSDEM");
  const Box b = bounds(r.field);
  EXPECT_NEAR(b.lower.z, 682, 1);
  EXPECT_NEAR(b.upper.z, 2543, 1);
  NEEDS("snake_river_canyon");
  const FileReport stl = check_file(terrain + "snake_river_canyon/AcrossRiver.stl.gz");
  bool rounding = false;
  for (const auto& f : stl.found) rounding = rounding || f.find("multiples of 10 m") != std::string::npos;
  EXPECT_TRUE(rounding) << describe(stl);
}

TEST(SharedTerrain, DirtyMeshesAreJudgedWithoutACrash) {
  NEEDS("dirty_meshes");
  const auto verdict = [](const char* name) { return check_file(terrain + "dirty_meshes/" + name).verdict; };
  EXPECT_EQ(verdict("cgal__blobby-shuffled.off"), MeshVerdict::repaired);
  EXPECT_EQ(verdict("cgal__cube-ouvert.off"), MeshVerdict::refused);  // a whole side is missing
  EXPECT_EQ(verdict("cgal__tetra_intersected_by_triangle.off"), MeshVerdict::refused);
  EXPECT_EQ(verdict("cgal__bones.off"), MeshVerdict::repaired);
  EXPECT_NE(verdict("cgal__pig.off"), MeshVerdict::usable);
}

}  // namespace
}  // namespace gdesp::geometry
