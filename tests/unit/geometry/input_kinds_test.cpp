// SPDX-License-Identifier: GPL-3.0-or-later
// One lake in every format a terrain comes in: the water's volume must be the same, and that of the formula.
#include <cpl_error.h>
#include <gdal_priv.h>
#include <gmsh.h>
#include <ogr_spatialref.h>

#include "geometry/case_builder.hpp"
#include "geometry/file_check.hpp"
#include "geometry/gdal_support.hpp"
#include "geometry/mesh_reader.hpp"
#include "support.hpp"

namespace gdesp::geometry {
namespace {

using testing::field;
using testing::Folder;
using testing::input_error;

constexpr double x0 = 500000.0, y0 = 5100000.0, level = 10.0, radius = 50.0;  // UTM zone 32 N, north of the Alps

/// A round bowl, 20 m deep, in a plain: z = 20 r^2 / 2500 up to 20 m.
double bowl(double x, double y) {
  const double u = x - x0 - 60.0, v = y - y0 - 60.0;
  return std::min(20.0, 20.0 * (u * u + v * v) / (radius * radius));
}
const double expected_volume = std::acos(-1.0) * radius * radius * level * level / 40.0;

Heightfield bowl_field(double west = 0.0, double east = 120.0) {
  return field(x0 + west, y0, 2.0, static_cast<int>((east - west) / 2.0) + 1, 61, bowl);
}

void write_geotiff(const Heightfield& f, const std::string& path, int epsg, bool feet = false) {
  GDALAllRegister();
  GDALDataset* data =
      GetGDALDriverManager()->GetDriverByName("GTiff")->Create(path.c_str(), f.nx, f.ny, 1, GDT_Float32, nullptr);
  double where[6] = {f.x0 - 0.5 * f.dx, f.dx, 0.0, f.y0 + (f.ny - 0.5) * f.dy, 0.0, -f.dy};
  data->SetGeoTransform(where);
  OGRSpatialReference crs;
  crs.importFromEPSG(epsg);
  data->SetSpatialRef(&crs);
  std::vector<float> z;
  for (int j = f.ny - 1; j >= 0; --j) {
    for (int i = 0; i < f.nx; ++i) z.push_back(static_cast<float>(f.at(i, j) / (feet ? 0.3048 : 1.0)));
  }
  EXPECT_EQ(data->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, f.nx, f.ny, z.data(), f.nx, f.ny, GDT_Float32, 0, 0),
            CE_None);
  GDALClose(data);
}

std::string text_of(const TriangleMesh& m, const std::string& format) {
  std::string text;
  char line[120];
  if (format == "off")
    text = "OFF\n" + std::to_string(m.vertex.size()) + " " + std::to_string(m.triangle.size()) + " 0\n";
  for (const auto& v : m.vertex) {
    std::snprintf(line, sizeof line, "%s%.4f %.4f %.6f\n", format == "obj" ? "v " : "", v.x, v.y, v.z);
    text += line;
  }
  if (format == "xyz") return text;
  const int first = format == "obj" ? 1 : 0;
  for (const auto& t : m.triangle) {
    std::snprintf(line, sizeof line, "%s%d %d %d\n", format == "obj" ? "f " : "3 ", t.x + first, t.y + first,
                  t.z + first);
    text += line;
  }
  return text;
}

Scene lake(const std::vector<std::string>& files) {
  Scene s;
  s.dp = 2.0;
  s.terrain.files = files;
  FluidFill fill;
  fill.level = level;
  fill.seed = Point2{x0 + 60.0, y0 + 60.0};
  s.fluid.fill = {fill};
  return s;
}

void expect_the_lake(const Scene& scene, double tolerance = 0.01) {
  BuildReport report;
  const Case c = build_case(scene, report, {.scope = BuildScope::counts_only});
  EXPECT_NEAR(report.fills[0].exact_volume, expected_volume, tolerance * expected_volume);
  EXPECT_NEAR(report.fills[0].volume, expected_volume, 2.0 * tolerance * expected_volume);
  EXPECT_LT(std::abs(c.fluid.position[0].y), 1e4) << "re-centred";
  EXPECT_NEAR(c.fluid.position[0].y + c.offset.y, y0 + 60.0, 60.0);
}

TEST(InputKinds, GeoTiffInUtm) {
  const Folder folder;
  write_geotiff(bowl_field(), folder.file("bowl.tif"), 32632);
  expect_the_lake(lake({folder.file("bowl.tif")}));
}

TEST(InputKinds, GeoTiffTilesWithElevationsInFeet) {
  const Folder folder;
  write_geotiff(bowl_field(0.0, 58.0), folder.file("west.tif"), 32632, true);
  write_geotiff(bowl_field(60.0, 120.0), folder.file("east.tif"), 32632, true);
  Scene s = lake({folder.file("west.tif"), folder.file("east.tif")});
  s.terrain.vertical_scale = 0.3048;
  expect_the_lake(s);
}

TEST(InputKinds, GeoTiffInLongitudeAndLatitudeGoesToUtm) {
  const Folder folder;
  // 500 km E is the central meridian, 9 E, of zone 32; a degree of latitude is 111.2 km there.
  OGRSpatialReference utm, geographic;
  utm.importFromEPSG(32632);
  geographic.importFromEPSG(4326);
  utm.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  geographic.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> back(OGRCreateCoordinateTransformation(&utm, &geographic));
  const std::unique_ptr<OGRCoordinateTransformation> there(OGRCreateCoordinateTransformation(&geographic, &utm));
  double lon = x0, lat = y0;
  ASSERT_TRUE(back->Transform(1, &lon, &lat));
  const double step = 1.0 / 111200.0;  // about a metre north, 0.7 m east
  const Heightfield f = field(lon - 10 * step, lat - 10 * step, step, 195, 150, [&](double x, double y) {
    EXPECT_TRUE(there->Transform(1, &x, &y));
    return bowl(x, y);
  });
  write_geotiff(f, folder.file("lonlat.tif"), 4326);
  expect_the_lake(lake({folder.file("lonlat.tif")}));
}

TEST(InputKinds, EsriAsciiCornerAndCentre) {
  const Folder folder;
  const Heightfield f = bowl_field();
  write_esri_ascii(f, folder.file("centre.asc"), 4);
  expect_the_lake(lake({folder.file("centre.asc")}));
}

TEST(InputKinds, XyzPointsOnNoGrid) {
  const Folder folder;
  TriangleMesh m = to_mesh(bowl_field());
  for (std::size_t k = 0; k < m.vertex.size(); ++k) {  // shaken, so that no raster reader takes it
    m.vertex[k].x += 0.3 * std::sin(7.0 * static_cast<double>(k));
    m.vertex[k].z = bowl(m.vertex[k].x, m.vertex[k].y);
  }
  expect_the_lake(lake({folder.write("points.xyz", text_of(m, "xyz"))}));
}

TEST(InputKinds, MeshesWholeAndInTiles) {
  const Folder folder;
  const TriangleMesh m = to_mesh(bowl_field());
  expect_the_lake(lake({folder.write("bowl.obj", text_of(m, "obj"))}));
  const std::string west = folder.write("west.off", text_of(to_mesh(bowl_field(0.0, 60.0)), "off")),
                    east = folder.write("east.off", text_of(to_mesh(bowl_field(60.0, 120.0)), "off"));
  expect_the_lake(lake({west, east}));
}

TEST(InputKinds, FoldedTerrainIsRefusedWithItsPlace) {
  const Folder folder;
  TriangleMesh m = to_mesh(bowl_field());
  TriangleMesh roof = to_mesh(field(x0 + 20, y0 + 20, 20.0, 3, 3, [](double, double) { return 30.0; }));
  append(m, roof);
  const std::string path = folder.write("folded.obj", text_of(m, "obj"));
  const std::string message = input_error([&] {
    BuildReport r;
    build_case(lake({path}), r);
  });
  EXPECT_MENTIONS(message, "folded.obj: no terrain sheet: folds over itself");
  EXPECT_MENTIONS(message, "e.g. at (50");
}

TEST(InputKinds, SmallGapsInATerrainAreFilledAndTold) {
  const Folder folder;
  Heightfield f = bowl_field();
  for (int j = 29; j < 32; ++j) {
    for (int i = 29; i < 32; ++i) f.at(i, j) = std::nan("");
  }
  write_esri_ascii(f, folder.file("gap.asc"), 4);
  BuildReport report;
  build_case(lake({folder.file("gap.asc")}), report, {.scope = BuildScope::counts_only});
  EXPECT_NEAR(report.fills[0].exact_volume, expected_volume, 0.01 * expected_volume);
  EXPECT_MENTIONS(report.notes.done.at(0), "9 nodes without data");
}

TEST(InputKinds, StepThroughGmshAtAStatedSize) {
  const Folder folder;
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::model::add("box");
  gmsh::model::occ::addBox(0, 0, 0, 1000, 2000, 3000);
  gmsh::model::occ::synchronize();
  gmsh::write(folder.file("box.step"));  // STEP states its unit: millimetres here
  gmsh::finalize();
  MeshOptions o;
  o.mesh_size = 0.2;  // at most: a coarser wish gets what gmsh finds right for the body
  const TriangleMesh m = read_mesh(folder.file("box.step"), o);
  EXPECT_EQ(border_edges(m), 0u);
  EXPECT_NEAR(std::abs(signed_volume(m)), 6.0, 1e-9);
  o.mesh_size = 0.1;
  EXPECT_GT(read_mesh(folder.file("box.step"), o).triangle.size(), 3 * m.triangle.size());
}

TEST(InputKinds, GeoFilesMayDescribeShapesOnly) {
  const Folder folder;
  const std::string target = folder.file("written.txt");
  MeshOptions o;
  o.mesh_size = 1.0;
  const std::string attacks[] = {"// harmless\n\nSystemCall \"touch " + target + "\";\n", "Print \"" + target + "\";\n",
                                 "Printf(\"x\") > \"" + target + "\";\n", "Save \"" + target + "\";\n",
                                 "Merge \"/etc/passwd\";\n"};
  for (const auto& text : attacks) {
    EXPECT_MENTIONS(input_error([&] { read_mesh(folder.write("a.geo", text), o); }), "may only describe geometry");
    EXPECT_MENTIONS(input_error([&] { read_mesh(folder.write("a.msh", text), o); }), "does not begin with $MeshFormat");
    EXPECT_FALSE(std::filesystem::exists(target));
  }
  EXPECT_MENTIONS(input_error([&] { read_mesh(folder.write("b.geo", attacks[0]), o); }), "b.geo:3:");
}

TEST(InputKinds, WhatGdalWarnsOfIsToldOnceWithTheFile) {
  const QuietGdal quiet;
  EXPECT_TRUE(quiet.warnings("a.tif").empty());
  EXPECT_EQ(quiet.message(), "no reason given");
  CPLError(CE_Warning, CPLE_AppDefined, "odd tag");
  CPLError(CE_Warning, CPLE_AppDefined, "another");
  ASSERT_EQ(quiet.warnings("a.tif").size(), 1u);
  EXPECT_EQ(quiet.warnings("a.tif")[0], "a.tif: GDAL warns: odd tag (and 1 more)");
  EXPECT_EQ(quiet.message(), "another");
}

}  // namespace
}  // namespace gdesp::geometry
