// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/picture.hpp"

#include <vtkActor.h>
#include <vtkAutoInit.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkContourFilter.h>
#include <vtkFloatArray.h>
#include <vtkGlyph3DMapper.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkSphereSource.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "analysis/surface_mesh.hpp"
#include "analysis/table.hpp"
#include "core/error.hpp"

VTK_MODULE_INIT(vtkRenderingOpenGL2)
VTK_MODULE_INIT(vtkRenderingFreeType)

namespace gdesp::analysis {
namespace {

constexpr int supersampling = 2;             // drawn larger, then averaged: smooth edges on every driver
constexpr std::size_t most_balls = 80000;    // above it grains are drawn as points

vtkNew<vtkPolyData> triangles_to_vtk(const std::vector<Vec3d>& vertex, const std::vector<Vec3<std::int32_t>>& triangle) {
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

// Elevation of every point, for tints and contour lines.
void add_elevation(vtkPolyData* data) {
  vtkNew<vtkFloatArray> elevation;
  elevation->SetName("elevation");
  for (vtkIdType k = 0; k < data->GetNumberOfPoints(); ++k) {
    elevation->InsertNextValue(static_cast<float>(data->GetPoint(k)[2]));
  }
  data->GetPointData()->SetScalars(elevation);
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

class Painter {
 public:
  Painter(const Frame& frame, const RunInfo& info, const PictureOptions& options)
      : frame_(frame), info_(info), options_(options) {
    renderer_->SetBackground(0.86, 0.91, 0.96);
    renderer_->SetBackground2(1.0, 1.0, 1.0);
    renderer_->GradientBackgroundOn();
  }

  void paint(const std::string& path) {
    find_focus();
    add_terrain();
    add_water();
    add_slide();
    add_text();
    place_camera();
    save(path);
  }

 private:
  bool has_terrain() const { return !info_.scene.terrain.files.empty(); }

  // What must be in the picture: some hundred particles of the water (of a lake its surface), the slide and where it
  // came from; in a tank the tank.
  void find_focus() {
    const auto take = [&](const std::vector<Vec3d>& points, double floor) {
      const std::size_t step = points.size() / 1000 + 1;
      for (std::size_t k = 0; k < points.size(); k += step) focus_.push_back({points[k].x, points[k].y, std::max(points[k].z, floor)});
    };
    const double floor = has_terrain() && info_.still_water_level ? *info_.still_water_level : -1e300;
    take(frame_.fluid.position, floor);
    take(frame_.grains.position, -1e300);
    take(frame_.bodies.vertex, -1e300);
    if (!has_terrain()) take(info_.walls.vertex, -1e300);
    if (info_.slide_centre) focus_.push_back(*info_.slide_centre);
    if (focus_.empty()) focus_.push_back({0, 0, 0});
    for (Vec3d& p : focus_) p.z *= options_.vertical_exaggeration;
  }

  double focus_height() const {
    const auto [low, high] = std::minmax_element(focus_.begin(), focus_.end(), [](const Vec3d& a, const Vec3d& b) { return a.z < b.z; });
    return high->z - low->z;
  }

  Vec3d focus_middle() const {
    Vec3d sum;
    for (const Vec3d& p : focus_) sum += p;
    return sum * (1.0 / static_cast<double>(focus_.size()));
  }

  vtkNew<vtkActor> actor_for(vtkPolyDataMapper* mapper) {
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->SetScale(1.0, 1.0, options_.vertical_exaggeration);
    renderer_->AddActor(actor);
    return actor;
  }

  void add_terrain() {
    std::vector<Vec3<std::int32_t>> at_rest;
    for (std::size_t k = 0; k < info_.walls.triangle.size(); ++k) {
      if (k >= info_.walls.body.size() || info_.walls.body[k] == 0) at_rest.push_back(info_.walls.triangle[k]);
    }
    if (at_rest.empty()) return;
    auto data = triangles_to_vtk(info_.walls.vertex, at_rest);
    add_elevation(data);
    double range[2];
    data->GetPointData()->GetScalars()->GetRange(range);
    vtkNew<vtkPolyDataNormals> normals;
    normals->SetInputData(data);
    normals->SetFeatureAngle(50.0);
    normals->ConsistencyOff();
    vtkNew<vtkLookupTable> tint;  // muted, so that the water and the slide carry the colours
    fill_table(tint, {{0.47, 0.45, 0.38}, {0.55, 0.57, 0.45}, {0.66, 0.66, 0.55}, {0.78, 0.76, 0.69}, {0.92, 0.91, 0.89}});
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(normals->GetOutputPort());
    mapper->SetLookupTable(tint);
    mapper->SetScalarRange(range);
    mapper->SetScalarVisibility(has_terrain());
    auto actor = actor_for(mapper);
    actor->GetProperty()->SetColor(0.80, 0.80, 0.78);
    actor->GetProperty()->SetAmbient(0.22);
    actor->GetProperty()->SetDiffuse(0.85);
    actor->GetProperty()->BackfaceCullingOn();  // a tank is seen from inside
    if (has_terrain() && range[1] - range[0] > 0.0) add_contours(data, range);
  }

  void add_contours(vtkPolyData* terrain, const double* range) {
    const double step = nice_step(range[1] - range[0]);
    const auto lines = [&](bool shore) {
      vtkNew<vtkContourFilter> contour;
      contour->SetInputData(terrain);
      int count = 0;
      if (shore) {
        contour->SetValue(count++, *info_.still_water_level);
      } else {
        const double base = info_.offset.z;  // round numbers in the scene's own elevations
        for (double z = std::ceil((range[0] + base) / step) * step - base; z < range[1]; z += step) contour->SetValue(count++, z);
      }
      contour->SetNumberOfContours(count);
      vtkNew<vtkPolyDataMapper> mapper;
      mapper->SetInputConnection(contour->GetOutputPort());
      mapper->ScalarVisibilityOff();
      mapper->SetResolveCoincidentTopologyToPolygonOffset();
      mapper->SetRelativeCoincidentTopologyLineOffsetParameters(-1.0, -4.0);
      auto actor = actor_for(mapper);
      actor->GetProperty()->SetLighting(false);
      actor->GetProperty()->SetLineWidth(static_cast<float>(supersampling) * (shore ? 1.6f : 0.7f));
      if (shore) actor->GetProperty()->SetColor(0.0, 0.2, 0.45);
      else actor->GetProperty()->SetColor(0.30, 0.27, 0.22);
      actor->GetProperty()->SetOpacity(shore ? 0.9 : 0.45);
    };
    lines(false);
    if (info_.still_water_level && info_.dimensions == 3) lines(true);
  }

  double water_speed_limit() const {
    if (options_.speed_max > 0.0) return options_.speed_max;
    std::vector<float> speed;
    for (const Vec3f& v : frame_.fluid.velocity) speed.push_back(norm(v));
    if (speed.empty()) return 1.0;
    const auto at = speed.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(speed.size() - 1));
    std::nth_element(speed.begin(), at, speed.end());
    const double slowest = 0.02 * std::sqrt(info_.gravity() * std::max(focus_height(), info_.dp));  // all but at rest
    const double raw = std::max({static_cast<double>(*at), slowest, 1e-3});
    const double unit = std::pow(10.0, std::floor(std::log10(raw)));
    return std::ceil(raw / unit * 2.0) / 2.0 * unit;
  }

  void add_water() {
    if (frame_.fluid.position.empty()) return;
    vtkNew<vtkPolyData> data;
    vtkNew<vtkFloatArray> speed;
    speed->SetName("speed");
    if (info_.dimensions == 3) {
      const SurfaceMesh mesh = extract_surface(frame_.fluid.position, frame_.fluid.velocity, {info_.dp, 0.0});
      data->ShallowCopy(triangles_to_vtk(mesh.vertex, mesh.triangle));
      for (const Vec3f& v : mesh.velocity) speed->InsertNextValue(norm(v));
    } else {
      vtkNew<vtkPoints> points;
      vtkNew<vtkCellArray> cells;
      for (std::size_t k = 0; k < frame_.fluid.position.size(); ++k) {
        const Vec3d& p = frame_.fluid.position[k];
        const vtkIdType id = points->InsertNextPoint(p.x, 0.0, p.z);
        cells->InsertNextCell(1, &id);
      }
      for (const Vec3f& v : frame_.fluid.velocity) speed->InsertNextValue(norm(v));
      data->SetPoints(points);
      data->SetVerts(cells);
    }
    vtkNew<vtkPolyDataMapper> mapper;
    vtkNew<vtkPolyDataNormals> normals;
    normals->SetInputData(data);
    normals->SplittingOff();
    normals->ConsistencyOff();
    if (info_.dimensions == 3) mapper->SetInputConnection(normals->GetOutputPort());
    else mapper->SetInputData(data);
    fill_table(water_colours_, {{0.13, 0.30, 0.58}, {0.13, 0.47, 0.71}, {0.25, 0.71, 0.77}, {0.68, 0.87, 0.73}, {1.0, 1.0, 0.88}});
    water_colours_->SetTableRange(0.0, water_speed_limit());
    if (speed->GetNumberOfTuples() > 0) data->GetPointData()->SetScalars(speed);
    mapper->SetLookupTable(water_colours_);
    mapper->SetScalarRange(0.0, water_colours_->GetTableRange()[1]);
    auto actor = actor_for(mapper);
    actor->GetProperty()->SetAmbient(0.45);
    actor->GetProperty()->SetDiffuse(0.65);
    actor->GetProperty()->SetSpecular(0.25);
    actor->GetProperty()->SetSpecularPower(40.0);
    actor->GetProperty()->SetPointSize(static_cast<float>(supersampling * 4));
    if (speed->GetNumberOfTuples() > 0) add_colour_bar();
  }

  void add_colour_bar() {
    vtkNew<vtkScalarBarActor> bar;
    bar->SetLookupTable(water_colours_);
    bar->SetTitle("water speed (m/s)\n ");
    bar->SetNumberOfLabels(5);
    bar->SetLabelFormat("%.3g");
    bar->UnconstrainedFontSizeOn();
    bar->SetMaximumWidthInPixels(supersampling * options_.width / 9);
    bar->SetBarRatio(0.16);
    bar->SetPosition(0.885, 0.10);
    bar->SetPosition2(0.10, 0.45);
    bar->SetVerticalTitleSeparation(supersampling * 6);
    bar->DrawFrameOff();
    style(bar->GetTitleTextProperty(), 17);
    style(bar->GetLabelTextProperty(), 16);
    renderer_->AddActor2D(bar);
  }

  void style(vtkTextProperty* text, int size) const {
    text->SetFontFamilyToArial();
    text->SetFontSize(supersampling * size * options_.height / 1000);
    text->SetColor(0.1, 0.1, 0.1);
    text->ItalicOff();
    text->BoldOff();
    text->ShadowOff();
  }

  void add_slide() {
    const GrainTable& g = frame_.grains;
    if (!g.position.empty()) {
      vtkNew<vtkPoints> points;
      vtkNew<vtkCellArray> cells;
      vtkNew<vtkFloatArray> diameter;
      diameter->SetName("diameter");
      for (std::size_t k = 0; k < g.position.size(); ++k) {
        const vtkIdType id = points->InsertNextPoint(g.position[k].x, g.position[k].y, g.position[k].z);
        cells->InsertNextCell(1, &id);
        diameter->InsertNextValue(g.diameter[k]);
      }
      vtkNew<vtkPolyData> data;
      data->SetPoints(points);
      data->SetVerts(cells);
      data->GetPointData()->SetScalars(diameter);
      g.position.size() <= most_balls ? add_balls(data) : add_points(data);
    }
    if (frame_.bodies.triangle.empty()) return;
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(triangles_to_vtk(frame_.bodies.vertex, frame_.bodies.triangle));
    auto actor = actor_for(mapper);
    actor->GetProperty()->SetColor(0.84, 0.37, 0.0);
    actor->GetProperty()->SetAmbient(0.3);
  }

  void add_balls(vtkPolyData* data) {
    vtkNew<vtkSphereSource> ball;
    ball->SetRadius(0.5);
    ball->SetThetaResolution(8);
    ball->SetPhiResolution(6);
    vtkNew<vtkGlyph3DMapper> mapper;
    mapper->SetInputData(data);
    mapper->SetSourceConnection(ball->GetOutputPort());
    mapper->SetScaleModeToScaleByMagnitude();
    mapper->SetScaleArray("diameter");
    mapper->ScalarVisibilityOff();
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->SetScale(1.0, 1.0, options_.vertical_exaggeration);
    paint_slide(actor);
  }

  void add_points(vtkPolyData* data) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(data);
    mapper->ScalarVisibilityOff();
    auto actor = actor_for(mapper);
    actor->GetProperty()->SetPointSize(static_cast<float>(supersampling * 3));
    actor->GetProperty()->RenderPointsAsSpheresOn();
    paint_slide(actor);
  }

  void paint_slide(vtkActor* actor) {
    actor->GetProperty()->SetColor(0.90, 0.42, 0.05);  // near the vermillion of Okabe & Ito
    actor->GetProperty()->SetAmbient(0.45);
    actor->GetProperty()->SetDiffuse(0.75);
    renderer_->AddActor(actor);
  }

  void add_text() {
    const std::string name = !options_.title.empty() ? options_.title
                             : !info_.scene.title.empty() ? info_.scene.title : info_.name;
    const auto add = [&](const std::string& text, double x, double y, int size) {
      vtkNew<vtkTextActor> actor;
      actor->SetInput(text.c_str());
      actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
      actor->SetPosition(x, y);
      style(actor->GetTextProperty(), size);
      renderer_->AddActor2D(actor);
    };
    char time[64];
    std::snprintf(time, sizeof time, "t = %.4g s", frame_.time);
    add(name, 0.02, 0.945, 26);
    add(time, 0.02, 0.905, 22);
    std::string small = "dp " + format_number(info_.dp) + " m";
    if (!frame_.grains.position.empty() || !frame_.bodies.triangle.empty()) small += "   orange: slide";
    if (info_.still_water_level && has_terrain()) small += "   blue line: still-water shore";
    if (options_.vertical_exaggeration != 1.0) small += "   heights x " + format_number(options_.vertical_exaggeration);
    add(small, 0.02, 0.022, 16);
  }

  // Where the camera stands: on the far side of the lake, turned a little, so that the slide and both banks show.
  double chosen_azimuth() const {
    if (options_.azimuth) return *options_.azimuth;
    if (info_.dimensions == 2) return 180.0;
    const Vec3d middle = focus_middle();
    const Vec3d slide = info_.slide_centre ? *info_.slide_centre : middle + Vec3d{0, 1, 0};
    const Vec3d lake{info_.lake.centre.x, info_.lake.centre.y, 0.0};
    const double to_slide = std::atan2(slide.x - lake.x, slide.y - lake.y) * 180.0 / std::numbers::pi;
    return to_slide + 180.0 + (info_.slide_centre ? 40.0 : 20.0);
  }

  void place_camera() {
    const double azimuth = chosen_azimuth() * std::numbers::pi / 180.0;
    const double elevation = (info_.dimensions == 2 ? 0.0 : options_.elevation) * std::numbers::pi / 180.0;
    const Vec3d towards{std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth), std::sin(elevation)};
    const double half_view = 13.0 * std::numbers::pi / 180.0;
    Vec3d middle = focus_middle();
    double distance = 0.0;
    for (int k = 0; k < 3; ++k) distance = fit(towards, half_view, middle);  // the fit moves the middle, too
    distance /= options_.zoom;
    vtkCamera* camera = renderer_->GetActiveCamera();
    camera->SetFocalPoint(middle.x, middle.y, middle.z);
    camera->SetPosition(middle.x + distance * towards.x, middle.y + distance * towards.y, middle.z + distance * towards.z);
    camera->SetViewUp(0.0, 0.0, 1.0);
    camera->SetViewAngle(2.0 * half_view * 180.0 / std::numbers::pi);
    renderer_->ResetCameraClippingRange();
    add_lights();
  }

  // The smallest distance from which every point of the focus fills no more than the middle of the picture (left of
  // the colour bar, below the title); moves `middle` to the middle of what is seen.
  double fit(const Vec3d& towards, double half_view, Vec3d& middle) const {
    const Vec3d side = cross(Vec3d{0, 0, 1}, towards) * (1.0 / std::max(1e-9, norm(cross(Vec3d{0, 0, 1}, towards))));
    const Vec3d up = cross(towards, side);
    const double tangent = std::tan(half_view), wide = tangent * options_.width / options_.height;
    std::vector<Vec3d> corner;
    for (const Vec3d& p : focus_) corner.push_back(p - middle);
    double distance = info_.dp;
    for (const Vec3d& c : corner) {
      const double toward_camera = dot(c, towards);
      distance = std::max({distance, toward_camera + std::abs(dot(c, side)) / (0.80 * wide), toward_camera + std::abs(dot(c, up)) / (0.80 * tangent)});
    }
    double left = 1e300, right = -1e300, low = 1e300, high = -1e300;
    for (const Vec3d& c : corner) {
      const double depth = distance - dot(c, towards), x = dot(c, side) / depth, y = dot(c, up) / depth;
      left = std::min(left, x), right = std::max(right, x), low = std::min(low, y), high = std::max(high, y);
    }
    middle = middle + side * (0.5 * (left + right) * distance) + up * (0.5 * (low + high) * distance);
    return distance;
  }

  void add_lights() {
    vtkNew<vtkLight> sun, sky;  // the sun stands to the left behind the camera
    sun->SetLightTypeToCameraLight();
    sun->SetPosition(-1.3, 1.2, 0.8);
    sun->SetIntensity(has_terrain() ? 0.98 : 0.55);
    sky->SetLightTypeToHeadlight();
    sky->SetIntensity(has_terrain() ? 0.12 : 0.55);
    renderer_->AddLight(sun);
    renderer_->AddLight(sky);
  }

  void save(const std::string& path) {
    vtkNew<vtkRenderWindow> window;
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(0);
    window->SetSize(supersampling * options_.width, supersampling * options_.height);
    window->AddRenderer(renderer_);
    window->Render();
    vtkNew<vtkWindowToImageFilter> grab;
    grab->SetInput(window);
    grab->SetInputBufferTypeToRGB();
    grab->ReadFrontBufferOff();
    grab->Update();
    vtkNew<vtkImageData> small;
    average(grab->GetOutput(), small);
    vtkNew<vtkPNGWriter> writer;
    const std::string aside = path + ".part";
    writer->SetFileName(aside.c_str());
    writer->SetInputData(small);
    writer->Write();
    if (writer->GetErrorCode() != 0 || !std::filesystem::exists(aside)) {
      throw Error(ErrorKind::resource, path + ": cannot be written");
    }
    std::filesystem::rename(aside, path);
  }

  static void average(vtkImageData* large, vtkImageData* small) {
    int size[3];
    large->GetDimensions(size);
    const int w = size[0] / supersampling, h = size[1] / supersampling;
    small->SetDimensions(w, h, 1);
    small->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        auto* out = static_cast<unsigned char*>(small->GetScalarPointer(x, y, 0));
        for (int c = 0; c < 3; ++c) {
          int sum = 0;
          for (int k = 0; k < supersampling * supersampling; ++k) {
            sum += static_cast<unsigned char*>(large->GetScalarPointer(x * supersampling + k % supersampling,
                                                                      y * supersampling + k / supersampling, 0))[c];
          }
          out[c] = static_cast<unsigned char>(sum / (supersampling * supersampling));
        }
      }
    }
  }

  const Frame& frame_;
  const RunInfo& info_;
  const PictureOptions& options_;
  std::vector<Vec3d> focus_;  // case coordinates, heights exaggerated
  vtkNew<vtkRenderer> renderer_;
  vtkNew<vtkLookupTable> water_colours_;
};

}  // namespace

void draw_picture(const Frame& frame, const RunInfo& info, const PictureOptions& options, const std::string& path) {
  Painter(frame, info, options).paint(path);
}

}  // namespace gdesp::analysis
