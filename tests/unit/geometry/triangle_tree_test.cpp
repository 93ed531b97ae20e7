// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/triangle_tree.hpp"

#include "core/triangle.hpp"
#include "geometry/random.hpp"
#include "support.hpp"

namespace gdesp::geometry {
namespace {

TEST(TriangleTree, AgreesWithEveryTriangleTried) {
  const TriangleMesh m = testing::sphere({0, 0, 0}, 1.0, 14);
  const TriangleTree tree(m);
  Random random(7);
  std::vector<std::int32_t> found;
  for (int k = 0; k < 300; ++k) {
    const Vec3d p{2 * random.signed_unit(), 2 * random.signed_unit(), 2 * random.signed_unit()};
    double nearest = 1e300;
    std::vector<std::int32_t> close;
    for (std::size_t t = 0; t < m.triangle.size(); ++t) {
      const auto& c = m.triangle[t];
      const double d = norm(p - closest_point(p, m.vertex[c.x], m.vertex[c.y], m.vertex[c.z]));
      nearest = std::min(nearest, d);
      if (d <= 0.4) close.push_back(static_cast<std::int32_t>(t));
    }
    EXPECT_NEAR(tree.nearest(p, 10.0).distance, nearest, 1e-12);
    tree.within(p, 0.4, found);
    EXPECT_EQ(found, close);
    if (nearest > 0.5) { EXPECT_EQ(tree.nearest(p, 0.5).triangle, -1); }
  }
}

TEST(TriangleTree, EmptyAndSingle) {
  EXPECT_EQ(TriangleTree().nearest({0, 0, 0}, 1e9).triangle, -1);
  TriangleMesh one;
  one.vertex = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  one.triangle = {{0, 1, 2}};
  const TriangleTree tree(one);
  EXPECT_NEAR(tree.nearest({0.2, 0.2, 3}, 5).distance, 3.0, 1e-15);
  EXPECT_EQ(tree.normal(0).z, 1.0);
}

TEST(ClosestPoint, FacesEdgesVertices) {
  const Vec3d a{0, 0, 0}, b{2, 0, 0}, c{0, 2, 0};
  TriangleFeature feature = TriangleFeature::vertex;
  closest_point({0.5, 0.5, 1}, a, b, c, &feature);
  EXPECT_EQ(feature, TriangleFeature::face);
  EXPECT_NEAR(norm(closest_point({1, -3, 0}, a, b, c, &feature) - Vec3d{1, 0, 0}), 0.0, 1e-15);
  EXPECT_EQ(feature, TriangleFeature::edge);
  EXPECT_NEAR(norm(closest_point({5, -1, 0}, a, b, c, &feature) - b), 0.0, 1e-15);
  EXPECT_EQ(feature, TriangleFeature::vertex);
}

TEST(ClosestPoint, DistancesByHand) {
  const Vec3d a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  const auto distance = [&](const Vec3d& p) { return norm(p - closest_point(p, a, b, c)); };
  EXPECT_NEAR(distance({0.2, 0.2, 3}), 3.0, 1e-12);  // face
  EXPECT_NEAR(distance({0.5, -2, 0}), 2.0, 1e-12);   // edge
  EXPECT_NEAR(distance({-3, -4, 0}), 5.0, 1e-12);    // vertex
}

}  // namespace
}  // namespace gdesp::geometry
