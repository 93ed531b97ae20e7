// SPDX-License-Identifier: GPL-3.0-or-later
// Real terrain and hard meshes that lie beside the repository (../shared/terrain); skipped where they do not.
#include "geometry/case_builder.hpp"
#include "geometry/file_check.hpp"
#include "geometry/raster_reader.hpp"
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

TEST(SharedTerrain, AlpeGeraVolumes) {
  NEEDS("alpe_gera_it");
  double last = 1.0;
  for (const double dp : {16.0, 8.0}) {
    Scene s = lake("alpe_gera_it/Alpe_Gera_dam_break_no_volume_correction.obj", 2125.0, dp);
    s.fluid.fill[0].polygon = {{65000, 37400}, {80000, 37400}, {72780, 35070}, {72500, 35150}};
    s.domain = Box{{72000, 34900, 1900}, {73938, 37409, 2200}};
    BuildReport report;
    build_case(s, report);
    EXPECT_NEAR(report.fills[0].exact_volume, 44.2e6, 0.01 * 44.2e6);
    const double error = std::abs(report.fills[0].volume / report.fills[0].exact_volume - 1.0);
    EXPECT_LT(error, 0.01);
    EXPECT_LE(error, last + 0.002);
    last = error;
  }
}

TEST(SharedTerrain, CampoMoroVolume) {
  NEEDS("alpe_gera_it");
  for (const double dp : {4.0, 2.0}) {   // a shallow lake with a flat bed: its depth is rounded to whole spacings
    Scene s = lake("alpe_gera_it/Alpe_Gera_dam_break_no_volume_correction.obj", 1953.0, dp);
    s.fluid.fill[0].polygon = {{71245, 34335}, {72045, 34335}, {72045, 33865}, {71245, 33865}};
    s.domain = Box{{71100, 33700, 1850}, {72200, 34500, 2050}};
    BuildReport report;
    build_case(s, report);
    EXPECT_NEAR(report.fills[0].exact_volume, 0.92e6, 0.01 * 0.92e6) << dp;
    EXPECT_NEAR(report.fills[0].volume, 0.92e6, 0.02 * 0.92e6) << dp;
  }
}

Scene rotoma(const std::string& bed, double dp) {
  Scene s = lake(bed, 313.30, dp);
  s.fluid.fill[0].seed = Point2{1915527, 5783671};
  s.domain = Box{{1911500, 5779500, 180}, {1918500, 5786500, 400}};
  return s;
}

void expect_rotoma(const Scene& s) {
  BuildReport report;
  build_case(s, report, {}, {}, BuildScope::counts_only);
  EXPECT_NEAR(report.fills[0].exact_volume, 436e6, 0.01 * 436e6) << s.dp;
  EXPECT_NEAR(report.fills[0].surface_area, 11.1e6, 0.03 * 11.1e6) << s.dp;
}

TEST(SharedTerrain, RotomaFromTheMergedBed) {
  NEEDS("rotoma_nz");
  for (const double dp : {32.0, 16.0}) expect_rotoma(rotoma("rotoma_nz/derived_bed_32m.tif", dp));
}

/// Sonar points in longitude and latitude with negative depths, burned into a raster of another coordinate system.
TEST(SharedTerrain, RotomaWithItsBathymetryBurnedIn) {
  NEEDS("rotoma_nz");
  for (const double dp : {32.0, 16.0}) {
    Scene s = rotoma("rotoma_nz/dem_32m.tif", dp);
    s.terrain.bathymetry = terrain + "rotoma_nz/depth_points.csv.gz";
    s.terrain.bathymetry_crs = "EPSG:4326";
    s.terrain.bathymetry_offset = 313.30;
    expect_rotoma(s);
  }
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
    build_case(s, report, {}, {}, BuildScope::counts_only);
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
  EXPECT_EQ(verdict("cgal__cube-ouvert.off"), MeshVerdict::refused);   // a whole side is missing
  EXPECT_EQ(verdict("cgal__tetra_intersected_by_triangle.off"), MeshVerdict::refused);
  EXPECT_EQ(verdict("cgal__bones.off"), MeshVerdict::repaired);
  EXPECT_NE(verdict("cgal__pig.off"), MeshVerdict::usable);
}

}  // namespace
}  // namespace gdesp::geometry
