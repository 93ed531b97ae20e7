// SPDX-License-Identifier: GPL-3.0-or-later
// atlas_case CASE KIND [name=value...]: the small scenes of scripts/stability-atlas, written without mesh2particles so that
// each can be put exactly where a method breaks. Two dimensions (plane x-z) unless said. SI units. Kinds, with the names
// that count for them:
//   dam     column 0.1 m x 0.2 m in a tank; speed (of the column at the start), offset (of all coordinates), open=1 (no right wall)
//   still   water 0.1 m deep over a sawtooth bed; tooth (height)
//   patch   square of water that rotates, no gravity; spin (rad/s)
//   sheet   layer of water on a plane slope; layers, angle (degrees), fitted=1 (wall particles in layers along the slope)
//   wet     block of grains in still water, three dimensions; density, diameter, real_diameter
//   pores   a bed of discs under water; gap (spacing over diameter)
//   settle  one grain in a deep tank, three dimensions; diameter, density
//   heap    block of grains falls into a dry tank; diameter, ratio (largest over smallest), drop
//   slope   a row of grains on a plane; angle (degrees)
//   float   a box in still water; ratio (of densities), sunk=1 (let go at the bottom, else half-sunk), side
//   mixed   a dam of water and grains behind a gate that rises, a box that floats before it; density (of the grains)
//   shot    one grain shot at a wall, three dimensions, dry; speed, target (0 plate, 1 edge, 2 vertex, 3 thin gate)
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>

#include "../support/surfaces.hpp"
#include "core/error.hpp"
#include "geometry/fitted_layers.hpp"
#include "io/case.hpp"

namespace {

using namespace gdesp;

constexpr double pi = 3.14159265358979323846;

struct Settings {
  std::map<std::string, double> value;
  double get(const std::string& name, double standard) const {
    const auto at = value.find(name);
    return at == value.end() ? standard : at->second;
  }
};

struct Maker {
  Settings set;
  Case c;
  double dp;

  explicit Maker(const Settings& s) : set(s), dp(s.get("dp", 0.01)) {
    c.scene.title = "stability atlas";
    c.scene.contact.youngs_modulus = 1.0e7;  // the same for all scenes, where an axis does not sweep it
    c.scene.dimensions = 2;
    c.scene.dp = dp;
  }

  void domain(const Vec3d& low, const Vec3d& high) {
    c.domain = {low, high};
    c.scene.domain = c.domain;
  }
  void end(double seconds, int frames) {
    c.scene.time.end = set.get("end", seconds);
    c.scene.time.output_interval = c.scene.time.end / frames;
  }

  void water(const Vec3d& low, const Vec3d& high, const std::function<bool(const Vec3d&)>& keep = {}) {
    const bool three = c.scene.dimensions == 3;
    const auto count = [&](double a, double b) { return std::max(1, static_cast<int>(std::lround((b - a) / dp))); };
    for (int i = 0; i < count(low.x, high.x); ++i)
      for (int j = 0; j < (three ? count(low.y, high.y) : 1); ++j)
        for (int k = 0; k < count(low.z, high.z); ++k) {
          const Vec3d r{low.x + (i + 0.5) * dp, three ? low.y + (j + 0.5) * dp : 0.0, low.z + (k + 0.5) * dp};
          if (!keep || keep(r)) c.fluid.position.push_back(r);
        }
  }

  /// Four layers of wall particles on the lattice below the surface of a solid; distance(r) > 0 outside.
  void solid(const Vec3d& low, const Vec3d& high, const std::function<double(const Vec3d&)>& distance,
             std::int32_t body = 0) {
    const bool three = c.scene.dimensions == 3;
    const auto first = [&](double a) { return static_cast<long>(std::floor(a / dp)); };
    for (long i = first(low.x); i < first(high.x); ++i)
      for (long j = three ? first(low.y) : 0; j < (three ? first(high.y) : 1); ++j)
        for (long k = first(low.z); k < first(high.z); ++k) {
          const Vec3d r{(i + 0.5) * dp, three ? (j + 0.5) * dp : 0.0, (k + 0.5) * dp};
          const double s = distance(r);
          if (s >= 0.0 || s < -4.0 * dp) continue;
          const double e = 0.05 * dp;
          Vec3d n{distance(r + Vec3d{e, 0, 0}) - distance(r - Vec3d{e, 0, 0}),
                  three ? distance(r + Vec3d{0, e, 0}) - distance(r - Vec3d{0, e, 0}) : 0.0,
                  distance(r + Vec3d{0, 0, e}) - distance(r - Vec3d{0, 0, e})};
          const double length = norm(n);
          c.boundary.position.push_back(r);
          c.boundary.normal.push_back(length > 0.0 ? static_cast<Vec3f>(n * (1.0 / length)) : Vec3f{});
          c.boundary.depth.push_back(static_cast<float>(-s));
          c.boundary.friction.push_back(0.0f);
          c.boundary.body.push_back(body);
        }
  }

  void quad(const Vec3d& a, const Vec3d& b, const Vec3d& d, const Vec3d& e) {
    test::add_rectangle(c.walls, a, b, d, e);
  }
  /// A wall of grains in the plane, from a to b; the free side is to the left.
  void line(const Vec3d& a, const Vec3d& b) {
    quad({a.x, -0.5, a.z}, {b.x, -0.5, b.z}, {b.x, 0.5, b.z}, {a.x, 0.5, a.z});
  }

  void grain(const Vec3d& r, double diameter, double density) {
    c.grains.position.push_back(r);
    c.grains.diameter.push_back(static_cast<float>(diameter));
    c.grains.density.push_back(static_cast<float>(density));
    c.grains.group.push_back(0);
  }
  /// A box in the plane that moves as its body says: its wall particles, and its surface one metre wide.
  void block(const Vec3d& low, const Vec3d& high, const Body& body) {
    c.bodies.push_back(body);
    const auto number = static_cast<std::int32_t>(c.bodies.size());
    solid(
        low, high,
        [=](const Vec3d& r) {
          return std::max({low.x - r.x, r.x - high.x, low.z - r.z, r.z - high.z});
        },
        number);
    test::add_box(c.walls, number, {low.x, -0.5, low.z}, {high.x, 0.5, high.z});
  }
  void floating(const Vec3d& low, const Vec3d& high, double density) {
    block(low, high, test::box_body({low.x, -0.5, low.z}, {high.x, 0.5, high.z}, density));
  }

  void float_() {
    const double side = set.get("side", 0.1), width = 0.5, depth = 0.25;
    const double bottom = set.get("sunk", 0) != 0 ? 0.05 : depth - 0.5 * side, left = 0.2;
    tank(width, depth + 0.15);
    water({0, 0, 0}, {width, 0, depth},
          [=](const Vec3d& r) { return r.x < left || r.x > left + side || r.z < bottom || r.z > bottom + side; });
    floating({left, 0, bottom}, {left + side, 0, bottom + side}, 1000.0 * set.get("ratio", 0.5));
    c.still_water_level = depth;
    end(2.0, 4);
  }

  void mixed() {
    const double d = 0.009;
    tank(0.5, 0.4);
    water({0, 0, 0}, {0.12, 0, 0.2});
    water({0.14, 0, 0}, {0.5, 0, 0.08}, [](const Vec3d& r) { return r.x < 0.3 || r.x > 0.36 || r.z < 0.05; });
    Body gate;
    gate.name = "gate";
    gate.centre = {0.13, 0.0, 0.11};
    gate.motion.time = {0.02, 0.22};
    gate.motion.displacement = {{0, 0, 0}, {0, 0, 0.3}};
    block({0.12, 0, 0.0}, {0.14, 0, 0.22}, gate);
    floating({0.3, 0, 0.05}, {0.36, 0, 0.11}, 500.0);
    slide(d);
    for (int k = 0; k < 6; ++k)
      for (int i = 0; i < 11; ++i)
        grain({0.008 + i * 1.12 * d + 0.001 * (k % 2), 0, 0.5 * d + k * 1.08 * d}, d, set.get("density", 2650));
    c.still_water_level = 0.2;
    end(0.4, 4);
  }

  void slide(double diameter) {
    Slide s;
    s.diameter = diameter;
    s.shape.box = Box{{0, 0, 0}, {1, 1, 1}};
    c.scene.slides.push_back(s);
  }

  /// A tank open at the top.
  void tank(double width, double height, bool closed_right = true) {
    const auto distance = [width, closed_right](const Vec3d& r) {
      const double right = closed_right ? width - r.x : 1e9;
      return std::min({r.x, right, r.z});
    };
    solid({-4 * dp, 0, -4 * dp}, {width + (closed_right ? 4 * dp : 0), 0, height}, distance);
    line({0, 0, 0}, {width, 0, 0});
    line({0, 0, height}, {0, 0, 0});
    if (closed_right) line({width, 0, 0}, {width, 0, height});
    domain({-5 * dp, -dp, -5 * dp}, {width + 5 * dp, dp, height + 40 * dp});
  }

  void dam() {
    tank(0.4, 0.4, set.get("open", 0) == 0);
    water({0, 0, 0}, {0.1, 0, 0.2});
    c.still_water_level = 0.2;
    const auto speed = static_cast<float>(set.get("speed", 0));
    if (speed > 0.0f) c.fluid.velocity.assign(c.fluid.position.size(), Vec3f{speed, 0, 0});
    end(0.4, 4);
    if (set.get("open", 0) != 0) c.domain.upper.x = c.scene.domain->upper.x = 0.3;
    shift(set.get("offset", 0));
  }

  /// Everything as far from the origin as UTM coordinates are, not re-centred.
  void shift(double by) {
    if (by == 0.0) return;
    const Vec3d d{by, 0, by};
    for (auto* column : {&c.fluid.position, &c.boundary.position, &c.grains.position, &c.walls.vertex})
      for (Vec3d& r : *column) r += d;
    domain(c.domain.lower + d, c.domain.upper + d);
    c.still_water_level += by;
  }

  void still() {
    const double tooth = set.get("tooth", 0.02), pitch = 0.08, width = 0.4, level = 0.1 + tooth;
    const auto bed = [=](double x) { return 2.0 * tooth * std::abs(x / pitch - std::floor(x / pitch + 0.5)); };
    const double cosine = 1.0 / std::sqrt(1.0 + std::pow(2.0 * tooth / pitch, 2));
    const auto distance = [=](const Vec3d& r) { return std::min({(r.z - bed(r.x)) * cosine, r.x, width - r.x}); };
    solid({-4 * dp, 0, -6 * dp}, {width + 4 * dp, 0, level + 0.1}, distance);
    water({0, 0, 0}, {width, 0, level}, [distance, this](const Vec3d& r) { return distance(r) > 0.45 * dp; });
    domain({-5 * dp, -dp, -7 * dp}, {width + 5 * dp, dp, level + 0.5});
    c.still_water_level = level;
    end(5.0, 10);
  }

  void patch() {
    const double half = 0.5, spin = set.get("spin", 1.0);
    c.scene.gravity = {0, 0, 0};
    water({-half, 0, -half}, {half, 0, half});
    for (const Vec3d& r : c.fluid.position)
      c.fluid.velocity.push_back({static_cast<float>(spin * r.z), 0.0f, static_cast<float>(-spin * r.x)});
    const double density = c.scene.fluid.density;
    c.fluid.density.assign(c.fluid.position.size(), static_cast<float>(density));
    domain({-1.5, -dp, -1.5}, {1.5, dp, 1.5});
    end(2.0 / spin, 8);
  }

  void sheet() {
    const double angle = set.get("angle", 30.0) * pi / 180.0, length = 2.4, layers = set.get("layers", 4);
    const Vec3d along{std::cos(angle), 0, -std::sin(angle)}, up{std::sin(angle), 0, std::cos(angle)};
    const double top = length * std::sin(angle);
    const auto distance = [=](const Vec3d& r) { return dot(r - Vec3d{0, 0, top}, up); };
    if (set.get("fitted", 0) != 0)
      fit_to_slope(up, along, top);
    else
      solid({-4 * dp, 0, -0.2}, {length * std::cos(angle), 0, top + 4 * dp}, distance);
    // The sheet lies on its own lattice, along the slope.
    const Vec3d corner = Vec3d{0, 0, top} + along * 0.2;
    for (int i = 0; i < static_cast<int>(std::lround(0.3 / dp)); ++i)
      for (int k = 0; k < static_cast<int>(layers); ++k)
        c.fluid.position.push_back(corner + along * ((i + 0.5) * dp) + up * ((k + 0.5) * dp));
    c.fluid.density.assign(c.fluid.position.size(), static_cast<float>(c.scene.fluid.density));
    domain({-5 * dp, -dp, -0.3}, {length, dp, top + 0.3});
    c.scene.numerics.expected_speed = 9.81 * std::sin(angle) * 0.6;
    end(0.6, 6);
  }

  void fit_to_slope(const Vec3d& up, const Vec3d& along, double top) {
    const Vec3d upper = Vec3d{0, 0, top} - along, lower = Vec3d{0, 0, top} + along * 4.0, side{0, 1, 0};
    geometry::TriangleMesh slope;
    slope.vertex = {upper - side, upper + side, lower - side, lower + side};
    slope.triangle = {{0, 2, 1}, {2, 3, 1}};
    const geometry::Lattice lattice{{0, -0.5 * dp, 0}, dp, 2};
    std::vector<geometry::BandPoint> band;
    const auto last = [&](double a) { return static_cast<std::int32_t>(a / dp); };
    for (std::int32_t i = -4; i < last(2.4 * along.x); ++i) {
      for (std::int32_t k = last(-0.2); k < last(top) + 4; ++k) {
        const double s = dot(lattice.point({i, 0, k}) - Vec3d{0, 0, top}, up);
        if (std::abs(s) < geometry::fitted_band * dp)
          band.push_back({{i, 0, k}, static_cast<float>(s), static_cast<Vec3f>(up), 0});
      }
    }
    for (const auto& p : geometry::fit_layers(band, {&slope, lattice, {{-1, -1, -1}, {9, 1, 9}}, {}, {}, 0.0})) {
      c.boundary.position.push_back(p.position);
      c.boundary.normal.push_back(static_cast<Vec3f>(p.normal));
      c.boundary.depth.push_back(static_cast<float>(p.depth));
      c.boundary.friction.push_back(0.0f);
      c.boundary.body.push_back(0);
    }
  }

  /// A tank in three dimensions, open at the top.
  void deep_tank(const Vec3d& size) {
    c.scene.dimensions = 3;
    const auto distance = [size](const Vec3d& r) { return std::min({r.x, size.x - r.x, r.y, size.y - r.y, r.z}); };
    solid({-4 * dp, -4 * dp, -4 * dp}, {size.x + 4 * dp, size.y + 4 * dp, size.z}, distance);
    const double x = size.x, y = size.y, z = size.z;
    quad({0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0});
    quad({0, 0, 0}, {0, y, 0}, {0, y, z}, {0, 0, z});
    quad({x, 0, 0}, {x, 0, z}, {x, y, z}, {x, y, 0});
    quad({0, 0, 0}, {0, 0, z}, {x, 0, z}, {x, 0, 0});
    quad({0, y, 0}, {x, y, 0}, {x, y, z}, {0, y, z});
    domain({-5 * dp, -5 * dp, -5 * dp}, {x + 5 * dp, y + 5 * dp, z + 40 * dp});
  }

  void wet() {
    const double d = set.get("diameter", 0.01), step = 1.15 * d, density = set.get("density", 2650);
    deep_tank({0.1, 0.06, 0.16});
    water({0, 0, 0}, {0.1, 0.06, 0.12});
    slide(d);
    for (int k = 0; k < static_cast<int>(0.04 / step); ++k)
      for (int j = 0; j < static_cast<int>(0.05 / step); ++j)
        for (int i = 0; i < static_cast<int>(0.07 / step); ++i)
          grain({0.016 + (i + 0.3 * (k % 2)) * step, 0.011 + (j + 0.2 * (k % 2)) * step, 0.05 + k * step}, d, density);
    c.scene.slides.back().real_diameter = set.get("real_diameter", 0.0);
    c.still_water_level = 0.12;
    end(0.3, 3);
  }

  void pores() {
    const double d = 0.01, step = set.get("gap", 1.15) * d;
    tank(0.2, 0.3);
    water({0, 0, 0}, {0.2, 0, 0.2});
    slide(d);
    const int across = static_cast<int>((0.2 - 0.5 * step) / step), high = static_cast<int>(0.06 / step);
    for (int k = 0; k < high; ++k)
      for (int i = 0; i < across; ++i)
        grain({(i + 0.52 + 0.5 * (k % 2)) * step, 0, 0.5 * d + k * step * 0.867}, d, 2650);
    c.still_water_level = 0.2;
    end(0.3, 3);
  }

  void settle() {
    const double d = set.get("diameter", 0.01), width = 0.16, depth = 0.24;
    deep_tank({width, width, depth + 4 * dp});
    water({0, 0, 0}, {width, width, depth});
    slide(d);
    grain({0.5 * width, 0.5 * width, depth - 0.06}, d, set.get("density", 2650));
    c.still_water_level = depth;
    end(0.2, 4);
  }

  void heap() {
    const double d = set.get("diameter", 0.01), ratio = set.get("ratio", 1.0), drop = set.get("drop", 0.05);
    tank(0.2, 0.3);
    c.boundary = {};
    slide(d);
    const double step = 1.02 * d;
    const int across = static_cast<int>(0.2 / step), high = static_cast<int>(set.get("high", 6));
    for (int k = 0; k < high; ++k)
      for (int i = 0; i + (k % 2) < across; ++i) {
        const bool small = ratio > 1.0 && (7 * i + 5 * k) % 3 == 0;
        grain({(i + 0.5 + 0.5 * (k % 2)) * step, 0, drop + (k + 0.5) * step}, small ? d / ratio : d, 2650);
      }
    end(0.5, 5);
  }

  void slope() {
    const double angle = set.get("angle", 20.0) * pi / 180.0, d = 0.01, length = 1.0;
    c.scene.gravity = {9.81 * std::sin(angle), 0, -9.81 * std::cos(angle)};
    slide(d);
    line({0, 0, 0}, {length, 0, 0});
    // Triples that cannot roll: two at the bottom, one in their saddle; rolling friction holds the rest.
    for (int k = 0; k < 3; ++k) grain({0.3 + 0.1 * k, 0, 0.5 * d}, d, 2650);
    c.scene.contact.rolling_friction = 1.0;
    domain({-0.05, -dp, -0.05}, {length + 0.05, dp, 0.2});
    end(2.0, 4);
  }

  void shot() {
    const double speed = set.get("speed", 100.0), d = 0.01;
    const auto target = static_cast<int>(set.get("target", 0));
    c.scene.dimensions = 3;
    c.scene.gravity = {0, 0, 0};
    slide(d);
    grain({0.3, 0.001 * (target == 2 ? 0 : 1), 0.0}, d, 2650);
    c.grains.velocity.assign(1, Vec3f{static_cast<float>(speed), 0, 0});
    const Vec3d tip{0.5, 0, 0};
    if (target == 0) quad({0.5, -0.2, -0.2}, {0.5, -0.2, 0.2}, {0.5, 0.2, 0.2}, {0.5, 0.2, -0.2});
    if (target == 1) {  // a ridge along y that points at the grain
      quad(tip + Vec3d{0, -0.2, 0}, {0.7, -0.2, 0.2}, {0.7, 0.2, 0.2}, tip + Vec3d{0, 0.2, 0});
      quad(tip + Vec3d{0, 0.2, 0}, {0.7, 0.2, -0.2}, {0.7, -0.2, -0.2}, tip + Vec3d{0, -0.2, 0});
    }
    if (target == 2) {  // a pyramid's tip
      const Vec3d base[4] = {{0.7, -0.2, -0.2}, {0.7, -0.2, 0.2}, {0.7, 0.2, 0.2}, {0.7, 0.2, -0.2}};
      for (int k = 0; k < 4; ++k) {
        const auto first = static_cast<std::int32_t>(c.walls.vertex.size());
        for (const Vec3d& v : {tip, base[k], base[(k + 1) % 4]}) c.walls.vertex.push_back(v);
        c.walls.triangle.push_back({first, first + 1, first + 2});
        c.walls.body.push_back(0);
      }
    }
    if (target == 3) {  // a gate a tenth of a grain thick
      quad({0.5, -0.2, -0.2}, {0.5, -0.2, 0.2}, {0.5, 0.2, 0.2}, {0.5, 0.2, -0.2});
      quad({0.501, -0.2, -0.2}, {0.501, 0.2, -0.2}, {0.501, 0.2, 0.2}, {0.501, -0.2, 0.2});
    }
    domain({0, -0.3, -0.3}, {1.0, 0.3, 0.3});
    end(0.4 / speed, 2);
  }
};

}  // namespace

int main(int argc, char** argv) {
  const std::map<std::string, void (Maker::*)()> kinds{
      {"dam", &Maker::dam},       {"still", &Maker::still}, {"patch", &Maker::patch},  {"sheet", &Maker::sheet},
      {"wet", &Maker::wet},       {"pores", &Maker::pores}, {"float", &Maker::float_}, {"mixed", &Maker::mixed},
      {"settle", &Maker::settle}, {"heap", &Maker::heap},   {"slope", &Maker::slope},  {"shot", &Maker::shot}};
  const auto kind = argc > 2 ? kinds.find(argv[2]) : kinds.end();
  if (kind == kinds.end())
    return std::fprintf(
               stderr,
               "atlas_case CASE dam|still|patch|sheet|wet|pores|float|mixed|settle|heap|slope|shot [name=value...]\n"),
           2;
  Settings settings;
  for (int k = 3; k < argc; ++k) {
    const std::string text = argv[k];
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) return std::fprintf(stderr, "atlas_case: '%s' is no name=value\n", argv[k]), 2;
    settings.value[text.substr(0, equals)] = std::atof(text.c_str() + equals + 1);
  }
  try {
    Maker maker(settings);
    (maker.*kind->second)();
    gdesp::write_case(argv[1], maker.c, true);
    return 0;
  } catch (const gdesp::Error& e) { return std::fprintf(stderr, "atlas_case: %s\n", e.what()), e.exit_code(); }
}
