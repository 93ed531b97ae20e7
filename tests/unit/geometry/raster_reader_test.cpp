// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/raster_reader.hpp"

#include "geometry/terrain_loader.hpp"
#include "support.hpp"

namespace gdesp::geometry {
namespace {

using testing::field;
using testing::Folder;
using testing::input_error;

TEST(RasterReader, CornerAndCentreConventionsDifferByHalfACell) {
  const Folder folder;
  const std::string rows = "cellsize 10\nNODATA_value -9999\n1 2 3\n4 5 -9999\n";
  const std::string corner = folder.write("corner.asc", "ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\n" + rows);
  const std::string centre = folder.write("centre.asc", "ncols 3\nnrows 2\nxllcenter 100\nyllcenter 200\n" + rows);
  const Heightfield a = read_raster(corner, {}).field, b = read_raster(centre, {}).field;
  EXPECT_EQ(a.x0, 105.0);
  EXPECT_EQ(a.y0, 205.0);
  EXPECT_EQ(b.x0, 100.0);
  EXPECT_EQ(b.y0, 200.0);
  EXPECT_EQ(a.at(0, 0), 4.0);  // the last row of the file is the southern one
  EXPECT_EQ(a.at(2, 1), 3.0);
  EXPECT_TRUE(std::isnan(a.at(2, 0)));
}

TEST(RasterReader, WritesAndReadsBackTheSame) {
  const Folder folder;
  const Heightfield f = field(72000.5, 35000.25, 30, 7, 5,
                              [](double x, double y) { return 2000 + 0.1 * (x - 72000) - 0.2 * (y - 35000); });
  write_esri_ascii(f, folder.file("f.asc"), 3);
  const Heightfield g = read_raster(folder.file("f.asc"), {}).field;
  ASSERT_EQ(g.nx, f.nx);
  EXPECT_NEAR(g.x0, f.x0, 1e-6);
  for (std::size_t k = 0; k < f.z.size(); ++k) EXPECT_NEAR(g.z[k], f.z[k], 6e-4);
}

TEST(RasterReader, UnitsSignAndDatum) {
  const Folder folder;
  const std::string path =
      folder.write("feet.asc", "ncols 2\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1000\n10 20\n30 40\n");
  RasterOptions o;
  o.scale = 0.3048;
  o.vertical_scale = -0.3048;
  o.vertical_offset = 300.0;
  const Heightfield f = read_raster(path, o).field;
  EXPECT_NEAR(f.dx, 304.8, 1e-9);
  EXPECT_NEAR(f.at(0, 0), 300.0 - 30 * 0.3048, 1e-9);
}

TEST(RasterReader, TilesOfOneGridJoinWithoutASeam) {
  const Folder folder;
  const auto z = [](double x, double y) { return x + 10 * y; };
  write_esri_ascii(field(0, 0, 1, 4, 3, z), folder.file("west.asc"), 2);
  write_esri_ascii(field(4, 0, 1, 4, 3, z), folder.file("east.asc"), 2);
  const Heightfield f = read_tiles({folder.file("west.asc"), folder.file("east.asc")}, {}).value().field;
  ASSERT_EQ(f.nx, 8);
  ASSERT_EQ(f.ny, 3);
  const std::string points = folder.write("scattered.txt", "0.1 0 1\n7 3.3 2\n1.7 2 5\n");
  EXPECT_FALSE(read_tiles({folder.file("west.asc"), points}, {}).has_value());
  EXPECT_FALSE(read_if_raster(points, {}).has_value());
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 8; ++i) EXPECT_NEAR(f.at(i, j), z(i, j), 1e-9);
  }
}

TEST(RasterReader, CoarseTileFillsAroundAFineOne) {
  const Heightfield fine = field(2, 2, 0.5, 5, 5, [](double, double) { return 5.0; });
  const Heightfield coarse = field(0, 0, 2, 4, 4, [](double, double) { return 1.0; });
  const Heightfield f = merge({fine, coarse});
  EXPECT_EQ(f.dx, 0.5);
  EXPECT_EQ(sample(f, 3.0, 3.0), 5.0);
  EXPECT_EQ(sample(f, 0.5, 0.5), 1.0);
}

TEST(RasterReader, ReprojectsLongitudeAndLatitude) {
  const Folder folder;
  const std::string path = folder.write(
      "lonlat.asc", "ncols 3\nnrows 3\nxllcenter 176.58\nyllcenter -38.05\ncellsize 0.001\n1 1 1\n1 1 1\n1 1 1\n");
  RasterOptions o;
  o.crs = "EPSG:4326";
  o.target_crs = "EPSG:2193";
  const Raster r = read_raster(path, o);
  const Box b = bounds(r.field);
  EXPECT_NEAR(b.lower.x, 1914155, 150);  // transverse Mercator series by hand for 176.58 E, 38.05 S; cells are 100 m
  EXPECT_NEAR(b.lower.y, 5782540, 150);
  o.target_crs.clear();
  EXPECT_GT(read_raster(path, o).field.x0, 1e5);  // degrees never reach a scene: UTM is taken
}

TEST(RasterReader, SaysWhatIsWrong) {
  const Folder folder;
  EXPECT_MENTIONS(input_error([&] { read_raster(folder.file("none.asc"), {}); }), "no such file");
  EXPECT_MENTIONS(input_error([&] { read_raster(folder.write("a.tif", "garbage"), {}); }),
                  "no raster that can be read");
  const std::string cut = folder.write("cut.asc", "ncols 30\nnrows 20\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n");
  EXPECT_MENTIONS(input_error([&] { read_raster(cut, {}); }), "cut.asc");
  const std::string empty = folder.write(
      "empty.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9\n-9 -9\n-9 -9\n");
  EXPECT_MENTIONS(input_error([&] { read_raster(empty, {}); }), "no elevation at all");
  RasterOptions o;
  o.crs = "EPSG:banana";
  const std::string good =
      folder.write("good.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n");
  EXPECT_MENTIONS(input_error([&] { read_raster(good, o); }), "EPSG:banana");
}

TEST(PointReader, ReadsColumnsWithAndWithoutHeader) {
  const Folder folder;
  const auto csv = read_points(folder.write("a.csv", "\"lon\",\"lat\",\"depth\"\n1,2,-3\n4,5,-6\n"), {});
  ASSERT_EQ(csv.size(), 2u);
  EXPECT_EQ(csv[1].z, -6.0);
  EXPECT_EQ(read_points(folder.write("b.xyz", "1 2 3\n\n4\t5\t6 99\n"), {}).size(), 2u);
  EXPECT_MENTIONS(input_error([&] { read_points(folder.write("c.xyz", "1 2 3\n4 five 6\n"), {}); }), "c.xyz:2");
  EXPECT_MENTIONS(input_error([&] { read_points(folder.write("d.xyz", "\n"), {}); }), "no points");
}

TEST(Triangulation, PointsSpanTheirHull) {
  std::vector<Vec3d> points = {{0, 0, 1}, {4, 0, 1}, {4, 3, 1}, {0, 3, 1}, {2, 1, 5}, {2, 1, 7}};
  const TriangleMesh m = triangulate_points(points);
  EXPECT_EQ(m.vertex.size(), 5u);  // the double point has become one, at the mean height
  double area = 0.0;
  for (const auto& t : m.triangle) area += 0.5 * cross(m.vertex[t.y] - m.vertex[t.x], m.vertex[t.z] - m.vertex[t.x]).z;
  EXPECT_NEAR(area, 12.0, 1e-12);
  EXPECT_EQ(bounds(m).upper.z, 6.0);
  EXPECT_TRUE(triangulate_points({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}}).empty());
}

}  // namespace
}  // namespace gdesp::geometry
