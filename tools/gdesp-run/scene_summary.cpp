// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_summary.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <set>

#include "core/error.hpp"
#include "dem/linear_spring_dashpot.hpp"
#include "dem/time_step_limits.hpp"
#include "exec/backend.hpp"
#include "simulation/time_step_limits.hpp"

namespace gdesp::tool {
namespace {

using nlohmann::ordered_json;

// Bytes a particle, measured on full tanks in two and three dimensions (lists with the default skin and scratch: 340
// and 270), with the tables of the frames on their way to disk and a fifth to spare.
constexpr double fluid_bytes = 580.0, coupled_fluid_bytes = 160.0, wall_bytes = 330.0, grain_bytes = 1500.0;
constexpr double triangle_bytes = 200.0, base_bytes = 2.0e7;

struct Range {
  double low = INFINITY, high = 0.0;
};

Range diameters(const GrainTable& grains) {
  Range r;
  for (const float d : grains.diameter) {
    r.low = std::min(r.low, static_cast<double>(d));
    r.high = std::max(r.high, static_cast<double>(d));
  }
  return r;
}

std::string count_text(std::size_t n) {
  std::string digits = std::to_string(n);
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, " ");
  return digits;
}

/// Adds one model: its line and its entry in the JSON.
void model(SceneSummary& s, const char* name, bool on, const std::string& text) {
  std::string label = name;
  label.resize(std::max<std::size_t>(label.size(), 18), ' ');
  s.lines.push_back(label + (on ? "on   " : "off  ") + text);
  s.json["models"][name] = {{"on", on}, {"what", text}};
}

std::string wall_share_text(const BoundaryTable& b) {
  const auto gripping = std::count_if(b.friction.begin(), b.friction.end(), [](float f) { return f > 0.5f; });
  if (gripping == 0) return "free slip";
  return static_cast<std::size_t>(gripping) == b.friction.size() ? "no slip" : "free slip and no slip";
}

std::string viscosity_text(const sph::FluidParameters& p) {
  if (p.viscosity == sph::Viscosity::artificial) return "artificial, alpha " + number_text(p.artificial_viscosity);
  return "Morris, nu " + number_text(p.kinematic_viscosity) + " m2/s";
}

void describe_water(SceneSummary& s, const SimulationInput& in, const ExpectedSpeed& expected) {
  const sph::FluidParameters& p = in.fluid_parameters;
  const std::size_t n = in.fluid.position.size();
  if (n == 0) {
    model(s, "water", false, "the case has none");
    return;
  }
  model(s, "water", true,
        count_text(n) + " particles, dp " + number_text(p.dp) + " m, h " + number_text(p.h) + " m, density " +
            number_text(p.reference_density) + " kg/m3");
  s.lines.push_back("  sound speed     " + number_text(p.sound_speed) + " m/s; expected speed " +
                    number_text(expected.speed) + " m/s (" + expected.source + ")");
  model(s, "viscosity", p.viscosity != sph::Viscosity::none,
        p.viscosity == sph::Viscosity::none ? "numerics.viscosity = none" : viscosity_text(p));
  model(s, "density diffusion", p.density_diffusion > 0.0, "delta " + number_text(p.density_diffusion));
  if (in.boundary.position.empty()) {
    model(s, "walls", false, "the case has none");
  } else {
    model(s, "walls", true,
          count_text(in.boundary.position.size()) + " particles, " +
              (p.extrapolated_walls ? "extrapolated (Adami 2012), " : "dynamic, ") + wall_share_text(in.boundary));
  }
}

void describe_grains(SceneSummary& s, const Scene& scene, const SimulationInput& in) {
  const std::size_t n = in.grains.position.size();
  if (n == 0) {
    model(s, "grains", false, "the case has none");
    model(s, "coupling", false, "no grains");
    return;
  }
  const Range d = diameters(in.grains);
  const Contact& c = scene.contact;
  model(s, "grains", true,
        count_text(n) + " grains, diameter " + number_text(d.low) +
            (d.high > d.low ? " to " + number_text(d.high) : "") + " m");
  model(s, "contact", true,
        (c.law == "hertz"
             ? "Hertz-Mindlin, E " + number_text(in.contact.youngs_modulus) + " Pa" +
                   (c.youngs_modulus > 0.0 ? "" : " (as overlaps ask)") + ", nu " + number_text(c.poisson_ratio)
             : "linear, k " + number_text(c.stiffness) + " N/m") +
            ", friction " + number_text(c.friction) + ", restitution " + number_text(c.restitution));
  const bool coupled = in.coupling.enabled && !in.fluid.position.empty();
  model(s, "coupling", coupled,
        coupled ? std::string(in.coupling.drag == coupling::Drag::di_felice ? "drag of Di Felice"
                                                                            : "drag of Ergun and Wen-Yu") +
                      ", added mass " + number_text(in.coupling.added_mass)
                : (in.fluid.position.empty() ? "no water" : "coupling.enabled = false"));
}

void describe_bodies(SceneSummary& s, const SimulationInput& in) {
  const auto count = [&](BodyKind kind) {
    return std::count_if(in.bodies.begin(), in.bodies.end(), [kind](const Body& b) { return b.kind == kind; });
  };
  const auto free = count(BodyKind::free), prescribed = count(BodyKind::prescribed);
  model(s, "rigid bodies", !in.bodies.empty(),
        in.bodies.empty() ? "the case has none"
                          : std::to_string(free) + " free, " + std::to_string(prescribed) + " with prescribed motion" +
                                (count(BodyKind::far_lake) > 0
                                     ? ", " + std::to_string(count(BodyKind::far_lake)) + " moved by a far lake"
                                     : ""));
}

/// s, of the smallest grain; in the plane grains are rods, and their contacts are linear.
double grain_step(const Scene& scene, const SimulationInput& in) {
  const Contact& c = scene.contact;
  const bool plane = scene.dimensions == 2;
  const double E = in.contact.youngs_modulus,
               line = dem::line_contact_stiffness(0.5 * E / (1.0 - c.poisson_ratio * c.poisson_ratio));
  double least = INFINITY;
  for (std::size_t i = 0; i < in.grains.position.size(); ++i) {
    const double radius = 0.5 * static_cast<double>(in.grains.diameter[i]), density = in.grains.density[i];
    const double mass = density * (plane ? 3.14159265 * radius * radius : 4.1887902 * radius * radius * radius);
    least = std::min(
        least, c.law == "hertz" && !plane
                   ? dem::rayleigh_time(radius, density, E, c.poisson_ratio)
                   : 0.25 * dem::linear_contact_time(c.law == "hertz" ? line : c.stiffness, 0.5 * mass, c.restitution));
  }
  return in.time.grain_step_share * least;
}

void describe_time(SceneSummary& s, const Scene& scene, const SimulationInput& in, const ExpectedSpeed& expected) {
  const sph::FluidParameters& p = in.fluid_parameters;
  const bool split = in.time.scheme == TimeScheme::split;
  const double cfl = in.time.cfl > 0.0 ? in.time.cfl : (split ? split_default_cfl : verlet_default_cfl);
  const double artificial = p.viscosity == sph::Viscosity::artificial
                                ? p.artificial_viscosity * p.h * p.sound_speed / (2.0 * (p.dimensions + 2))
                                : 0.0;
  FluidStepLimit limit =
      fluid_step_limit(cfl, p.h, p.sound_speed, expected.speed, norm(p.gravity), p.kinematic_viscosity + artificial);
  if (in.time.fixed_step > 0.0) limit = {in.time.fixed_step, "numerics.time_step"};
  s.time_step = limit.dt;
  std::string text = std::string(split ? "split" : "Verlet") + ", step about " + number_text(limit.dt, 2) + " s (" +
                     limit.bound + (in.time.fixed_step > 0.0 ? ")" : ", CFL " + number_text(cfl) + ")");
  if (!in.grains.position.empty()) {
    const double dt = grain_step(scene, in);
    s.json["grain_time_step"] = dt;
    text += in.time.multirate
                ? ", " + std::to_string(std::max(1L, std::lround(std::ceil(limit.dt / dt)))) + " grain steps in each"
                : "; one step for all: " + number_text(std::min(dt, limit.dt), 2) + " s";
    if (!in.time.multirate) s.time_step = std::min(dt, limit.dt);
  }
  s.lines.push_back("time scheme       " + text);
  s.lines.push_back("                  " + number_text(scene.time.end) + " s simulated, about " +
                    number_text(std::ceil(scene.time.end / s.time_step), 2) + " steps");
  s.json["time_scheme"] = split ? "split" : "verlet";
  s.json["time_step_estimate"] = s.time_step;
  s.json["t_end"] = scene.time.end;
}

/// bytes: the grid of the grains has one cell a grain diameter wide throughout every block of 64 dp that holds some; a
/// slide that spreads comes to hold about twice as many blocks.
double grain_grid_bytes(const SimulationInput& in) {
  constexpr double block_spacings = 64.0, bytes_per_cell = 4.0, spreading = 2.0;
  const std::size_t n = in.grains.position.size();
  if (n == 0) return 0.0;
  const double width = block_spacings * in.fluid_parameters.dp;
  std::set<std::array<std::int64_t, 3>> blocks;
  double diameters = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    std::array<std::int64_t, 3> block{};
    for (int axis = 0; axis < 3; ++axis)
      block[static_cast<std::size_t>(axis)] =
          static_cast<std::int64_t>(std::floor((in.grains.position[i][axis] - in.lower[axis]) / width));
    blocks.insert(block);
    diameters += static_cast<double>(in.grains.diameter[i]);
  }
  const double cells = width / std::max(1.1 * diameters / static_cast<double>(n), 1.0e-3 * width);
  return spreading * bytes_per_cell * static_cast<double>(blocks.size()) *
         std::pow(cells, in.fluid_parameters.dimensions);
}

double estimate_memory(const SimulationInput& in) {
  const bool coupled = in.coupling.enabled && !in.grains.position.empty();
  return base_bytes +
         (fluid_bytes + (coupled ? coupled_fluid_bytes : 0.0)) * static_cast<double>(in.fluid.position.size()) +
         wall_bytes * static_cast<double>(in.boundary.position.size()) +
         grain_bytes * static_cast<double>(in.grains.position.size()) +
         triangle_bytes * static_cast<double>(in.walls.triangle.size()) + grain_grid_bytes(in);
}

double number_in_file(const char* path, const char* key) {
  std::ifstream file(path);
  std::string word;
  double value = -1.0;
  if (*key == '\0') return file >> value ? value : -1.0;
  while (file >> word)
    if (word == key && file >> value) return value;
  return -1.0;
}

}  // namespace

SceneSummary summarize(const Scene& scene, const SimulationInput& in, const ExpectedSpeed& expected,
                       const std::string& device, int threads) {
  SceneSummary s;
  s.moving_particles = in.fluid.position.size() + in.grains.position.size();
  s.json = {{"title", scene.title},
            {"dimensions", scene.dimensions},
            {"preset", scene.numerics.preset},
            {"dp", scene.dp},
            {"h", in.fluid_parameters.h},
            {"sound_speed", in.fluid_parameters.sound_speed},
            {"expected_speed", expected.speed},
            {"expected_speed_from", expected.source},
            {"fluid_particles", in.fluid.position.size()},
            {"wall_particles", in.boundary.position.size()},
            {"grains", in.grains.position.size()},
            {"wall_triangles", in.walls.triangle.size()},
            {"bodies", in.bodies.size()},
            {"models", ordered_json::object()}};
  s.lines.push_back((scene.title.empty() ? std::string("case") : scene.title) + ", " +
                    std::to_string(scene.dimensions) + "D, preset " + scene.numerics.preset);
  describe_water(s, in, expected);
  describe_grains(s, scene, in);
  describe_bodies(s, in);
  describe_time(s, scene, in, expected);
  s.memory = estimate_memory(in);
  s.json["memory_estimate"] = s.memory;
  s.lines.push_back("device            " + device +
                    (device == "cpu" ? ", " + std::to_string(threads) + (threads == 1 ? " thread" : " threads") : "") +
                    "; memory about " + memory_text(s.memory));
  return s;
}

double available_memory(const std::string& device) {
  if (device.rfind("cuda:", 0) == 0) {
    const int number = std::stoi(device.substr(5));
    for (const auto& d : exec::cuda_devices())
      if (d.number == number) return d.memory_bytes;
    return INFINITY;  // taking the device will say what is wrong
  }
  double free = number_in_file("/proc/meminfo", "MemAvailable:") * 1024.0;
  if (free < 0.0) return INFINITY;
  const double limit = number_in_file("/sys/fs/cgroup/memory.max", ""),
               used = number_in_file("/sys/fs/cgroup/memory.current", "");
  const double cached = number_in_file("/sys/fs/cgroup/memory.stat", "inactive_file");
  if (limit > 0.0 && used >= 0.0) free = std::min(free, limit - used + std::max(cached, 0.0));
  rlimit own{};
  const double pages = number_in_file("/proc/self/statm", "");
  if (::getrlimit(RLIMIT_AS, &own) == 0 && own.rlim_cur != RLIM_INFINITY && pages > 0.0)  // ulimit -v
    free = std::min(free, static_cast<double>(own.rlim_cur) - pages * static_cast<double>(::sysconf(_SC_PAGESIZE)));
  return std::max(free, 1.0e6);
}

void check_memory(const SceneSummary& summary, const Scene& scene, const std::string& device, double free) {
  if (summary.memory <= free) return;
  const double fits = scene.dp * std::pow(summary.memory / free, 1.0 / scene.dimensions);
  throw Error(ErrorKind::resource, "the case needs about " + memory_text(summary.memory) + " of memory, " + device +
                                       " has " + memory_text(free) +
                                       " free; resolution.dp = " + number_text(1.02 * fits, 3) + " m would fit (now " +
                                       number_text(scene.dp) + " m)");
}

std::string memory_text(double bytes) {
  const char* const unit[] = {"B", "KiB", "MiB", "GiB", "TiB"};
  int k = 0;
  while (bytes >= 1024.0 && k < 4) bytes /= 1024.0, ++k;
  return number_text(bytes, 3) + " " + unit[k];
}

std::string number_text(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string duration_text(double seconds) {
  if (!std::isfinite(seconds)) return "unknown";
  if (seconds < 90.0) return number_text(seconds, 3) + " s";
  const auto minutes = static_cast<long long>(std::llround(seconds / 60.0));
  if (minutes < 90) return std::to_string(minutes) + " min";
  if (minutes < 48 * 60) return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min";
  return number_text(seconds / 86400.0, 3) + " days";
}

}  // namespace gdesp::tool
