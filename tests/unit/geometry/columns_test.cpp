// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/columns.hpp"

#include "geometry/lattice.hpp"
#include "support.hpp"

namespace gdesp::geometry {
namespace {

using testing::field;
using testing::sphere;

// Columns that stand exactly on vertices, edges and diagonals of a triangulated raster: each crosses it once, no slit.
TEST(Columns, OneCrossingOnEveryVertexEdgeAndDiagonal) {
  const TriangleMesh sheet = to_mesh(field(0, 0, 1.0, 21, 21, [](double x, double y) { return 0.3 * x - 0.2 * y; }));
  for (const double spacing : {1.0, 0.5, 0.25}) {
    const int n = static_cast<int>(19.0 / spacing);
    const ColumnGrid grid{0.5, 0.5, spacing, n, n};  // on cell centres (diagonals), later also on nodes and edges
    const ColumnGrid on_nodes{1.0, 1.0, spacing, n - 2, n - 2};
    for (const ColumnGrid& g : {grid, on_nodes}) {
      const Crossings c = cross_columns(sheet, g);
      for (std::size_t k = 0; k < g.count(); ++k) ASSERT_EQ(c.first[k + 1] - c.first[k], 1u);
      for (std::size_t k = 0; k < g.count(); ++k) {
        const double x = g.x(static_cast<int>(k % g.nx)), y = g.y(static_cast<int>(k / g.nx));
        ASSERT_NEAR(c.hit[k].z, 0.3 * x - 0.2 * y, 1e-7);
      }
    }
  }
}

// A closed mesh is crossed an even number of times wherever the column stands, vertices of the fan at the poles included.
TEST(Columns, ClosedMeshIsAlwaysLeftAgain) {
  const TriangleMesh ball = sphere({0.0, 0.0, 0.0}, 1.0, 16);
  const ColumnGrid grid{-1.25, -1.25, 0.125, 21, 21};  // the centre column runs through both poles
  const Crossings c = cross_columns(ball, grid);
  for (std::size_t k = 0; k < grid.count(); ++k) {
    int sum = 0;
    for (std::size_t h = c.first[k]; h < c.first[k + 1]; ++h) sum += c.hit[h].sign;
    ASSERT_EQ(sum, 0) << "column " << k;
  }
  const ColumnIntervals inside = solid_intervals(ball, grid);
  const std::size_t middle = grid.index(10, 10);
  ASSERT_EQ(inside.first[middle + 1] - inside.first[middle], 1u);
  EXPECT_NEAR(inside.interval[inside.first[middle]].lower, -1.0, 1e-9);
  EXPECT_NEAR(inside.interval[inside.first[middle]].upper, 1.0, 1e-9);
}

TEST(Columns, VolumeConvergesToTheMeshVolume) {
  const TriangleMesh ball = sphere({5.0e6, 4.0e6, 100.0}, 10.0, 40);  // coordinates as large as UTM's
  const double exact = signed_volume(ball);
  double last = 1.0;
  for (const double spacing : {1.0, 0.25}) {
    const ColumnGrid grid = covering_columns(bounds(ball), spacing);
    const double error = std::abs(volume(solid_intervals(ball, grid), grid) / exact - 1.0);
    EXPECT_LT(error, 0.01);
    EXPECT_LT(error, last);
    last = error;
  }
}

// Overlapping shells are united, not cancelled (a parity rule would hollow the overlap out).
TEST(Columns, OverlappingShellsUnite) {
  TriangleMesh two = box_mesh({{0, 0, 0}, {2, 2, 2}});
  append(two, box_mesh({{1, 0, 1}, {3, 2, 3}}));
  const ColumnGrid grid = covering_columns(bounds(two), 0.1);
  EXPECT_NEAR(volume(solid_intervals(two, grid), grid), 8.0 + 8.0 - 2.0, 1e-9);
}

TEST(Columns, UniteAndSubtract) {
  ColumnIntervals a{{0, 2}, {{0, 2}, {4, 6}}}, b{{0, 1}, {{1, 5}}};
  const ColumnIntervals sum = unite(a, b), rest = subtract(a, b);
  ASSERT_EQ(sum.interval.size(), 1u);
  EXPECT_EQ(sum.interval[0].lower, 0);
  EXPECT_EQ(sum.interval[0].upper, 6);
  ASSERT_EQ(rest.interval.size(), 2u);
  EXPECT_EQ(rest.interval[0].upper, 1);
  EXPECT_EQ(rest.interval[1].lower, 5);
  EXPECT_TRUE(a.contains(0, 0.0));
  EXPECT_FALSE(a.contains(0, 2.0));  // half-open: a point between two touching solids is in exactly one
}

TEST(Columns, SheetHeightsMissWhereThereIsNoSheet) {
  const TriangleMesh sheet = to_mesh(field(0, 0, 1, 3, 3, [](double, double) { return 7.0; }));
  const ColumnGrid grid{-1.0, 0.5, 1.0, 5, 1};
  std::size_t folded = 9;
  const auto h = sheet_heights(sheet, grid, 1e-9, &folded);
  EXPECT_TRUE(std::isnan(h[0]));
  EXPECT_NEAR(h[1], 7.0, 1e-12);
  EXPECT_NEAR(h[2], 7.0, 1e-12);
  EXPECT_TRUE(std::isnan(h[4]));
  EXPECT_EQ(folded, 0u);
}

TEST(Columns, WindingsAgreeWithTheSphere) {
  const TriangleMesh ball = sphere({1.0, 2.0, 3.0}, 1.0, 60);
  std::vector<Vec3d> points;
  for (int k = 0; k < 4000; ++k) {
    points.push_back({1.0 + 1.3 * std::sin(12.9898 * k), 2.0 + 1.3 * std::sin(78.233 * k + 1.0),
                      3.0 + 1.3 * std::sin(39.425 * k + 2.0)});
  }
  const auto w = windings(ball, points);
  int inside = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double r = norm(points[k] - Vec3d{1.0, 2.0, 3.0});
    if (std::abs(r - 1.0) < 0.01) continue;  // within the facets' sag
    ASSERT_EQ(w[k], r < 1.0 ? 1 : 0) << "radius " << r;
    inside += r < 1.0;
  }
  EXPECT_GT(inside, 100);
}

TEST(Columns, EmptyInputs) {
  EXPECT_TRUE(cross_columns({}, {0, 0, 1, 3, 3}).hit.empty());
  EXPECT_TRUE(windings({}, {{0, 0, 0}}) == std::vector<int>{0});
  EXPECT_TRUE(solid_intervals(box_mesh({{0, 0, 0}, {1, 1, 1}}), {0, 0, 1, 0, 0}).interval.empty());
}

TEST(Lattice, RangesCoverExactly) {
  const Lattice l{{0, 0, 0}, 0.1, 3};
  EXPECT_EQ(l.first_at_or_above(0, 0.0), 0);
  EXPECT_EQ(l.last_at_or_below(0, 0.3), 2);  // 0.25 is the last centre below 0.3
  EXPECT_NEAR(l.coordinate(2, -1), -0.05, 1e-15);
}

}  // namespace
}  // namespace gdesp::geometry
