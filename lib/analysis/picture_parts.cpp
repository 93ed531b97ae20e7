// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/picture_parts.hpp"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkCleanPolyData.h>
#include <vtkContourFilter.h>
#include <vtkCutter.h>
#include <vtkFeatureEdges.h>
#include <vtkFloatArray.h>
#include <vtkGlyph3DMapper.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>

#include <algorithm>
#include <cmath>

#include "analysis/surface_mesh.hpp"
#include "analysis/water_sheet.hpp"

namespace gdesp::analysis {
namespace {

constexpr std::size_t most_balls = 120000;   // above it grains are drawn as points
constexpr std::size_t most_cells = 1000000;  // of a lake's sheet

vtkNew<vtkPolyData> triangles_to_vtk(const std::vector<Vec3d>& vertex,
                                     const std::vector<Vec3<std::int32_t>>& triangle) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  for (const Vec3d& v : vertex) points->InsertNextPoint(v.x, v.y, v.z);
  vtkNew<vtkCellArray> cells;
  for (const auto& t : triangle) {
    const vtkIdType corner[3] = {t.x, t.y, t.z};
    cells->InsertNextCell(3, corner);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  return data;
}

void set_scalars(vtkPolyData* data, const char* name, const std::vector<float>& value) {
  vtkNew<vtkFloatArray> array;
  array->SetName(name);
  for (const float v : value) array->InsertNextValue(v);
  data->GetPointData()->SetScalars(array);
}

void fill_table(vtkLookupTable* table, const std::vector<Vec3d>& stops) {
  const int n = 256;
  table->SetNumberOfTableValues(n);
  for (int k = 0; k < n; ++k) {
    const double u = k / (n - 1.0) * static_cast<double>(stops.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(u), stops.size() - 2);
    const Vec3d c = stops[i] * (1.0 - (u - static_cast<double>(i))) + stops[i + 1] * (u - static_cast<double>(i));
    table->SetTableValue(k, c.x, c.y, c.z, 1.0);
  }
}

double nice_step(double range) {
  const double raw = range / 18.0, unit = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double m : {1.0, 2.0, 5.0, 10.0}) {
    if (m * unit >= raw) return m * unit;
  }
  return 10.0 * unit;
}

vtkNew<vtkActor> put(const PictureScene& scene, vtkMapper* mapper) {
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->SetScale(1.0, 1.0, scene.vertical_exaggeration);
  scene.renderer->AddActor(actor);
  return actor;
}

vtkNew<vtkPolyData> walls_at_rest(const RunInfo& info) {
  std::vector<Vec3<std::int32_t>> at_rest;
  for (std::size_t k = 0; k < info.walls.triangle.size(); ++k) {
    if (k >= info.walls.body.size() || info.walls.body[k] == 0) at_rest.push_back(info.walls.triangle[k]);
  }
  return triangles_to_vtk(info.walls.vertex, at_rest);
}

void add_contours(const PictureScene& scene, vtkPolyData* terrain, const double* range) {
  const double step = nice_step(range[1] - range[0]);
  const auto lines = [&](bool shore) {
    vtkNew<vtkContourFilter> contour;
    contour->SetInputData(terrain);
    int count = 0;
    if (shore) {
      contour->SetValue(count++, *scene.info.still_water_level);
    } else {
      const double base = scene.info.offset.z;  // round numbers in the scene's own elevations
      const double first = std::ceil((range[0] + base) / step);
      const int most = static_cast<int>((range[1] - range[0]) / step) + 1;
      while (count < most && (first + count) * step - base < range[1])
        contour->SetValue(count, (first + count) * step - base), ++count;
    }
    contour->SetNumberOfContours(count);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(contour->GetOutputPort());
    mapper->ScalarVisibilityOff();
    mapper->SetResolveCoincidentTopologyToPolygonOffset();
    mapper->SetRelativeCoincidentTopologyLineOffsetParameters(-1.0, -4.0);
    auto actor = put(scene, mapper);
    actor->GetProperty()->SetLighting(false);
    actor->GetProperty()->SetLineWidth(static_cast<float>(supersampling) * (shore ? 1.6f : 0.7f));
    if (shore)
      actor->GetProperty()->SetColor(0.0, 0.2, 0.45);
    else
      actor->GetProperty()->SetColor(0.30, 0.27, 0.22);
    actor->GetProperty()->SetOpacity(shore ? 0.9 : 0.40);
  };
  lines(false);
  if (scene.info.still_water_level) lines(true);
}

// The ground's rim goes straight down to a common base, so that the valley stands as a block and not as a sheet of paper.
void add_plinth(const PictureScene& scene, vtkPolyData* terrain, const double* range) {
  vtkNew<vtkCleanPolyData> weld;
  weld->SetInputData(terrain);
  weld->SetTolerance(1e-6);
  vtkNew<vtkFeatureEdges> rim;
  rim->SetInputConnection(weld->GetOutputPort());
  rim->BoundaryEdgesOn();
  rim->FeatureEdgesOff();
  rim->NonManifoldEdgesOff();
  rim->ManifoldEdgesOff();
  rim->ColoringOff();
  rim->Update();
  vtkPolyData* edges = rim->GetOutput();
  const double base = range[0] - 0.06 * (range[1] - range[0]);
  std::vector<Vec3d> vertex;
  std::vector<Vec3<std::int32_t>> triangle;
  vtkCellArray* lines = edges->GetLines();
  lines->InitTraversal();
  vtkNew<vtkIdList> ids;
  while (lines->GetNextCell(ids)) {
    for (vtkIdType k = 0; k + 1 < ids->GetNumberOfIds(); ++k) {
      double a[3], b[3];
      edges->GetPoint(ids->GetId(k), a);
      edges->GetPoint(ids->GetId(k + 1), b);
      const auto first = static_cast<std::int32_t>(vertex.size());
      vertex.insert(vertex.end(), {{a[0], a[1], a[2]}, {b[0], b[1], b[2]}, {b[0], b[1], base}, {a[0], a[1], base}});
      triangle.insert(triangle.end(), {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
    }
  }
  if (triangle.empty()) return;
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(triangles_to_vtk(vertex, triangle));
  mapper->ScalarVisibilityOff();
  auto actor = put(scene, mapper);
  actor->GetProperty()->SetColor(0.66, 0.63, 0.58);
  actor->GetProperty()->SetLighting(false);
}

void add_terrain(const PictureScene& scene, vtkPolyData* data) {
  std::vector<float> elevation;
  for (vtkIdType k = 0; k < data->GetNumberOfPoints(); ++k)
    elevation.push_back(static_cast<float>(data->GetPoint(k)[2]));
  set_scalars(data, "elevation", elevation);
  double range[2];
  data->GetPointData()->GetScalars()->GetRange(range);
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(data);
  normals->SetFeatureAngle(50.0);
  normals->ConsistencyOff();
  vtkNew<vtkLookupTable> tint;  // muted, so that the water and the slide carry the colours
  fill_table(tint,
             {{0.42, 0.43, 0.33}, {0.52, 0.56, 0.41}, {0.66, 0.66, 0.53}, {0.78, 0.75, 0.67}, {0.93, 0.92, 0.90}});
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(normals->GetOutputPort());
  mapper->SetLookupTable(tint);
  mapper->SetScalarRange(range);
  auto actor = put(scene, mapper);
  actor->GetProperty()->SetAmbient(0.20);
  actor->GetProperty()->SetDiffuse(0.90);
  if (range[1] <= range[0]) return;
  add_contours(scene, data, range);
  add_plinth(scene, data, range);
}

void add_tank(const PictureScene& scene, vtkPolyData* data) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->ScalarVisibilityOff();
  auto actor = put(scene, mapper);
  actor->GetProperty()->SetColor(0.80, 0.80, 0.78);
  actor->GetProperty()->SetAmbient(0.30);
  actor->GetProperty()->SetDiffuse(0.75);
  actor->GetProperty()->BackfaceCullingOn();  // seen from inside
}

void add_outline(const PictureScene& scene, vtkPolyData* data) {
  vtkNew<vtkPlane> plane;
  plane->SetNormal(0, 1, 0);
  const double* bounds = data->GetBounds();
  plane->SetOrigin(0, 0.5 * (bounds[2] + bounds[3]) + 1e-6 * (bounds[3] - bounds[2]), 0);
  vtkNew<vtkCutter> cut;
  cut->SetCutFunction(plane);
  cut->SetInputData(data);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(cut->GetOutputPort());
  mapper->ScalarVisibilityOff();
  auto actor = put(scene, mapper);
  actor->GetProperty()->SetLighting(false);
  actor->GetProperty()->SetColor(0.15, 0.15, 0.15);
  actor->GetProperty()->SetLineWidth(supersampling * 2.0f);
}

void colour_by_speed(vtkPolyData* data, vtkMapper* mapper, const std::vector<float>& speed, vtkLookupTable* colours) {
  if (!speed.empty()) set_scalars(data, "speed", speed);
  mapper->SetLookupTable(colours);
  mapper->SetScalarRange(colours->GetTableRange());
}

// Balls of the given diameters (one for all, or one each).
void add_balls(const PictureScene& scene, const std::vector<Vec3d>& position, const std::vector<float>& diameter,
               const std::vector<float>& speed, vtkLookupTable* colours, const Vec3d& colour) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkFloatArray> size;
  size->SetName("diameter");
  for (std::size_t k = 0; k < position.size(); ++k) {
    const vtkIdType id = points->InsertNextPoint(position[k].x, position[k].y, position[k].z);
    cells->InsertNextCell(1, &id);
    size->InsertNextValue(diameter.size() == 1 ? diameter[0] : diameter[k]);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetVerts(cells);
  data->GetPointData()->AddArray(size);
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(0.5);
  ball->SetThetaResolution(10);
  ball->SetPhiResolution(8);
  vtkNew<vtkGlyph3DMapper> balls;
  vtkNew<vtkPolyDataMapper> dots;
  const bool few = position.size() <= most_balls;
  vtkMapper* mapper = few ? static_cast<vtkMapper*>(balls.Get()) : static_cast<vtkMapper*>(dots.Get());
  balls->SetInputData(data);
  dots->SetInputData(data);
  balls->SetSourceConnection(ball->GetOutputPort());
  balls->SetScaleModeToScaleByMagnitude();
  balls->SetScaleArray("diameter");
  if (colours) colour_by_speed(data, mapper, speed, colours);
  mapper->SetScalarVisibility(colours && !speed.empty());
  auto actor = put(scene, mapper);
  actor->GetProperty()->SetColor(colour.x, colour.y, colour.z);
  actor->GetProperty()->SetAmbient(0.45);
  actor->GetProperty()->SetDiffuse(0.75);
  actor->GetProperty()->SetPointSize(supersampling * 3.0f);
}

std::vector<float> speeds(const std::vector<Vec3f>& velocity) {
  std::vector<float> speed;
  speed.reserve(velocity.size());
  for (const Vec3f& v : velocity) speed.push_back(norm(v));
  return speed;
}

void add_surface(const PictureScene& scene, vtkPolyData* data, const std::vector<float>& speed,
                 vtkLookupTable* colours) {
  vtkNew<vtkPolyDataNormals> normals;
  vtkNew<vtkPolyDataMapper> mapper;
  colour_by_speed(data, mapper, speed, colours);
  normals->SetInputData(data);
  normals->SplittingOff();
  normals->ConsistencyOff();
  mapper->SetInputConnection(normals->GetOutputPort());
  auto actor = put(scene, mapper);
  actor->GetProperty()->SetColor(0.13, 0.40, 0.68);
  actor->GetProperty()->SetAmbient(0.42);
  actor->GetProperty()->SetDiffuse(0.68);
  actor->GetProperty()->SetSpecular(0.20);
  actor->GetProperty()->SetSpecularPower(40.0);
}

void add_lake(const PictureScene& scene, vtkLookupTable* colours) {
  FrameView view(scene.frame, scene.info);
  const Vec3d size = scene.info.fluid_upper - scene.info.fluid_lower;
  const double cell = std::max(0.5 * scene.info.dp, std::sqrt(size.x * size.y / static_cast<double>(most_cells)));
  const WaterSheet sheet = make_water_sheet(view, cell);
  auto data = triangles_to_vtk(sheet.vertex, sheet.triangle);
  add_surface(scene, data, sheet.speed, colours);
  std::vector<Vec3d> splash;
  std::vector<Vec3f> velocity;
  const FluidTable& fluid = scene.frame.fluid;
  for (std::size_t k = 0; k < fluid.position.size(); ++k) {
    if (view.connected().main[k]) continue;
    splash.push_back(fluid.position[k]);
    if (k < fluid.velocity.size()) velocity.push_back(fluid.velocity[k]);
  }
  if (!splash.empty()) {
    add_balls(scene, splash, {static_cast<float>(0.7 * scene.info.dp)}, speeds(velocity), colours, {0.13, 0.40, 0.68});
  }
}

}  // namespace

void fill_speed_colours(vtkLookupTable* table, double largest) {
  fill_table(table,
             {{0.07, 0.22, 0.48}, {0.10, 0.40, 0.66}, {0.16, 0.60, 0.72}, {0.50, 0.79, 0.58}, {0.98, 0.88, 0.25}});
  table->SetTableRange(0.0, largest);
}

void add_ground(const PictureScene& scene) {
  auto data = walls_at_rest(scene.info);
  if (data->GetNumberOfCells() == 0) return;
  if (scene.info.dimensions == 2)
    add_outline(scene, data);
  else if (scene.has_terrain())
    add_terrain(scene, data);
  else
    add_tank(scene, data);
}

bool add_water(const PictureScene& scene, vtkLookupTable* colours) {
  const FluidTable& fluid = scene.frame.fluid;
  if (fluid.position.empty()) return false;
  if (scene.info.dimensions == 2) {
    add_balls(scene, fluid.position, {static_cast<float>(1.1 * scene.info.dp)}, speeds(fluid.velocity), colours,
              {0.13, 0.40, 0.68});
  } else if (scene.has_terrain()) {
    add_lake(scene, colours);
  } else {
    const SurfaceMesh mesh = extract_surface(fluid.position, fluid.velocity, {scene.info.dp, 0.0});
    auto data = triangles_to_vtk(mesh.vertex, mesh.triangle);
    add_surface(scene, data, speeds(mesh.velocity), colours);
  }
  return !fluid.velocity.empty();
}

void add_slide(const PictureScene& scene) {
  const Vec3d orange{0.90, 0.42, 0.05};  // near the vermillion of Okabe & Ito
  const GrainTable& g = scene.frame.grains;
  if (!g.position.empty()) add_balls(scene, g.position, g.diameter, {}, nullptr, orange);
  if (scene.frame.bodies.triangle.empty()) return;
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(triangles_to_vtk(scene.frame.bodies.vertex, scene.frame.bodies.triangle));
  auto actor = put(scene, mapper);
  actor->GetProperty()->SetColor(orange.x, orange.y, orange.z);
  actor->GetProperty()->SetAmbient(0.3);
}

}  // namespace gdesp::analysis
