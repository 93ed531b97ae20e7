// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/picture.hpp"

#include <vtkAutoInit.h>
#include <vtkCamera.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "analysis/picture_parts.hpp"
#include "analysis/table.hpp"
#include "io/safe_file.hpp"

VTK_MODULE_INIT(vtkRenderingOpenGL2)
VTK_MODULE_INIT(vtkRenderingFreeType)

namespace gdesp::analysis {
namespace {

constexpr double bar_share = 0.115;  // of the picture's width, for the colour bar
const char* const font_file = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

class Painter {
 public:
  Painter(const Frame& frame, const RunInfo& info, const PictureOptions& options)
      : frame_(frame), info_(info), options_(options), scene_{renderer_, frame, info, options.vertical_exaggeration} {
    for (vtkRenderer* r : {renderer_.Get(), side_.Get()}) {
      r->SetBackground(0.90, 0.93, 0.96);
      r->SetBackground2(1.0, 1.0, 1.0);
      r->GradientBackgroundOn();
    }
    renderer_->SetViewport(0, 0, 1.0 - bar_share, 1);
    side_->SetViewport(1.0 - bar_share, 0, 1, 1);
  }

  void paint(const std::string& path) {
    find_focus();
    add_ground(scene_);
    fill_speed_colours(colours_, water_speed_limit());
    if (add_water(scene_, colours_)) add_colour_bar();
    add_slide(scene_);
    add_text();
    info_.dimensions == 2 ? place_flat_camera() : place_camera();
    save(path);
  }

 private:
  bool has_terrain() const { return scene_.has_terrain(); }
  double aspect() const { return (1.0 - bar_share) * options_.width / options_.height; }

  // What must be in the picture: some hundred particles of the water (of a lake its surface), the slide and where it
  // came from; in a tank the tank.
  void find_focus() {
    const auto take = [&](const std::vector<Vec3d>& points, double floor) {
      const std::size_t step = points.size() / 1000 + 1;
      for (std::size_t k = 0; k < points.size(); k += step)
        focus_.push_back({points[k].x, points[k].y, std::max(points[k].z, floor)});
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
    const auto [low, high] =
        std::minmax_element(focus_.begin(), focus_.end(), [](const Vec3d& a, const Vec3d& b) { return a.z < b.z; });
    return high->z - low->z;
  }

  Vec3d focus_middle() const {
    Vec3d sum;
    for (const Vec3d& p : focus_) sum += p;
    return sum * (1.0 / static_cast<double>(focus_.size()));
  }

  double water_speed_limit() const {
    if (options_.speed_max > 0.0) return options_.speed_max;
    std::vector<float> speed;
    for (const Vec3f& v : frame_.fluid.velocity) speed.push_back(norm(v));
    if (speed.empty()) return 1.0;
    const auto at = speed.begin() + static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(speed.size() - 1));
    std::nth_element(speed.begin(), at, speed.end());
    const double slowest = 0.02 * std::sqrt(info_.gravity() * std::max(focus_height(), info_.dp));  // all but at rest
    const double raw = std::max({static_cast<double>(*at), slowest, 1e-3});
    const double unit = std::pow(10.0, std::floor(std::log10(raw)));
    for (const double m : {1.0, 2.0, 4.0, 5.0, 8.0, 10.0}) {  // four steps with round numbers
      if (m * unit >= raw) return m * unit;
    }
    return 10.0 * unit;
  }

  void add_colour_bar() {
    vtkNew<vtkScalarBarActor> bar;
    bar->SetLookupTable(colours_);
    bar->SetTitle("");
    bar->SetNumberOfLabels(5);
    bar->SetLabelFormat("%.3g");
    bar->UnconstrainedFontSizeOn();
    bar->SetBarRatio(0.28);
    bar->SetPosition(0.10, 0.14);
    bar->SetPosition2(0.80, 0.56);
    bar->DrawFrameOff();
    style(bar->GetLabelTextProperty(), 19);
    side_->AddActor2D(bar);
    put_text(side_, "water speed\n(m/s)", 0.10, 0.745, 19);
  }

  void style(vtkTextProperty* text, int size) const {
    if (std::filesystem::exists(font_file)) {
      text->SetFontFamily(VTK_FONT_FILE);
      text->SetFontFile(font_file);
    } else {
      text->SetFontFamilyToArial();
    }
    text->SetFontSize(supersampling * size * options_.height / 1000);
    text->SetColor(0.1, 0.1, 0.1);
    text->ItalicOff();
    text->BoldOff();
    text->ShadowOff();
  }

  void put_text(vtkRenderer* where, const std::string& text, double x, double y, int size) const {
    vtkNew<vtkTextActor> actor;
    actor->SetInput(text.c_str());
    actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
    actor->SetPosition(x, y);
    style(actor->GetTextProperty(), size);
    where->AddActor2D(actor);
  }

  void add_text() {
    const std::string name = !options_.title.empty()      ? options_.title
                             : !info_.scene.title.empty() ? info_.scene.title
                                                          : info_.name;
    char time[64];
    std::snprintf(time, sizeof time, "t = %.4g s", frame_.time);
    put_text(renderer_, name, 0.02, 0.940, 27);
    put_text(renderer_, time, 0.02, 0.895, 24);
    std::string small = "particle spacing " + format_number(info_.dp) + " m";
    if (!frame_.grains.position.empty() || !frame_.bodies.triangle.empty()) small += "   ·   orange: slide";
    if (info_.still_water_level && has_terrain()) small += "   ·   blue line: still-water shore";
    if (options_.vertical_exaggeration != 1.0)
      small += "   ·   heights x " + format_number(options_.vertical_exaggeration);
    put_text(renderer_, small, 0.02, 0.862, 18);
  }

  // Where the camera stands: on the far side of the lake, turned a little, so that the slide and both banks show.
  double chosen_azimuth() const {
    if (options_.azimuth) return *options_.azimuth;
    const Vec3d middle = focus_middle();
    const Vec3d slide = info_.slide_centre ? *info_.slide_centre : middle + Vec3d{0, 1, 0};
    const Vec3d lake{info_.lake.centre.x, info_.lake.centre.y, 0.0};
    const double to_slide = std::atan2(slide.x - lake.x, slide.y - lake.y) * 180.0 / std::numbers::pi;
    return to_slide + 180.0 + (info_.slide_centre ? 40.0 : 20.0);
  }

  void place_camera() {
    const double azimuth = chosen_azimuth() * std::numbers::pi / 180.0;
    const double elevation = options_.elevation * std::numbers::pi / 180.0;
    const Vec3d towards{std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth),
                        std::sin(elevation)};
    const double half_view = 13.0 * std::numbers::pi / 180.0;
    Vec3d middle = focus_middle();
    double distance = 0.0;
    for (int k = 0; k < 3; ++k) distance = fit(towards, half_view, middle);  // the fit moves the middle, too
    distance /= options_.zoom;
    vtkCamera* camera = renderer_->GetActiveCamera();
    camera->SetFocalPoint(middle.x, middle.y, middle.z);
    camera->SetPosition(middle.x + distance * towards.x, middle.y + distance * towards.y,
                        middle.z + distance * towards.z);
    camera->SetViewUp(0.0, 0.0, 1.0);
    camera->SetViewAngle(2.0 * half_view * 180.0 / std::numbers::pi);
    renderer_->ResetCameraClippingRange();
    add_lights();
  }

  // The plane x-z seen along y, without perspective.
  void place_flat_camera() {
    Vec3d low = focus_[0], high = focus_[0];
    for (const Vec3d& p : focus_) {
      for (int axis = 0; axis < 3; ++axis)
        low[axis] = std::min(low[axis], p[axis]), high[axis] = std::max(high[axis], p[axis]);
    }
    const Vec3d middle = (low + high) * 0.5, size = high - low;
    const double half = 0.5 * std::max(size.z / 0.78, size.x / (0.92 * aspect())) / options_.zoom;
    vtkCamera* camera = renderer_->GetActiveCamera();
    camera->ParallelProjectionOn();
    camera->SetParallelScale(half);
    camera->SetFocalPoint(middle.x, middle.y, middle.z);
    camera->SetPosition(middle.x, middle.y - 10.0 * (half + size.y), middle.z);
    camera->SetViewUp(0.0, 0.0, 1.0);
    renderer_->ResetCameraClippingRange();
    add_lights();
  }

  // The smallest distance from which every point of the focus fills no more than the middle of the picture (below the
  // title); moves `middle` to the middle of what is seen.
  double fit(const Vec3d& towards, double half_view, Vec3d& middle) const {
    const Vec3d side = cross(Vec3d{0, 0, 1}, towards) * (1.0 / std::max(1e-9, norm(cross(Vec3d{0, 0, 1}, towards))));
    const Vec3d up = cross(towards, side);
    const double tangent = std::tan(half_view), wide = tangent * aspect();
    std::vector<Vec3d> corner;
    for (const Vec3d& p : focus_) corner.push_back(p - middle);
    double distance = info_.dp;
    for (const Vec3d& c : corner) {
      const double toward_camera = dot(c, towards);
      distance = std::max({distance, toward_camera + std::abs(dot(c, side)) / (0.88 * wide),
                           toward_camera + std::abs(dot(c, up)) / (0.80 * tangent)});
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
    sun->SetPosition(-1.6, 1.1, 0.7);
    sun->SetIntensity(has_terrain() ? 1.0 : 0.55);
    sky->SetLightTypeToHeadlight();
    sky->SetIntensity(has_terrain() ? 0.14 : 0.55);
    renderer_->AddLight(sun);
    renderer_->AddLight(sky);
  }

  void save(const std::string& path) {
    vtkNew<vtkRenderWindow> window;
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(0);
    window->SetSize(supersampling * options_.width, supersampling * options_.height);
    window->AddRenderer(renderer_);
    window->AddRenderer(side_);
    window->Render();
    vtkNew<vtkWindowToImageFilter> grab;
    grab->SetInput(window);
    grab->SetInputBufferTypeToRGB();
    grab->ReadFrontBufferOff();
    grab->Update();
    vtkNew<vtkImageData> small;
    average(grab->GetOutput(), small);
    vtkNew<vtkPNGWriter> writer;
    writer->WriteToMemoryOn();
    writer->SetInputData(small);
    writer->Write();
    vtkUnsignedCharArray* bytes = writer->GetResult();
    SafeFile file(path);
    file.write(bytes->GetPointer(0), static_cast<std::size_t>(bytes->GetNumberOfValues()));
    file.commit();
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
  vtkNew<vtkRenderer> renderer_, side_;
  vtkNew<vtkLookupTable> colours_;
  PictureScene scene_;
};

}  // namespace

void draw_picture(const Frame& frame, const RunInfo& info, const PictureOptions& options, const std::string& path) {
  Painter(frame, info, options).paint(path);
}

}  // namespace gdesp::analysis
