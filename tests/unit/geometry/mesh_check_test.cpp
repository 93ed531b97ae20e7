// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh_check.hpp"

#include "support.hpp"

namespace gdesp::geometry {
namespace {

using testing::field;
using testing::input_error;
using testing::sphere;

TEST(MeshCheck, GoodSolidIsLeftAlone) {
  TriangleMesh m = sphere({0, 0, 0}, 2.0, 12);
  const double volume = signed_volume(m);
  const MeshReport r = check_and_repair(m, MeshPurpose::solid);
  EXPECT_EQ(r.verdict, MeshVerdict::usable) << r.refusal;
  EXPECT_TRUE(r.closed);
  EXPECT_NEAR(r.volume, volume, 1e-12);
  EXPECT_EQ(r.components, 1u);
  EXPECT_TRUE(r.done.empty());
}

TEST(MeshCheck, InsideOutIsTurned) {
  TriangleMesh m = box_mesh({{0, 0, 0}, {1, 2, 3}});
  flip(m);
  const MeshReport r = check_and_repair(m, MeshPurpose::solid);
  EXPECT_EQ(r.verdict, MeshVerdict::repaired);
  EXPECT_NEAR(signed_volume(m), 6.0, 1e-12);
}

TEST(MeshCheck, MixedOrientationIsMadeOne) {
  TriangleMesh m = sphere({0, 0, 0}, 1.0, 10);
  for (std::size_t t = 0; t < m.triangle.size(); t += 3) std::swap(m.triangle[t].y, m.triangle[t].z);
  const MeshReport r = check_and_repair(m, MeshPurpose::solid);
  EXPECT_EQ(r.verdict, MeshVerdict::repaired) << r.refusal;
  EXPECT_GT(r.inconsistent_edges, 10u);
  EXPECT_NEAR(signed_volume(m), signed_volume(sphere({0, 0, 0}, 1.0, 10)), 1e-12);
}

TEST(MeshCheck, SmallHoleIsClosedLargeOneRefusedWithItsPlace) {
  TriangleMesh m = sphere({100, 0, 0}, 1.0, 20);
  TriangleMesh small = m, large = m;
  small.triangle.erase(small.triangle.begin() + 200, small.triangle.begin() + 204);
  EXPECT_EQ(check_and_repair(small, MeshPurpose::solid).verdict, MeshVerdict::repaired);
  EXPECT_NEAR(signed_volume(small), signed_volume(m), 0.01 * signed_volume(m));
  std::erase_if(large.triangle, [&](const Triangle& t) {
    return large.vertex[t.x].z > 0.2 || large.vertex[t.y].z > 0.2 || large.vertex[t.z].z > 0.2;
  });
  const TriangleMesh before = large;
  const MeshReport r = check_and_repair(large, MeshPurpose::solid);
  EXPECT_EQ(r.verdict, MeshVerdict::refused);
  EXPECT_MENTIONS(r.refusal, "around (100,");
  EXPECT_EQ(large.triangle.size(), before.triangle.size());  // a refused mesh is left as it came
}

TEST(MeshCheck, DuplicatesAndDegeneratesGo) {
  TriangleMesh m = box_mesh({{0, 0, 0}, {1, 1, 1}});
  m.triangle.push_back(m.triangle[3]);
  m.triangle.push_back({1, 1, 2});
  m.vertex.push_back(m.vertex[0]);
  m.triangle[0].x = m.triangle[0].x == 0 ? 8 : m.triangle[0].x;  // one facet uses the twin of vertex 0
  const MeshReport r = check_and_repair(m, MeshPurpose::solid);
  EXPECT_EQ(r.verdict, MeshVerdict::repaired) << r.refusal;
  EXPECT_EQ(r.duplicate_triangles, 1u);
  EXPECT_EQ(r.duplicate_vertices, 1u);
  EXPECT_EQ(m.triangle.size(), 12u);
  EXPECT_NEAR(signed_volume(m), 1.0, 1e-12);
}

TEST(MeshCheck, TrianglesBackToBackGoADoubledFacetStaysOnce) {
  TriangleMesh flap = box_mesh({{0, 0, 0}, {1, 1, 1}});
  const Triangle edge = flap.triangle[0];
  flap.vertex.push_back({3, 3, 3});
  flap.triangle.push_back({edge.x, edge.y, 8});  // where two layers thin out to nothing
  flap.triangle.push_back({edge.y, edge.x, 8});
  const MeshReport r = check_and_repair(flap, MeshPurpose::solid);
  EXPECT_EQ(r.verdict, MeshVerdict::repaired) << r.refusal;
  EXPECT_EQ(flap.triangle.size(), 12u);
  EXPECT_NEAR(signed_volume(flap), 1.0, 1e-12);
  TriangleMesh twice = box_mesh({{0, 0, 0}, {1, 1, 1}});
  twice.triangle.push_back({twice.triangle[5].x, twice.triangle[5].z, twice.triangle[5].y});
  EXPECT_EQ(check_and_repair(twice, MeshPurpose::solid).verdict, MeshVerdict::repaired);
  EXPECT_NEAR(signed_volume(twice), 1.0, 1e-12);
}

TEST(MeshCheck, TheWidestHoleIsNamed) {
  TriangleMesh m = sphere({0, 0, 0}, 1.0, 20);
  m.triangle.erase(m.triangle.begin() + 718, m.triangle.begin() + 720);
  std::erase_if(m.triangle, [&](const Triangle& t) { return m.vertex[t.x].z < -0.3; });
  EXPECT_MENTIONS(check_and_repair(m, MeshPurpose::solid).refusal, "widest of its 2 holes around");
}

TEST(MeshCheck, SmallHolesInASheetAreClosedLargeOnesStay) {
  const auto with_hole = [](int cells) {
    Heightfield f = field(0, 0, 1, 101, 101, [](double x, double y) { return 0.1 * x + 0.2 * y; });
    for (int j = 50; j < 50 + cells; ++j) {
      for (int i = 50; i < 50 + cells; ++i) f.at(i, j) = std::nan("");
    }
    return to_mesh(f);
  };
  TriangleMesh small = with_hole(2), large = with_hole(20);
  const std::size_t rim = border_edges(to_mesh(field(0, 0, 1, 101, 101, [](double, double) { return 0.0; })));
  EXPECT_EQ(check_and_repair(small, MeshPurpose::sheet).verdict, MeshVerdict::repaired);
  EXPECT_EQ(border_edges(small), rim);
  EXPECT_EQ(check_and_repair(large, MeshPurpose::sheet).verdict, MeshVerdict::usable);
  EXPECT_GT(border_edges(large), rim);
}

TEST(MeshCheck, TwoTouchingBoxesAreCutApartAFinIsRefused) {
  TriangleMesh two = box_mesh({{0, 0, 0}, {1, 1, 1}});
  append(two, box_mesh({{1, 1, 0}, {2, 2, 1}}));  // they share one vertical edge
  EXPECT_EQ(check_and_repair(two, MeshPurpose::solid).verdict, MeshVerdict::repaired);
  EXPECT_NEAR(signed_volume(two), 2.0, 1e-12);
  TriangleMesh fin = box_mesh({{0, 0, 0}, {1, 1, 1}});
  fin.vertex.push_back({5, 5, 5});
  fin.triangle.push_back({6, 7, 8});
  const MeshReport r = check_and_repair(fin, MeshPurpose::solid);
  EXPECT_EQ(r.verdict, MeshVerdict::refused);
  EXPECT_MENTIONS(r.refusal, "more than two triangles");
}

TEST(MeshCheck, TerrainSheetIsASheet) {
  TriangleMesh m = to_mesh(field(5e5, 4.7e6, 30, 12, 9, [](double x, double y) { return std::sin(x) + std::cos(y); }));
  const MeshReport r = check_and_repair(m, MeshPurpose::any);
  EXPECT_EQ(r.verdict, MeshVerdict::usable) << r.refusal;
  EXPECT_TRUE(r.sheet);
  EXPECT_FALSE(r.closed);
  TriangleMesh slide = m;
  EXPECT_MENTIONS(input_error([&] {
                    std::vector<std::string> done;
                    require_solid(slide, "slide.stl", done);
                  }),
                  "slide.stl: no closed solid");
}

TEST(MeshCheck, FlatMeshHasNoVolume) {
  TriangleMesh m;
  m.vertex = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  m.triangle = {{0, 1, 2}, {0, 2, 1}};
  EXPECT_EQ(check_and_repair(m, MeshPurpose::solid).verdict, MeshVerdict::refused);
}

}  // namespace
}  // namespace gdesp::geometry
