// SPDX-License-Identifier: GPL-3.0-or-later
// make_run CASE RUN [DP [FRAMES]]: a case and a run whose run-up, levels and slide are known exactly, for the tests
// of surge-analyze (and as an example of how another program writes frames).
//
// A V-shaped valley, bed z = |x| / 2, y from 0 to 160 m, still water at z = 30 m, far from the origin (UTM). The
// water's surface is tilted, z = 30 + s(y, t) x with s = 0.15 sin(pi y / 160) sin(2 pi t / 20); it ends on the bank
// x > 0 where x/2 = 30 + s x, so the run-up is R = s x = 30 s / (1/2 - s): 12.857 m at y = 80, t = 5.
// A ball of grains slides down the bank x < 0.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "core/error.hpp"
#include "io/case.hpp"
#include "io/frame.hpp"

namespace {

using namespace gdesp;

constexpr double length = 160.0, still = 30.0, wide = 120.0;
const Vec3d offset{568000.0, 5120000.0, 2095.0};

double tilt(double y, double t) {
  return 0.15 * std::sin(std::numbers::pi * y / length) * std::sin(2.0 * std::numbers::pi * t / 20.0);
}

FluidTable water_at(double t, double dp) {
  FluidTable w;
  const double h0 = still;
  for (double x = -wide + 0.5 * dp; x < wide; x += dp) {
    for (double y = 0.5 * dp; y < length; y += dp) {
      const double bed = 0.5 * std::abs(x), eta = h0 + tilt(y, t) * x;
      const int layers = static_cast<int>(std::round((eta - bed) / dp));
      for (int k = 0; k < layers; ++k) {
        const double z = bed + (eta - bed) * (k + 0.5) / layers;
        w.position.push_back({x, y, z});
        w.velocity.push_back({static_cast<float>(3.0 * std::cos(2.0 * std::numbers::pi * t / 20.0)), 0.0f, 0.0f});
        w.density.push_back(1000.0f);
        w.pressure.push_back(static_cast<float>(9810.0 * (eta - z)));
        w.id.push_back(static_cast<std::uint32_t>(w.id.size()));
      }
    }
  }
  w.position.push_back({20.0, 80.0, 75.0});  // a drop in the air
  w.velocity.push_back({0, 0, 5});
  w.density.push_back(1000.0f);
  w.pressure.push_back(0.0f);
  w.id.push_back(static_cast<std::uint32_t>(w.id.size()));
  return w;
}

GrainTable slide_at(double t, double dp) {
  GrainTable g;
  const double d = 0.8 * dp, radius = 12.0;
  const Vec3d centre{-100.0 + 3.0 * t, 80.0, 64.0 - 1.5 * t};
  for (double x = -radius; x <= radius; x += d) {
    for (double y = -radius; y <= radius; y += d) {
      for (double z = -radius; z <= radius; z += d) {
        if (x * x + y * y + z * z > radius * radius) continue;
        g.position.push_back(centre + Vec3d{x, y, z});
        g.diameter.push_back(static_cast<float>(d));
        g.density.push_back(2650.0f);
        g.velocity.push_back({3.0f, 0.0f, -1.5f});
        g.angular_velocity.push_back({0, 0, 0});
        g.group.push_back(0);
        g.id.push_back(static_cast<std::uint32_t>(g.id.size()));
      }
    }
  }
  return g;
}

TriangleTable valley() {
  TriangleTable t;
  const int nx = 24, ny = 16;
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      const double x = -150.0 + 300.0 * i / nx, y = length * j / ny;
      t.vertex.push_back({x, y, 0.5 * std::abs(x)});
    }
  }
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const std::int32_t a = j * (nx + 1) + i, b = a + 1, c = a + nx + 1, d = c + 1;
      t.triangle.push_back({a, b, d});
      t.triangle.push_back({a, d, c});
    }
  }
  t.body.assign(t.triangle.size(), 0);
  return t;
}

Case valley_case(double dp) {
  Case c;
  c.scene.title = "V-shaped valley";
  c.scene.dp = dp;
  c.scene.domain = Box{Vec3d{-150, 0, -5} + offset, Vec3d{150, length, 100} + offset};
  FluidFill fill;
  fill.level = still + offset.z;
  fill.seed = Point2{offset.x, offset.y + 80.0};
  c.scene.fluid.fill.push_back(fill);
  c.scene.gauges.push_back({"middle", Vec3d{40, 80, 25} + offset, true});
  c.scene.gauges.push_back({"far shore", Vec3d{70, 80, 0} + offset, false});
  c.scene.sections.push_back({"across", {offset.x - 140, offset.y + 80}, {offset.x + 140, offset.y + 80}});
  c.scene.regions.push_back({"far bank",
                             {{offset.x, offset.y},
                              {offset.x + 150, offset.y},
                              {offset.x + 150, offset.y + length},
                              {offset.x, offset.y + length}}});
  c.scene.time.end = 20.0;
  c.scene.time.output_interval = 1.0;
  c.offset = offset;
  c.domain = {{-150, 0, -5}, {150, length, 100}};
  c.still_water_level = still;
  c.terrain_top = 75.0;
  c.fluid = water_at(0.0, dp);
  c.grains = slide_at(0.0, dp);
  c.walls = valley();
  return c;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return std::fprintf(stderr, "make_run CASE RUN [DP [FRAMES]]\n"), 2;
  const double dp = argc > 3 ? std::atof(argv[3]) : 4.0;
  const int frames = argc > 4 ? std::atoi(argv[4]) : 21;
  try {
    write_case(argv[1], valley_case(dp), true);
    FrameWriter writer(argv[2], offset, dp, true, false);
    std::ofstream(std::string(argv[2]) + "/case.link") << std::filesystem::absolute(argv[1]).string() << "\n";
    for (int k = 0; k < frames; ++k) {
      Frame frame;
      frame.time = 20.0 * k / std::max(frames - 1, 1);
      frame.step = 100 * k;
      frame.fluid = water_at(frame.time, dp);
      frame.grains = slide_at(frame.time, dp);
      const FramePaths p = writer.write(frame);
      std::printf(
          "{\"record\":\"frame\",\"path\":\"%s\",\"fluid\":\"%s\",\"grains\":\"%s\",\"case\":\"%s\",\"t\":%.6g,"
          "\"step\":%lld}\n",
          p.fluid.c_str(), p.fluid.c_str(), p.grains.c_str(), argv[1], frame.time, static_cast<long long>(frame.step));
      std::fflush(stdout);
    }
    std::printf("{\"record\":\"done\",\"run\":\"%s\",\"case\":\"%s\",\"t\":20}\n", argv[2], argv[1]);
    return 0;
  } catch (const Error& e) { return std::fprintf(stderr, "make_run: %s\n", e.what()), e.exit_code(); }
}
