// SPDX-License-Identifier: GPL-3.0-or-later
// make_case CASE [dp] [KIND...]: a small dam break in the plane x-z (tank 0.4 m x 0.3 m, column 0.1 m x 0.2 m), written
// without mesh2particles. Kinds: 3d (tank 0.1 m wide), gate (a plate that rises), grains (a block of them in the
// column), exploding (water that starts with an absurd velocity).
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>

#include "../../support/surfaces.hpp"
#include "core/error.hpp"
#include "io/case.hpp"

namespace {

using namespace gdesp;

struct Maker {
  double dp;
  bool three;
  Case c;

  template <class Visit>
  void lattice(const Vec3d& low, const Vec3d& high, const Visit& visit) const {
    const auto count = [&](double a, double b) { return static_cast<int>(std::lround((b - a) / dp)); };
    for (int i = 0; i < count(low.x, high.x); ++i)
      for (int j = 0; j < (three ? count(low.y, high.y) : 1); ++j)
        for (int k = 0; k < count(low.z, high.z); ++k)
          visit(Vec3d{low.x + (i + 0.5) * dp, three ? low.y + (j + 0.5) * dp : 0.0, low.z + (k + 0.5) * dp});
  }

  void wall(const Vec3d& r, std::int32_t body, float depth) {
    c.boundary.position.push_back(r);
    c.boundary.normal.push_back({0, 0, 0});
    c.boundary.depth.push_back(depth);
    c.boundary.friction.push_back(0.0f);
    c.boundary.body.push_back(body);
  }

  void tank(const Vec3d& size) {
    const double t = 3 * dp;
    const double y0 = three ? -t : 0.0, y1 = three ? size.y + t : 0.0;
    lattice({-t, y0, -t}, {size.x + t, y1, size.z}, [&](const Vec3d& r) {
      const bool inside = r.x > 0 && r.x < size.x && r.z > 0 && (!three || (r.y > 0 && r.y < size.y));
      if (!inside) wall(r, 0, static_cast<float>(0.5 * dp));
    });
    const double w = three ? size.y : 1.0;
    const auto quad = [&](const Vec3d& a, const Vec3d& b, const Vec3d& d, const Vec3d& e, std::int32_t body) {
      test::add_rectangle(c.walls, a, b, d, e, body);
    };
    const double lo = three ? 0.0 : -0.5;
    quad({0, lo, 0}, {size.x, lo, 0}, {size.x, lo + w, 0}, {0, lo + w, 0}, 0);
    quad({0, lo, 0}, {0, lo + w, 0}, {0, lo + w, size.z}, {0, lo, size.z}, 0);
    quad({size.x, lo, 0}, {size.x, lo, size.z}, {size.x, lo + w, size.z}, {size.x, lo + w, 0}, 0);
    if (three) {
      quad({0, 0, 0}, {0, 0, size.z}, {size.x, 0, size.z}, {size.x, 0, 0}, 0);
      quad({0, w, 0}, {size.x, w, 0}, {size.x, w, size.z}, {0, w, size.z}, 0);
    }
    if (c.bodies.empty()) return;
    quad({0.1, lo, 0}, {0.1, lo + w, 0}, {0.1, lo + w, 0.22}, {0.1, lo, 0.22}, 1);
    lattice({0.1, 0.0, 0.0}, {0.1 + 2 * dp, size.y, 0.22},
            [&](const Vec3d& r) { wall(r, 1, static_cast<float>(0.5 * dp)); });
  }

  void gate() {
    Body gate;
    gate.name = "gate";
    gate.centre = {0.1 + dp, 0.0, 0.11};
    gate.motion.time = {0.02, 0.22};
    gate.motion.displacement = {{0, 0, 0}, {0, 0, 0.3}};
    c.bodies.push_back(gate);
  }

  void grains(double diameter) {
    Slide slide;
    slide.diameter = diameter;
    slide.shape.box = Box{{0, 0, 0}, {0.08, 0.1, 0.06}};
    c.scene.slides.push_back(slide);
    const double keep = dp;
    dp = diameter * 1.001;
    lattice({0.002, 0.002, 0.001}, {0.08, 0.098, 0.06}, [&](const Vec3d& r) {
      c.grains.position.push_back(r);
      c.grains.diameter.push_back(static_cast<float>(diameter));
      c.grains.density.push_back(2650.0f);
      c.grains.group.push_back(0);
    });
    dp = keep;
  }
};

Case make(double dp, const std::set<std::string>& kinds) {
  Maker m{dp, kinds.count("3d") > 0, {}};
  const Vec3d size{0.4, 0.1, 0.3};
  m.c.scene.title = "small dam break";
  m.c.scene.dimensions = m.three ? 3 : 2;
  m.c.scene.dp = dp;
  m.c.scene.time.end = m.three ? 0.1 : 0.2;
  m.c.scene.time.output_interval = 0.25 * m.c.scene.time.end;
  m.c.domain = {{-4 * dp, m.three ? -4 * dp : -dp, -4 * dp},
                {size.x + 4 * dp, m.three ? size.y + 4 * dp : dp, 2 * size.z}};
  m.c.scene.domain = m.c.domain;
  m.c.still_water_level = 0.2;
  if (kinds.count("gate")) m.gate();
  m.tank(size);
  m.lattice({0, 0, 0}, {0.1, size.y, 0.2}, [&](const Vec3d& r) { m.c.fluid.position.push_back(r); });
  if (kinds.count("grains")) m.grains(0.006);
  if (kinds.count("exploding")) m.c.fluid.velocity.assign(m.c.fluid.position.size(), Vec3f{1e19f, 0, 1e19f});
  return m.c;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "make_case CASE [DP] [KIND...]\n"), 2;
  std::set<std::string> kinds;
  for (int k = 3; k < argc; ++k) kinds.insert(argv[k]);
  try {
    gdesp::write_case(argv[1], make(argc > 2 ? std::atof(argv[2]) : 0.01, kinds), true);
    return 0;
  } catch (const gdesp::Error& e) { return std::fprintf(stderr, "make_case: %s\n", e.what()), e.exit_code(); }
}
