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

TEST(SurfaceMesh, StillWaterAndASheetOneParticleThick) {
  const double dp = 0.1;
  auto water = fill({0, 0, 0}, {2, 2, 1}, dp, 3, [](const Vec3d&) { return true; });
  const auto sheet = fill({2, 0, 0}, {4, 2, dp}, dp, 3, [](const Vec3d&) { return true; });
  water.insert(water.end(), sheet.begin(), sheet.end());
  std::vector<Vec3f> velocity(water.size(), Vec3f{1, 2, 2});
  const SurfaceMesh mesh = extract_surface(water, velocity, {dp, 0.0});
  double top = -1, sheet_top = -1, count = 0, sheet_count = 0;
  for (const Vec3d& v : mesh.vertex) {
    if (v.y < 0.5 || v.y > 1.5) continue;
    if (v.x > 0.5 && v.x < 1.5 && v.z > 0.8) top = count == 0 ? v.z : top + v.z, ++count;
    if (v.x > 2.8 && v.x < 3.5 && v.z > 0.05) sheet_top = sheet_count == 0 ? v.z : sheet_top + v.z, ++sheet_count;
  }
  ASSERT_GT(count, 10);
  ASSERT_GT(sheet_count, 10) << "the sheet has no hole";
  EXPECT_NEAR(top / count, 1.0, 0.25 * dp);
  EXPECT_NEAR(sheet_top / sheet_count, dp, 0.35 * dp);
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
