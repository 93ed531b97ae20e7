// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/layered_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "geometry/columns.hpp"
#include "geometry/raster_reader.hpp"

namespace gdesp::geometry {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

std::string at(double x, double y) {
  char text[80];
  std::snprintf(text, sizeof text, "x = %.10g m, y = %.10g m", x, y);
  return text;
}

/// Copies the layer onto a grid with one more ring of nodes, thickness 0 there.
Layer with_ring(const Layer& in) {
  Layer out;
  out.grid = in.grid;
  out.grid.nx += 2;
  out.grid.ny += 2;
  out.grid.x0 -= in.grid.dx;
  out.grid.y0 -= in.grid.dy;
  const std::size_t count = static_cast<std::size_t>(out.grid.nx) * out.grid.ny;
  out.bottom.assign(count, nothing);
  out.thickness.assign(count, 0.0);
  for (int j = 0; j < out.grid.ny; ++j) {
    for (int i = 0; i < out.grid.nx; ++i) {
      const int a = std::clamp(i - 1, 0, in.grid.nx - 1), b = std::clamp(j - 1, 0, in.grid.ny - 1);
      const std::size_t from = static_cast<std::size_t>(b) * in.grid.nx + a,
                        to = static_cast<std::size_t>(j) * out.grid.nx + i;
      out.bottom[to] = in.bottom[from];
      const bool own = a == i - 1 && b == j - 1;
      const double t = own ? in.thickness[from] : 0.0;
      out.thickness[to] = t > 0.0 ? t : 0.0;
    }
  }
  return out;
}

/// Nodes of a layer as vertices: a node without thickness has one, the others a lower and an upper one.
class LayerVertices {
 public:
  LayerVertices(const Layer& layer, TriangleMesh& mesh, const std::string& what)
      : layer_(layer), mesh_(mesh), what_(what), lower_(layer.bottom.size(), -1), upper_(layer.bottom.size(), -1) {}
  std::int32_t lower(int i, int j) { return get(lower_, i, j, 0.0); }
  std::int32_t upper(int i, int j) {
    const double t = thickness(i, j);
    return t > 0.0 ? get(upper_, i, j, t) : lower(i, j);
  }
  double thickness(int i, int j) const { return layer_.thickness[static_cast<std::size_t>(j) * layer_.grid.nx + i]; }

 private:
  std::int32_t get(std::vector<std::int32_t>& index, int i, int j, double above) {
    const std::size_t node = static_cast<std::size_t>(j) * layer_.grid.nx + i;
    if (index[node] < 0) {
      const double x = layer_.grid.x0 + i * layer_.grid.dx, y = layer_.grid.y0 + j * layer_.grid.dy;
      if (!std::isfinite(layer_.bottom[node])) {
        throw Error(ErrorKind::input,
                    what_ + ": reaches where there is no terrain, or none within the domain (" + at(x, y) + ")");
      }
      index[node] = static_cast<std::int32_t>(mesh_.vertex.size());
      mesh_.vertex.push_back({x, y, layer_.bottom[node] + above});
    }
    return index[node];
  }
  const Layer& layer_;
  TriangleMesh& mesh_;
  const std::string& what_;
  std::vector<std::int32_t> lower_, upper_;
};

void add_half_cell(LayerVertices& v, TriangleMesh& mesh, const int (&n)[3][2]) {
  double thickest = 0.0;
  for (const auto& p : n) thickest = std::max(thickest, v.thickness(p[0], p[1]));
  if (thickest <= 0.0) return;
  const Triangle up{v.upper(n[0][0], n[0][1]), v.upper(n[1][0], n[1][1]), v.upper(n[2][0], n[2][1])};
  const Triangle down{v.lower(n[0][0], n[0][1]), v.lower(n[2][0], n[2][1]), v.lower(n[1][0], n[1][1])};
  mesh.triangle.push_back(up);
  mesh.triangle.push_back(down);
}

/// A grid over `box`, one cell wider on each side.
Heightfield grid_over(const Box& box, double spacing) {
  Heightfield g;
  g.dx = g.dy = spacing;
  g.x0 = box.lower.x - spacing;
  g.y0 = box.lower.y - spacing;
  g.nx = static_cast<int>(std::ceil((box.upper.x - box.lower.x) / spacing)) + 3;
  g.ny = static_cast<int>(std::ceil((box.upper.y - box.lower.y) / spacing)) + 3;
  if (static_cast<double>(g.nx) * g.ny > 1e8)
    throw Error(ErrorKind::resource, "a layered body on more than 1e8 nodes; coarsen resolution.dp");
  return g;
}

Box polygon_bounds(const std::vector<Point2>& polygon) {
  Box b = empty_box();
  for (const auto& p : polygon) extend(b, {p.x, p.y, 0.0});
  return b;
}

/// Thickness raster with data-free nodes as 0, in scene coordinates.
Heightfield thickness_field(const Shape& shape, const Scene& scene, const std::string& target_crs, Notes& notes) {
  RasterOptions o;
  o.scale = scene.terrain.scale;
  o.crs = scene.terrain.crs;
  o.target_crs = target_crs;
  Raster r = read_raster(shape.thickness, o);
  notes.warnings.insert(notes.warnings.end(), r.warnings.begin(), r.warnings.end());
  for (auto& z : r.field.z) z = std::isfinite(z) ? z : 0.0;
  return r.field;
}

/// The terrain lowered to `floor` (NaN: untouched) at its own vertices.
std::size_t lower_terrain(TriangleMesh& terrain, const Heightfield& floor) {
  std::size_t lowered = 0;
  for (auto& v : terrain.vertex) {
    const double z = sample(floor, v.x, v.y);
    if (!(z < v.z)) continue;
    v.z = z;
    ++lowered;
  }
  return lowered;
}

Layer polygon_layer(const Shape& shape, const std::string& name, const Scene& scene, const TerrainSheet& terrain,
                    Notes& notes) {
  Layer layer;
  if (shape.thickness.empty()) {
    const double spacing = std::min(terrain.spacing > 0.0 ? terrain.spacing : scene.dp, scene.dp);
    layer.grid = grid_over(polygon_bounds(shape.polygon), spacing);
    layer.thickness.assign(static_cast<std::size_t>(layer.grid.nx) * layer.grid.ny, shape.uniform_thickness);
  } else {
    layer.grid = thickness_field(shape, scene, terrain.crs, notes);
    layer.thickness = layer.grid.z;
  }
  layer.bottom = heights_on_grid(terrain.mesh, layer.grid);
  bool negative = false, positive = false;
  for (int j = 0; j < layer.grid.ny; ++j) {
    for (int i = 0; i < layer.grid.nx; ++i) {
      double& t = layer.thickness[static_cast<std::size_t>(j) * layer.grid.nx + i];
      const double x = layer.grid.x0 + i * layer.grid.dx, y = layer.grid.y0 + j * layer.grid.dy;
      if (!shape.polygon.empty() && !inside_polygon(shape.polygon, x, y)) t = 0.0;
      negative = negative || t < 0.0;
      positive = positive || t > 0.0;
    }
  }
  if (negative && positive) {
    throw Error(ErrorKind::input, name + ": " + shape.thickness +
                                      " holds thicknesses of both signs; give a raster of one sign "
                                      "(positive: on the terrain, negative: below it)");
  }
  return layer;
}

/// Lowers the terrain by a layer of negative thickness; the layer then stands on the lowered surface.
void dig_out(Layer& layer, TerrainSheet& terrain, const std::string& name, Notes& notes) {
  Heightfield floor = layer.grid;
  floor.z.assign(layer.thickness.size(), nothing);
  bool any = false;
  for (std::size_t k = 0; k < layer.thickness.size(); ++k) {
    if (std::isfinite(layer.bottom[k])) floor.z[k] = layer.bottom[k] + std::min(layer.thickness[k], 0.0);
    if (layer.thickness[k] >= 0.0) continue;
    any = true;
    layer.bottom[k] += layer.thickness[k];
    layer.thickness[k] = -layer.thickness[k];
  }
  if (!any) return;
  const std::size_t lowered = lower_terrain(terrain.mesh, floor);
  notes.done.push_back(name + ": negative thickness, so the body lies below the terrain; the terrain was lowered at " +
                       std::to_string(lowered) + " vertices");
}

Layer surfaces_layer(const Shape& shape, const std::string& name, const Scene& scene, TerrainSheet& terrain,
                     Notes& notes) {
  const TerrainSheet below = load_sheet(shape.surface_below, scene.terrain, terrain.crs, notes);
  const TerrainSheet above = load_sheet(shape.surface_above, scene.terrain, terrain.crs, notes);
  const Box a = bounds(below.mesh), b = bounds(above.mesh);
  Box both = a;
  for (int axis = 0; axis < 2; ++axis) {
    both.lower[axis] = std::max(a.lower[axis], b.lower[axis]);
    both.upper[axis] = std::min(a.upper[axis], b.upper[axis]);
  }
  if (both.lower.x >= both.upper.x || both.lower.y >= both.upper.y) {
    throw Error(ErrorKind::input, name + ": " + shape.surface_below + " and " + shape.surface_above +
                                      " do not overlap; are they of one coordinate system?");
  }
  Layer layer;
  const double spacing = std::min(below.spacing, above.spacing);
  layer.grid.dx = layer.grid.dy = spacing;
  layer.grid.x0 = both.lower.x;
  layer.grid.y0 = both.lower.y;
  layer.grid.nx = static_cast<int>((both.upper.x - both.lower.x) / spacing + 1e-6) + 1;
  layer.grid.ny = static_cast<int>((both.upper.y - both.lower.y) / spacing + 1e-6) + 1;
  layer.bottom = heights_on_grid(below.mesh, layer.grid);
  layer.thickness = heights_on_grid(above.mesh, layer.grid);
  Heightfield floor = layer.grid;
  floor.z.assign(layer.bottom.size(), nothing);
  for (std::size_t k = 0; k < layer.bottom.size(); ++k) {
    const double t = layer.thickness[k] - layer.bottom[k];
    layer.thickness[k] = t > 0.0 ? t : 0.0;
    if (t > 0.0) floor.z[k] = layer.bottom[k];
  }
  const std::size_t lowered = lower_terrain(terrain.mesh, floor);
  if (lowered)
    notes.done.push_back(name + ": the terrain was lowered to the sliding surface at " + std::to_string(lowered) +
                         " vertices");
  return layer;
}

}  // namespace

TriangleMesh layer_mesh(const Layer& given, const std::string& what) {
  const Layer layer = with_ring(given);
  TriangleMesh mesh;
  LayerVertices vertices(layer, mesh, what);
  for (int j = 0; j + 1 < layer.grid.ny; ++j) {
    for (int i = 0; i + 1 < layer.grid.nx; ++i) {
      add_half_cell(vertices, mesh, {{i, j}, {i + 1, j}, {i + 1, j + 1}});
      add_half_cell(vertices, mesh, {{i, j}, {i + 1, j + 1}, {i, j + 1}});
    }
  }
  if (mesh.empty()) throw Error(ErrorKind::input, what + ": the body has no thickness anywhere");
  return mesh;
}

TriangleMesh layered_body(const Shape& shape, const std::string& name, const Scene& scene, TerrainSheet& terrain,
                          Notes& notes) {
  if (!shape.surface_below.empty()) return layer_mesh(surfaces_layer(shape, name, scene, terrain, notes), name);
  if (terrain.mesh.empty()) {
    throw Error(ErrorKind::input,
                name + ": a polygon with a thickness stands on the terrain, but the scene has none (terrain.files)");
  }
  Layer layer = polygon_layer(shape, name, scene, terrain, notes);
  dig_out(layer, terrain, name, notes);
  return layer_mesh(layer, name);
}

}  // namespace gdesp::geometry
