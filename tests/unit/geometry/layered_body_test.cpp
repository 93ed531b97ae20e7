// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/layered_body.hpp"

#include "support.hpp"

namespace gdesp::geometry {
namespace {

using testing::field;
using testing::Folder;
using testing::input_error;

TerrainSheet slope(double d) {
  TerrainSheet t;
  t.mesh = to_mesh(field(0, 0, d, static_cast<int>(100 / d) + 1, static_cast<int>(100 / d) + 1,
                         [](double x, double y) { return 0.5 * x + 0.1 * y; }));
  t.spacing = d;
  return t;
}

TEST(LayerMesh, VolumeIsTheSumOfThicknessTimesCellArea) {
  Layer layer;
  layer.grid = field(10, 10, 2, 6, 5, [](double, double) { return 0.0; });
  double sum = 0.0;
  for (int k = 0; k < 30; ++k) {
    layer.bottom.push_back(0.3 * k);
    layer.thickness.push_back(k % 4 == 0 ? 0.0 : 0.1 * k);
    sum += layer.thickness.back();
  }
  const TriangleMesh m = layer_mesh(layer, "slide");
  EXPECT_EQ(border_edges(m), 0u);
  EXPECT_NEAR(signed_volume(m), 4.0 * sum, 1e-9);
}

TEST(LayerMesh, EmptyLayerIsAnError) {
  Layer layer;
  layer.grid = field(0, 0, 1, 2, 2, [](double, double) { return 0.0; });
  layer.bottom.assign(4, 1.0);
  layer.thickness.assign(4, 0.0);
  EXPECT_MENTIONS(input_error([&] { layer_mesh(layer, "slide \"a\""); }), "slide \"a\"");
}

TEST(LayeredBody, PolygonWithUniformThickness) {
  TerrainSheet terrain = slope(5.0);
  Scene s;
  s.dp = 0.5;
  Shape shape;
  shape.polygon = {{20, 20}, {60, 20}, {60, 50}, {20, 50}};
  shape.uniform_thickness = 4.0;
  Notes notes;
  const TriangleMesh m = layered_body(shape, "slide", s, terrain, notes);
  EXPECT_NEAR(signed_volume(m), 40 * 30 * 4.0, 0.02 * 4800);
  shape.polygon = {{90, 20}, {130, 20}, {130, 50}, {90, 50}};
  EXPECT_MENTIONS(input_error([&] { layered_body(shape, "slide", s, terrain, notes); }), "no terrain");
}

// A negative thickness is a body below the terrain: the terrain is dug out, and the body fills the hole to the old surface.
TEST(LayeredBody, NegativeThicknessDigsTheTerrainOut) {
  const Folder folder;
  write_esri_ascii(
      field(0, 0, 5, 21, 21, [](double x, double y) { return x >= 30 && x <= 60 && y >= 40 && y <= 70 ? -3.0 : 0.0; }),
      folder.file("depth.asc"), 3);
  TerrainSheet terrain = slope(5.0);
  const TriangleMesh before = terrain.mesh;
  Scene s;
  s.dp = 1.0;
  Shape shape;
  shape.thickness = folder.file("depth.asc");
  shape.polygon = {{0, 0}, {100, 0}, {100, 100}, {0, 100}};
  Notes notes;
  const TriangleMesh m = layered_body(shape, "slide", s, terrain, notes);
  EXPECT_NEAR(signed_volume(m), 49 * 3.0 * 25.0, 1e-6);
  double dug = 0.0;
  for (std::size_t k = 0; k < before.vertex.size(); ++k) dug += before.vertex[k].z - terrain.mesh.vertex[k].z;
  EXPECT_NEAR(dug * 25.0, 49 * 3.0 * 25.0, 1e-6);
  EXPECT_EQ(notes.done.size(), 1u);
}

TEST(LayeredBody, BetweenTwoSurfaces) {
  const Folder folder;
  const auto bump = [](double x, double y) { return std::max(0.0, 5.0 - 0.2 * std::hypot(x - 50, y - 50)); };
  write_esri_ascii(field(0, 0, 2, 51, 51, [](double, double) { return 10.0; }), folder.file("below.asc"), 6);
  write_esri_ascii(field(0, 0, 2, 51, 51, [&](double x, double y) { return 10.0 + bump(x, y); }),
                   folder.file("above.asc"), 6);
  TerrainSheet terrain;
  Scene s;
  s.dp = 1.0;
  Shape shape;
  shape.surface_below = folder.file("below.asc");
  shape.surface_above = folder.file("above.asc");
  Notes notes;
  const TriangleMesh m = layered_body(shape, "slide", s, terrain, notes);
  EXPECT_EQ(border_edges(m), 0u);
  const double cone = std::acos(-1.0) * 25.0 * 25.0 * 5.0 / 3.0;
  EXPECT_NEAR(signed_volume(m), cone, 0.01 * cone);
  shape.surface_above = folder.file("below.asc");
  EXPECT_MENTIONS(input_error([&] { layered_body(shape, "slide", s, terrain, notes); }), "no thickness anywhere");
}

}  // namespace
}  // namespace gdesp::geometry
