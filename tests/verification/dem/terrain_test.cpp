// SPDX-License-Identifier: GPL-3.0-or-later
// Grains dropped anywhere on a real valley (Alpe Gera) never get through it: also onto vertices and edges, also fast.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "../../unit/dem/grain_scene.hpp"
#include "exec/parallel.hpp"

namespace gdesp::dem::test {
namespace {

constexpr double diameter = 4.0;  // m

/// Heights at nodes, the first row in the south; the coordinates of the south-western node are 0.
struct Valley {
  int nx = 0, ny = 0;
  double spacing = 0.0, lowest = 1e300, highest = -1e300;
  std::vector<double> z;

  Valley() {
    std::ifstream in(std::string(GDESP_CASES) + "/alpe-gera/valley.asc");
    std::string word;
    double x, y, gap;
    in >> word >> nx >> word >> ny >> word >> x >> word >> y >> word >> spacing >> word >> gap;
    z.resize(static_cast<std::size_t>(nx) * ny);
    for (int j = ny - 1; j >= 0; --j) {
      for (int i = 0; i < nx; ++i) {
        double& h = z[index(i, j)];
        in >> h;
        if (h == gap) h = NAN;
        if (!std::isnan(h)) lowest = std::min(lowest, h), highest = std::max(highest, h);
      }
    }
    EXPECT_TRUE(in.good() || in.eof());
  }
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(j) * nx + i; }
  bool whole(int i, int j) const {
    if (i < 0 || j < 0 || i + 1 >= nx || j + 1 >= ny) return false;
    return !std::isnan(z[index(i, j)] + z[index(i + 1, j)] + z[index(i, j + 1)] + z[index(i + 1, j + 1)]);
  }

  TriangleTable mesh() const {
    TriangleTable t;
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i)
        t.vertex.push_back({i * spacing, j * spacing, std::isnan(z[index(i, j)]) ? 0.0 : z[index(i, j)]});
    }
    const auto at = [&](int i, int j) { return static_cast<std::int32_t>(index(i, j)); };
    for (int j = 0; j + 1 < ny; ++j) {
      for (int i = 0; i + 1 < nx; ++i) {
        if (!whole(i, j)) continue;
        t.triangle.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        t.triangle.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
    t.body.assign(t.triangle.size(), 0);
    return t;
  }

  /// Height of the triangles at a place; NaN beside them.
  double ground(double x, double y) const {
    const double a = x / spacing, b = y / spacing;
    const int i = static_cast<int>(std::floor(a)), j = static_cast<int>(std::floor(b));
    if (!whole(i, j)) return NAN;
    const double u = a - i, v = b - j, z00 = z[index(i, j)], z11 = z[index(i + 1, j + 1)];
    return u >= v ? z00 + u * (z[index(i + 1, j)] - z00) + v * (z11 - z[index(i + 1, j)])
                  : z00 + v * (z[index(i, j + 1)] - z00) + u * (z11 - z[index(i, j + 1)]);
  }
};

/// Five hundred grains: every fourth above a vertex, every fourth above a diagonal edge, the others anywhere; a third of them fast.
GrainTable dropped(const Valley& valley) {
  Random random(7);
  GrainTable table;
  while (table.position.size() < 500) {
    const std::size_t k = table.position.size();
    double x = (1.0 + random() * (valley.nx - 3)) * valley.spacing;
    double y = (1.0 + random() * (valley.ny - 3)) * valley.spacing;
    if (k % 4 < 2) {
      const double half = k % 4 == 0 ? 0.0 : 0.5;
      x = (std::floor(x / valley.spacing) + half) * valley.spacing;
      y = (std::floor(y / valley.spacing) + half) * valley.spacing;
    }
    const double ground = valley.ground(x, y);
    if (std::isnan(ground)) continue;
    const Vec3d velocity = k % 3 == 0 ? Vec3d{20.0 * (random() - 0.5), 20.0 * (random() - 0.5), -60.0} : Vec3d{};
    add_grain(table, {x, y, ground + diameter + 40.0 * random()}, diameter, 2650, velocity);
  }
  return table;
}

TEST(Terrain, NoGrainGetsThrough) {
  exec::set_threads(1);
  const Valley valley;
  ContactParameters p;
  p.youngs_modulus = 1.0e8;
  p.restitution = 0.5;
  p.friction = 0.3;
  Grains grains({},
                space({0, 0, valley.lowest - 300},
                      {valley.nx * valley.spacing, valley.ny * valley.spacing, valley.highest + 200}, diameter),
                dropped(valley), p, valley.mesh(), {0, 0, -9.81});
  const double interval = 0.1;  // s: a grain that got through is far from the lower end of the domain at the next look
  const int substeps = static_cast<int>(std::ceil(interval / grains.stable_time_step(0.2)));
  double deepest = -1e300;  // m, of a grain's lowest point below the ground under its centre
  std::size_t over = 0;
  for (int k = 0; k < 100; ++k) {
    grains.advance(interval, substeps);
    const GrainTable now = grains.table();
    over = 0;
    for (const auto& at : now.position) {
      const double ground = valley.ground(at.x, at.y);
      if (std::isnan(ground)) continue;  // beside the terrain
      ++over;
      deepest = std::max(deepest, ground - at.z);
      ASSERT_GT(at.z, ground) << "at " << at.x << ", " << at.y << " after " << 0.1 * (k + 1) << " s";
    }
  }
  EXPECT_GT(over, 350u) << "most must still be there to say something";
  RecordProperty("deepest_centre_m", std::to_string(deepest));
}

}  // namespace
}  // namespace gdesp::dem::test
