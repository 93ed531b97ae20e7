// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/heightfield.hpp"

#include "support.hpp"

namespace gdesp::geometry {
namespace {

using testing::field;

TEST(Heightfield, SampleIsExactOnPlanesAndAgreesWithTheMesh) {
  const Heightfield f = field(10, 20, 2, 5, 4, [](double x, double y) { return 3 * x - y; });
  for (double x = 10; x <= 18; x += 0.37) {
    for (double y = 20; y <= 26; y += 0.41) EXPECT_NEAR(sample(f, x, y), 3 * x - y, 1e-9);
  }
  EXPECT_NEAR(sample(f, 18, 26), 3 * 18 - 26, 1e-9);  // the last corner belongs to the field
  EXPECT_TRUE(std::isnan(sample(f, 9.99, 21)));
  EXPECT_TRUE(std::isnan(sample(f, 12, 26.01)));
}

TEST(Heightfield, MissingNodesLeaveHoles) {
  Heightfield f = field(0, 0, 1, 4, 4, [](double, double) { return 1.0; });
  f.at(1, 1) = NAN;
  EXPECT_TRUE(std::isnan(sample(f, 0.5, 0.5)));
  EXPECT_EQ(sample(f, 2.5, 2.5), 1.0);
  const TriangleMesh m = to_mesh(f);
  EXPECT_EQ(m.vertex.size(), 15u);
  EXPECT_EQ(m.triangle.size(), 18u - 6u);  // the node had six triangles
}

TEST(Heightfield, MeshLooksUpAndCoversTheArea) {
  const TriangleMesh m = to_mesh(field(0, 0, 0.5, 9, 7, [](double, double) { return 2.0; }));
  EXPECT_NEAR(surface_area(m), 4.0 * 3.0, 1e-12);
  for (const auto& t : m.triangle) {
    EXPECT_GT(cross(m.vertex[t.y] - m.vertex[t.x], m.vertex[t.z] - m.vertex[t.x]).z, 0.0);
  }
}

TEST(Heightfield, CropKeepsOneNodeMore) {
  const Heightfield f = field(0, 0, 1, 11, 11, [](double x, double y) { return x + 100 * y; });
  const Heightfield c = crop(f, {{2.5, 3.0, 0}, {6.2, 4.0, 0}});
  EXPECT_EQ(c.nx, 6);  // 2 .. 7
  EXPECT_EQ(c.ny, 2);  // 3 .. 4
  EXPECT_EQ(c.at(0, 0), 302.0);
}

TEST(Heightfield, SmallEnclosedGapsAreFilledFromTheirRim) {
  const auto plane = [](double x, double y) { return 3.0 + 0.5 * x - 0.25 * y; };
  Heightfield f = field(0, 0, 1, 30, 30, plane);
  for (int j = 10; j < 15; ++j) f.at(12, j) = f.at(13, j) = std::nan("");
  f.at(0, 5) = std::nan("");  // at the edge: not enclosed
  for (int j = 18; j < 28; ++j)
    for (int i = 18; i < 28; ++i) f.at(i, j) = std::nan("");  // 100 nodes: too many
  EXPECT_EQ(fill_small_gaps(f), 10u);
  for (int j = 10; j < 15; ++j) EXPECT_NEAR(f.at(12, j), plane(12, j), 1e-6);  // a plane is its own membrane
  EXPECT_TRUE(std::isnan(f.at(0, 5)));
  EXPECT_TRUE(std::isnan(f.at(20, 20)));
}

TEST(Heightfield, EsriAsciiRefusesOblongCells) {
  Heightfield f = field(0, 0, 1, 2, 2, [](double, double) { return 0.0; });
  f.dy = 2.0;
  const testing::Folder folder;
  EXPECT_MENTIONS(testing::input_error([&] { write_esri_ascii(f, folder.file("a.asc"), 1); }), "square cells");
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.asc")));
}

}  // namespace
}  // namespace gdesp::geometry
