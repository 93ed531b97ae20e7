// SPDX-License-Identifier: GPL-3.0-or-later
// What the geometry tests share: a folder of their own, simple shapes, scenes built by hand.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "core/error.hpp"
#include "geometry/heightfield.hpp"
#include "geometry/triangle_mesh.hpp"

namespace gdesp::geometry::testing {

/// A fresh folder, removed at the end.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() /
              ("gdesp-geometry-" + std::to_string(::getpid()) + "-" + std::to_string(++count()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return file(name);
  }

 private:
  static int& count() {
    static int n = 0;
    return n;
  }
  std::filesystem::path path_;
};

/// A sphere of latitude and longitude bands; its volume is a little below 4/3 pi r^3.
inline TriangleMesh sphere(const Vec3d& centre, double radius, int bands) {
  const double pi = std::acos(-1.0);
  TriangleMesh m;
  const int around = 2 * bands;
  m.vertex.push_back(centre + Vec3d{0, 0, -radius});
  for (int b = 1; b < bands; ++b) {
    for (int a = 0; a < around; ++a) {
      const double t = pi * b / bands - 0.5 * pi, p = 2.0 * pi * a / around;
      m.vertex.push_back(
          centre + Vec3d{radius * std::cos(t) * std::cos(p), radius * std::cos(t) * std::sin(p), radius * std::sin(t)});
    }
  }
  m.vertex.push_back(centre + Vec3d{0, 0, radius});
  const auto at = [&](int b, int a) { return 1 + (b - 1) * around + a % around; };
  const auto last = static_cast<std::int32_t>(m.vertex.size() - 1);
  for (int a = 0; a < around; ++a) {
    m.triangle.push_back({0, at(1, a + 1), at(1, a)});
    for (int b = 1; b + 1 < bands; ++b) {
      m.triangle.push_back({at(b, a), at(b, a + 1), at(b + 1, a + 1)});
      m.triangle.push_back({at(b, a), at(b + 1, a + 1), at(b + 1, a)});
    }
    m.triangle.push_back({at(bands - 1, a), at(bands - 1, a + 1), last});
  }
  return m;
}

/// Elevations from a function.
inline Heightfield field(double x0, double y0, double d, int nx, int ny,
                         const std::function<double(double, double)>& z) {
  Heightfield f;
  f.x0 = x0, f.y0 = y0, f.dx = f.dy = d, f.nx = nx, f.ny = ny;
  f.z.resize(static_cast<std::size_t>(nx) * ny);
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) f.at(i, j) = z(x0 + i * d, y0 + j * d);
  }
  return f;
}

/// The message of the Error(input) that `action` throws; "" when it throws nothing.
inline std::string input_error(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::input) << e.what();
    return e.what();
  }
  return "";
}

#define EXPECT_MENTIONS(text, part) EXPECT_NE((text).find(part), std::string::npos) << "message: \"" << (text) << "\""

}  // namespace gdesp::geometry::testing
