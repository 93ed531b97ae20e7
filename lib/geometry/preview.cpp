// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/preview.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "core/error.hpp"
#include "geometry/triangle_mesh.hpp"
#include "io/vtp_writer.hpp"

namespace gdesp::geometry {
namespace {

enum Kind : std::int32_t { fluid_kind = 0, wall_kind = 1, grain_kind = 2, body_kind = 3 };

struct Sample {
  Vec3d at;
  std::int32_t kind;
};

std::vector<Sample> all_particles(const Case& c) {
  std::vector<Sample> out;
  out.reserve(c.fluid.position.size() + c.boundary.position.size() + c.grains.position.size());
  for (const auto& p : c.fluid.position) out.push_back({p, fluid_kind});
  for (std::size_t k = 0; k < c.boundary.position.size(); ++k) {
    out.push_back({c.boundary.position[k], c.boundary.body[k] > 0 ? body_kind : wall_kind});
  }
  for (const auto& p : c.grains.position) out.push_back({p, grain_kind});
  return out;
}

void write_points(const Case& c, const std::string& path) {
  std::vector<Vec3d> position;
  std::vector<std::int32_t> kind;
  for (const auto& s : all_particles(c)) {
    position.push_back(s.at + c.offset);
    kind.push_back(s.kind);
  }
  VtpContent content;
  content.position = &position;
  content.points.push_back(vtp_array("kind", kind));
  write_vtp(path, content);
}

struct Colour {
  int r, g, b;
};

/// A picture of coloured cells, axes in scene coordinates.
class Image {
 public:
  Image(double u0, double v0, double u1, double v1, double cell)
      : u0_(u0 - 0.5 * cell), v0_(v0 - 0.5 * cell), cell_(cell) {
    nu_ = std::max(1, static_cast<int>((u1 - u0_) / cell) + 1);
    nv_ = std::max(1, static_cast<int>((v1 - v0_) / cell) + 1);
    colour_.assign(static_cast<std::size_t>(nu_) * nv_, {255, 255, 255});
    rank_.assign(colour_.size(), -1e300);
  }
  /// The highest rank stays.
  void put(double u, double v, double rank, Colour c) {
    const int i = static_cast<int>((u - u0_) / cell_), j = static_cast<int>((v - v0_) / cell_);
    if (i < 0 || j < 0 || i >= nu_ || j >= nv_) return;
    const std::size_t k = static_cast<std::size_t>(j) * nu_ + i;
    if (rank < rank_[k]) return;
    rank_[k] = rank;
    colour_[k] = c;
  }
  void print(FILE* out) const {
    for (int j = 0; j < nv_; ++j) {
      for (int i = 0; i < nu_; ++i) {
        const Colour& c = colour_[static_cast<std::size_t>(j) * nu_ + i];
        std::fprintf(out, "%.9g %.9g %d %d %d\n", u0_ + (i + 0.5) * cell_, v0_ + (j + 0.5) * cell_, c.r, c.g, c.b);
      }
    }
    std::fputs("e\n", out);
  }

 private:
  double u0_, v0_, cell_;
  int nu_, nv_;
  std::vector<Colour> colour_;
  std::vector<double> rank_;
};

Colour colour_of(const Sample& s, const Box& box) {
  const double t = (s.at.z - box.lower.z) / std::max(1e-300, box.upper.z - box.lower.z);
  if (s.kind == fluid_kind) return {40, 110 + static_cast<int>(60 * t), 215};
  if (s.kind == grain_kind) return {190, 95, 30};
  if (s.kind == body_kind) return {200, 30, 60};
  const int grey = 90 + static_cast<int>(140 * t);
  return {grey, grey, grey - 10};
}

double cell_size(double width, double height, double dp) {
  return std::max(1.01 * dp, std::max(width, height) / 500.0);
}

/// The plane of the section: through the grains' middle, from them towards the water; without grains along the water's longer side.
struct SectionPlane {
  bool along_x;
  double at;
};
SectionPlane section_plane(const Case& c) {
  Box water = empty_box(), grains = empty_box();
  for (const auto& p : c.fluid.position) extend(water, p);
  for (const auto& p : c.grains.position) extend(grains, p);
  if (is_empty(water)) water = c.domain;
  const Box& through = is_empty(grains) ? water : grains;
  const Vec3d apart = is_empty(grains) ? extent(water) : (grains.lower + grains.upper) - (water.lower + water.upper);
  const bool along_x = c.scene.dimensions == 2 || std::abs(apart.x) >= std::abs(apart.y);
  const int across = along_x ? 1 : 0;
  return {along_x, 0.5 * (through.lower[across] + through.upper[across])};
}

constexpr double picture_width = 1150.0, picture_height = 520.0;  // px, room of one plot inside its labels

/// Distance of an axis' labels (m): the smallest of 1, 2, 5 times a power of ten at which labels of this size do not touch.
double label_step(double length, double pixels, double label_pixels) {
  const double least = std::max(length * label_pixels / pixels, 1e-300);
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double m : {1.0, 2.0, 5.0}) {
    if (m * power >= least) return m * power;
  }
  return 10.0 * power;
}

/// Both axes at one scale, with as many labels as have room; coordinates in full, as large as UTM's.
void set_axes(FILE* out, const char* u_name, const char* v_name, double u0, double v0, double u1, double v1) {
  const double scale =
      std::min(picture_width / std::max(u1 - u0, 1e-300), picture_height / std::max(v1 - v0, 1e-300));  // px per m
  const double digits = std::floor(std::log10(std::max({std::abs(u0), std::abs(u1), 1.0}))) + 1.0;
  const double decimals = std::max(0.0, std::ceil(-std::log10((u1 - u0) / 10.0)));
  const double u_step = label_step(u1 - u0, (u1 - u0) * scale, 9.0 * (digits + decimals + 3.0));
  const double v_step = label_step(v1 - v0, (v1 - v0) * scale, 24.0);
  std::fprintf(out, "set size ratio -1\nset xlabel '%s [m]'\nset ylabel '%s [m]'\nset xtics %.9g\nset ytics %.9g\n",
               u_name, v_name, u_step, v_step);
}

void draw(FILE* out, const Case& c, const std::string& path) {
  const auto particles = all_particles(c);
  Box box = empty_box();
  for (const auto& s : particles) extend(box, s.at);
  if (is_empty(box)) box = c.domain;
  const SectionPlane plane = section_plane(c);
  const int u = plane.along_x ? 0 : 1, across = 1 - u;
  const double half = 0.75 * c.scene.dp;
  const double plan_cell = cell_size(box.upper.x - box.lower.x, box.upper.y - box.lower.y, c.scene.dp);
  const double side_cell = cell_size(box.upper[u] - box.lower[u], box.upper.z - box.lower.z, c.scene.dp);
  Image plan(box.lower.x + c.offset.x, box.lower.y + c.offset.y, box.upper.x + c.offset.x, box.upper.y + c.offset.y,
             plan_cell);
  Image side(box.lower[u] + c.offset[u], box.lower.z + c.offset.z, box.upper[u] + c.offset[u], box.upper.z + c.offset.z,
             side_cell);
  for (const auto& s : particles) {
    const Vec3d p = s.at + c.offset;
    const Colour colour = colour_of(s, box);
    plan.put(p.x, p.y, p.z + (s.kind == wall_kind ? 0.0 : 2.0 * c.scene.dp), colour);
    if (std::abs(s.at[across] - plane.at) <= half) side.put(p[u], p.z, s.kind == grain_kind ? 1.0 : 0.0, colour);
  }
  const char* const name = plane.along_x ? "x" : "y";
  const Box shown{box.lower + c.offset, box.upper + c.offset};
  std::fprintf(out, "set terminal pngcairo size 1400,%d\nset output '%s'\nunset key\nset format '%%.10g'\n",
               c.scene.dimensions == 2 ? 700 : 1500, path.c_str());
  if (c.scene.dimensions == 3) {
    std::fputs("set multiplot layout 2,1\n", out);
    set_axes(out, "x", "y", shown.lower.x, shown.lower.y, shown.upper.x, shown.upper.y);
    std::fputs(
        "set title 'from above: ground grey, water blue, grains brown, bodies red'\nplot '-' using 1:2:3:4:5 with "
        "rgbimage\n",
        out);
    plan.print(out);
  }
  set_axes(out, name, "z", shown.lower[u], shown.lower.z, shown.upper[u], shown.upper.z);
  std::fprintf(out, "set title 'vertical section at %s = %.8g m'\nplot '-' using 1:2:3:4:5 with rgbimage\n",
               plane.along_x ? "y" : "x", plane.at + c.offset[across]);
  side.print(out);
  if (c.scene.dimensions == 3) std::fputs("unset multiplot\n", out);
}

}  // namespace

void write_preview(const Case& c, const std::string& path) {
  if (std::filesystem::path(path).extension() == ".vtp") return write_points(c, path);
  const std::string aside = path + ".part-" + std::to_string(::getpid());
  FILE* gnuplot = ::popen("gnuplot 2>/dev/null", "w");
  if (!gnuplot)
    throw Error(ErrorKind::resource, "gnuplot cannot be started; it draws the preview (package gnuplot-nox)");
  draw(gnuplot, c, aside);
  const int status = ::pclose(gnuplot);
  std::error_code failed;
  if (status == 0) std::filesystem::rename(aside, path, failed);
  if (status != 0 || failed) {
    std::error_code ignored;
    std::filesystem::remove(aside, ignored);
    throw Error(ErrorKind::resource,
                path + ": the preview could not be drawn (gnuplot ended with status " + std::to_string(status) + ")");
  }
}

}  // namespace gdesp::geometry
