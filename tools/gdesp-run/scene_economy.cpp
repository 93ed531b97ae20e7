// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_economy.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include "dem/linear_spring_dashpot.hpp"

namespace gdesp::tool {
namespace {

constexpr double pi = 3.14159265358979324;
constexpr double impact_share = 1.0 / 3.0;  // of the expected speed: between grains of one slide
constexpr double packing = 0.6;

struct Rectangle {
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  void add(const Vec3d& r) {
    for (int k = 0; k < 2; ++k) low[k] = std::min(low[k], r[k]), high[k] = std::max(high[k], r[k]);
  }
  bool empty() const { return low[0] > high[0]; }
  double distance(const Vec3d& r) const {
    const double x = std::max({low[0] - r.x, r.x - high[0], 0.0}), y = std::max({low[1] - r.y, r.y - high[1], 0.0});
    return std::hypot(x, y);
  }
};

std::uint64_t cell_key(const Vec3d& r, double width, int dx = 0, int dy = 0, int dz = 0) {
  const auto part = [&](double x, int d) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / width)) + d) & 0x1fffffu;
  };
  return (part(r.x, dx) << 42) | (part(r.y, dy) << 21) | part(r.z, dz);
}

double water_height(const SimulationInput& in) {
  double low = INFINITY, high = -INFINITY;
  for (const Vec3d& r : in.fluid.position) low = std::min(low, r.z), high = std::max(high, r.z);
  return high - low + in.fluid_parameters.dp;
}

double grain_volume(double d, int dimensions) { return dimensions == 2 ? 0.25 * pi * d * d : pi * d * d * d / 6.0; }

/// m, of solid and pores: the thickest column, columns four grains wide.
double slide_thickness(const SimulationInput& in, double diameter) {
  const int dimensions = in.fluid_parameters.dimensions;
  const double width = 4.0 * diameter;
  std::unordered_map<std::uint64_t, double> volume;
  double most = 0.0;
  for (std::size_t i = 0; i < in.grains.position.size(); ++i) {
    Vec3d r = in.grains.position[i];
    r.z = 0.0;
    double& v = volume[cell_key(r, width)];
    v += grain_volume(static_cast<double>(in.grains.diameter[i]), dimensions);
    most = std::max(most, v);
  }
  return most / (packing * std::pow(width, dimensions - 1));
}

std::string percent(double share) { return number_text(100.0 * share, share < 0.1 ? 2 : 3) + " %"; }

std::string label(const char* name, const std::string& text) {
  std::string line = name;
  line.resize(std::max<std::size_t>(line.size(), 18), ' ');
  return line + text;
}

void add(SceneSummary& s, const char* name, bool used, double saving, const std::string& text) {
  s.lines.push_back(label(name, text));
  s.json["economies"][name] = {{"used", used}, {"saving", saving}, {"what", text}};
}

void describe_width(SceneSummary& s, const Scene& scene) {
  const std::string what = needless_width(scene);
  if (what == "dimensions")
    add(s, "  along y", false, 1.0,
        "the scene is the same all along y: mesh2particles --set dimensions=2 gives the same answer from one layer");
  if (what == "periodic")
    add(s, "  along y", false, 0.5,
        "the scene is the same all along y: a slab some 10 grains wide with domain.periodic = [\"y\"] gives the same "
        "answer");
  if (what == "half")
    add(s, "  symmetry", false, 0.5,
        "mirrored about the middle of the tank: half of it, with wall.symmetry = [\"y+\"] in the middle, gives the "
        "same answer");
}

/// Particles that the columns stand for.
double far_particles(const FarLakeShape& lake, const sph::FluidParameters& p) {
  return lake.length * lake.depth * lake.width / std::pow(p.dp, p.dimensions);
}

void describe_far_lakes(SceneSummary& s, const SimulationInput& in) {
  for (const Body& body : in.bodies) {
    if (body.kind != BodyKind::far_lake) continue;
    const FarLakeShape& lake = body.far_lake;
    const double columns = far_particles(lake, in.fluid_parameters),
                 all = columns + static_cast<double>(in.fluid.position.size());
    add(s, "  far lake", true, columns / all,
        std::to_string(lake.columns) + " columns, " + number_text(lake.length) + " m, behind " + body.name +
            ": in place of " + percent(columns / all) + " of the water; for waves longer than " +
            number_text(4.5 * lake.depth, 2) + " m that do not break");
  }
}

void describe_contact_stiffness(SceneSummary& s, const SimulationInput& in, double speed, double grain_share) {
  const ContactSoftness c = contact_softness(in, speed);
  const bool hertz = in.contact.law == dem::ContactLawKind::hertz;
  const double now = hertz ? in.contact.youngs_modulus : in.contact.stiffness, ratio = now / c.stiffness;
  s.json["overlap_estimate"] = {c.at_rest, c.on_impact};
  const std::string key = hertz ? "contact.youngs_modulus" : "contact.stiffness";
  const std::string text =
      "overlaps of about " + percent(c.at_rest) + " of a diameter at rest, " + percent(c.on_impact) + " on impact";
  if (ratio > 1.5) {
    s.json["proposed_contact"] = {{key, c.stiffness}};
    const double saving = grain_share * (1.0 - 1.0 / std::sqrt(ratio));
    add(s, "  softer contact", false, saving,
        text + "; " + key + " = " + number_text(c.stiffness, 2) + " (1 % and 5 % at most) would save " +
            percent(saving) + " of the time");
  } else if (ratio < 0.5) {
    add(s, "  softer contact", false, 0.0,
        text + ": too soft; " + key + " = " + number_text(c.stiffness, 2) + " would give 1 % and 5 % at most");
  } else {
    add(s, "  softer contact", false, 0.0, text + ": no room for a softer contact");
  }
}

}  // namespace

WaveReach wave_reach(const SimulationInput& in, double end) {
  Rectangle source;
  for (const Vec3d& r : in.grains.position) source.add(r);
  for (std::size_t i = 0; i < in.boundary.body.size(); ++i)
    if (in.boundary.body[i] > 0) source.add(in.boundary.position[i]);
  WaveReach reach;
  if (source.empty() || in.fluid.position.empty()) return reach;
  const double celerity = std::sqrt(norm(in.fluid_parameters.gravity) * water_height(in));
  double within = 0.0, steps = 0.0;
  for (const Vec3d& r : in.fluid.position) {
    const double arrival = source.distance(r) / celerity;
    if (arrival < end) within += 1.0, steps += 1.0 - arrival / end;
  }
  const auto n = static_cast<double>(in.fluid.position.size());
  return {within / n, steps / n};
}

std::size_t walls_beside_water(const SimulationInput& in) {
  const double width = 2.0 * in.fluid_parameters.h;
  std::unordered_set<std::uint64_t> wet;
  for (const Vec3d& r : in.fluid.position) wet.insert(cell_key(r, width));
  std::unordered_map<std::uint64_t, bool> beside;
  std::size_t count = 0;
  for (const Vec3d& r : in.boundary.position) {
    const auto [found, fresh] = beside.try_emplace(cell_key(r, width), false);
    for (int k = 0; fresh && k < 27 && !found->second; ++k)
      found->second = wet.count(cell_key(r, width, k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)) > 0;
    if (found->second) ++count;
  }
  return count;
}

ContactSoftness contact_softness(const SimulationInput& in, double expected_speed) {
  double d = 0.0, density = 0.0;
  for (std::size_t i = 0; i < in.grains.diameter.size(); ++i)
    if (static_cast<double>(in.grains.diameter[i]) > d)
      d = static_cast<double>(in.grains.diameter[i]), density = static_cast<double>(in.grains.density[i]);
  const double mass = 0.5 * density * grain_volume(d, in.fluid_parameters.dimensions);  // of a pair
  const double weight = packing * density * norm(in.fluid_parameters.gravity) * slide_thickness(in, d) *
                        std::pow(d, in.fluid_parameters.dimensions - 1);
  const double v = impact_share * expected_speed;
  const double E = in.contact.youngs_modulus, nu = in.contact.poisson_ratio, pair = 0.5 * E / (1.0 - nu * nu);
  const bool hertz = in.contact.law == dem::ContactLawKind::hertz;
  ContactSoftness c;
  if (hertz && in.fluid_parameters.dimensions == 3) {
    const double root = std::sqrt(0.25 * d);
    c.at_rest = std::pow(0.75 * weight / (pair * root), 2.0 / 3.0) / d;
    c.on_impact = std::pow(15.0 * mass * v * v / (16.0 * pair * root), 0.4) / d;
    c.stiffness =
        E * std::max(std::pow(c.at_rest / overlap_at_rest, 1.5), std::pow(c.on_impact / overlap_on_impact, 2.5));
  } else {
    const double k = hertz ? dem::line_contact_stiffness(pair) : in.contact.stiffness;
    c.at_rest = weight / k / d;
    c.on_impact = v * std::sqrt(mass / k) / d;
    c.stiffness =
        (hertz ? E : k) * std::max(c.at_rest / overlap_at_rest, std::pow(c.on_impact / overlap_on_impact, 2.0));
  }
  return c;
}

std::string needless_width(const Scene& scene) {
  if (scene.dimensions == 2 || !scene.terrain.files.empty() || !scene.floating.empty() || !scene.periodic.empty())
    return "";
  if (scene.walls.size() != 1) return "";
  const Wall& wall = scene.walls.front();
  if (!wall.tank || wall.condition != "free-slip" || !wall.symmetry.empty()) return "";
  const Box tank = *wall.tank;
  const double middle = 0.5 * (tank.lower.y + tank.upper.y), near = 1.0e-9 * (tank.upper.y - tank.lower.y);
  bool spans = true, mirrored = true, possible = norm(Vec3d{scene.gravity.x, scene.gravity.y, 0.0}) == 0.0;
  const auto look = [&](const std::optional<Box>& box) {
    if (!box) {
      possible = false;
      return;
    }
    spans = spans && box->lower.y <= tank.lower.y + near && box->upper.y >= tank.upper.y - near;
    mirrored = mirrored && std::abs(0.5 * (box->lower.y + box->upper.y) - middle) <= near;
  };
  for (const FluidFill& fill : scene.fluid.fill)
    if (fill.kind != "level") look(fill.box);
  for (const Slide& slide : scene.slides) {
    look(slide.shape.box);
    possible = possible && slide.velocity.y == 0.0 && slide.motion_csv.empty();
  }
  for (const MovingBody& body : scene.moving) {
    look(body.shape.box);
    possible = possible && body.velocity.y == 0.0 && body.motion_csv.empty();
  }
  if (!possible) return "";
  const bool grains =
      std::any_of(scene.slides.begin(), scene.slides.end(), [](const Slide& s) { return s.kind == "granular"; });
  if (spans) return grains ? "periodic" : "dimensions";
  return mirrored ? "half" : "";
}

void describe_economies(SceneSummary& s, const Scene& scene, const SimulationInput& in, const ExpectedSpeed& expected,
                        const StepCosts& costs) {
  const double end = scene.time.end;
  const WaveReach reach = wave_reach(in, end);
  const std::size_t beside = in.fluid.position.empty() ? 0 : walls_beside_water(in);
  const bool sleeps = in.fluid_parameters.activity.sleep;
  StepWork work;
  work.water = static_cast<double>(in.fluid.position.size()) * (sleeps ? reach.steps : 1.0);
  work.walls = static_cast<double>(beside) * (sleeps ? reach.steps : 1.0);
  work.grains = static_cast<double>(in.grains.position.size());
  const double grain_step = s.json.value("grain_time_step", 0.0);
  if (in.fluid.position.empty()) s.time_step = grain_step;
  if (grain_step > 0.0) work.grain_steps = std::max(1.0, std::ceil(s.time_step / grain_step - 1e-9));
  const double step = step_seconds(costs, work), steps = std::ceil(end / s.time_step);
  s.wall_seconds = steps * step;
  s.json["wall_seconds_estimate"] = s.wall_seconds;
  s.json["step_costs"] = {
      {"water", costs.water}, {"wall", costs.wall}, {"grain", costs.grain}, {"coupling", costs.coupling}};
  const double grain_share = costs.grain * work.grains * work.grain_steps / step;
  s.json["wall_share"] = costs.wall * work.walls / step;
  s.lines.push_back(
      label("cost of a step", number_text(1e3 * step, 3) + " ms: water " + percent(costs.water * work.water / step) +
                                  ", walls " + percent(costs.wall * work.walls / step) + ", grains " +
                                  percent(grain_share) + ", coupling " + percent(costs.coupling * work.grains / step) +
                                  " (measured just now on a small tank)"));
  s.lines.push_back(label("expected", number_text(steps, 2) + " steps, about " + duration_text(s.wall_seconds)));
  s.lines.push_back("economies");
  s.json["economies"] = nlohmann::ordered_json::object();
  if (reach.particles < 1.0 || reach.steps < 0.99 || sleeps)
    add(s, "  still water", sleeps, 1.0 - reach.steps,
        std::string(sleeps ? "sleeps until disturbed"
                           : "could sleep (economy.sleep = true; steep waves lose some percent, docs/economy.md)") +
            ": waves reach " + percent(reach.particles) + " of the water until the end, " + percent(reach.steps) +
            " of all particle steps");
  describe_far_lakes(s, in);
  if (!in.boundary.position.empty())
    add(s, "  walls", in.fluid_parameters.activity.near_walls, 0.0,
        std::to_string(beside) + " of " + std::to_string(in.boundary.position.size()) +
            " particles lie beside water at the start; " +
            (in.fluid_parameters.activity.near_walls ? "the others are not touched"
                                                     : "all are visited (economy.near_walls = false)"));
  if (scene.numerics.viscosity == "morris" && in.fluid_parameters.viscosity == sph::Viscosity::none)
    add(s, "  viscosity", true, 0.1, "left out: its layer, sqrt(nu t), stays below 0.2 dp (economy.viscosity)");
  if (!in.grains.position.empty() && !in.fluid.position.empty()) {
    const double one_step = step_seconds(costs, {work.water, work.walls, work.grains, 1.0}) * work.grain_steps;
    add(s, "  multi-rate", in.time.multirate, in.time.multirate ? 1.0 - step / one_step : 0.0,
        in.time.multirate ? "one step for all would cost " + number_text(one_step / step, 2) + " times as much"
                          : "off (numerics.multirate): the water takes the grains' steps");
    add(s, "  coupling", true, 0.0, "only while grains are within reach of water");
  }
  if (!in.grains.position.empty()) describe_contact_stiffness(s, in, expected.speed, grain_share);
  describe_width(s, scene);
}

}  // namespace gdesp::tool
