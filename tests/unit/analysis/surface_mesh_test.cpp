// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/surface_mesh.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>

#include "exact_fields.hpp"
#include "io/frame.hpp"

namespace gdesp::analysis {
namespace {

using analysis_test::fill;

TEST(SurfaceMesh, SphereHasItsVolumeAndRadius) {
  const double dp = 0.05, radius = 0.5;
  const auto drop = fill({-0.6, -0.6, -0.6}, {0.6, 0.6, 0.6}, dp, 3, [&](const Vec3d& p) { return norm(p) < radius; });
  const SurfaceMesh mesh = extract_surface(drop, {}, {dp, 0.0});
  const double exact = static_cast<double>(drop.size()) * dp * dp * dp;
  EXPECT_NEAR(enclosed_volume(mesh), exact, 0.1 * exact);
  double sum = 0.0;
  for (const Vec3d& v : mesh.vertex) sum += norm(v);
  EXPECT_NEAR(sum / static_cast<double>(mesh.vertex.size()), radius, 0.25 * dp);
}

// Mean height of the upper surface of a block of still water, some layers deep, away from its edges; in dp, zero where
// it should be. `place`: of the particles among the voxels, dp.
double still_water_error(int layers, double place, double jitter) {
  const double dp = 0.1, top = layers * dp, lift = 1.3 * place * dp;
  auto water = fill(
      {0, 0, 0}, {2, 2, top}, dp, 3, [](const Vec3d&) { return true; }, jitter);
  for (Vec3d& p : water) p += Vec3d{place * dp, 0.7 * place * dp, lift};
  double sum = 0.0;
  int count = 0;
  for (const Vec3d& v : extract_surface(water, {}, {dp, 0.0}).vertex) {
    if (v.x < 0.5 || v.x > 1.5 || v.y < 0.5 || v.y > 1.5 || v.z < top - 0.5 * dp + lift) continue;
    sum += (v.z - top - lift) / dp;
    ++count;
  }
  return count >= 400 ? sum / count : 1e9;  // two vertices a dp and direction; fewer: a hole
}

TEST(SurfaceMesh, StillWaterAndASheetOneParticleThick) {
  for (const double place : {0.0, 0.13, 0.31}) {
    for (const double jitter : {0.0, 0.1, 0.2}) {
      EXPECT_NEAR(still_water_error(10, place, jitter), 0.0, 0.1) << place << ' ' << jitter;
      EXPECT_NEAR(still_water_error(1, place, jitter), 0.0, 0.15) << place << ' ' << jitter;
    }
  }
}

TEST(SurfaceMesh, VerticesTakeTheirParticlesVelocity) {
  const double dp = 0.1;
  const auto water = fill(
      {0, 0, 0}, {2, 2, 1}, dp, 3, [](const Vec3d&) { return true; }, 0.2);
  const std::vector<Vec3f> velocity(water.size(), Vec3f{1, 2, 2});
  const SurfaceMesh mesh = extract_surface(water, velocity, {dp, 0.0});
  ASSERT_EQ(mesh.velocity.size(), mesh.vertex.size());
  for (const Vec3f& v : mesh.velocity) EXPECT_NEAR(norm(v), 3.0, 1e-4);
}

TEST(SurfaceMesh, FilesAreReadBack) {
  const auto folder = std::filesystem::temp_directory_path() / "gdesp_surface_test";
  std::filesystem::create_directories(folder);
  const auto water = fill({0, 0, 0}, {1, 1, 1}, 0.1, 3, [](const Vec3d&) { return true; });
  const SurfaceMesh mesh = extract_surface(water, {}, {0.1, 0.0});
  write_surface_vtp(mesh, {10, 20, 30}, 1.5, (folder / "s.vtp").string());
  const TriangleTable back = read_triangles_vtp((folder / "s.vtp").string());
  EXPECT_EQ(back.triangle.size(), mesh.triangle.size());
  EXPECT_NEAR(norm(back.vertex[5] - mesh.vertex[5]), 0.0, 1e-6);
  write_surface_vdb(water, {0.1, 0.0}, {10, 20, 30}, 1.5, (folder / "s.vdb").string());
  EXPECT_GT(std::filesystem::file_size(folder / "s.vdb"), 1000u);
  std::filesystem::remove_all(folder);
}

TEST(SurfaceMesh, NoParticlesNoSurface) { EXPECT_TRUE(extract_surface({}, {}, {0.1, 0.0}).triangle.empty()); }

}  // namespace
}  // namespace gdesp::analysis
