// SPDX-License-Identifier: GPL-3.0-or-later
#include "case_to_input.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "scene_economy.hpp"
#include "sph/tait.hpp"

namespace gdesp::tool {
namespace {

constexpr double granular_share = 0.7;   // of the speed of free fall
constexpr double fastest_slide = 100.0;  // m/s
constexpr double sound_over_speed = 10.0;
constexpr double rest_over_depth_time =
    5.0;                                  // sqrt(H/g), H the height of the water, that water stays awake undisturbed
constexpr double unresolved_layer = 0.2;  // dp

struct Extent {
  double low = INFINITY, high = -INFINITY, sum = 0.0;
  std::size_t count = 0;
  void add(double z) {
    low = std::min(low, z);
    high = std::max(high, z);
    sum += z;
    ++count;
  }
  double mean() const { return sum / static_cast<double>(count); }
};

void keep_larger(ExpectedSpeed& expected, double speed, const std::string& source) {
  if (speed > expected.speed) expected = {speed, source};
}

Extent extent_of(const std::vector<Vec3d>& position) {
  Extent extent;
  for (const Vec3d& r : position) extent.add(r.z);
  return extent;
}

double largest(const std::vector<Vec3f>& velocity) {
  float v2 = 0.0f;
  for (const Vec3f& v : velocity) v2 = std::max(v2, dot(v, v));
  return std::sqrt(static_cast<double>(v2));
}

double fall_speed(double gravity, double drop) {
  return drop > 0.0 ? std::min(std::sqrt(2.0 * gravity * drop), fastest_slide) : 0.0;
}

void consider_slides(const Case& c, double gravity, ExpectedSpeed& expected) {
  const std::size_t groups = std::max<std::size_t>(1, c.scene.slides.size());
  std::vector<Extent> extent(groups);
  for (std::size_t i = 0; i < c.grains.position.size(); ++i)
    extent[c.grains.group.empty() ? 0 : static_cast<std::size_t>(c.grains.group[i])].add(c.grains.position[i].z);
  const bool water = !c.fluid.position.empty();
  for (std::size_t g = 0; g < groups; ++g) {
    if (extent[g].count == 0) continue;
    const double drop = water ? extent[g].mean() - c.still_water_level : extent[g].high - extent[g].low;
    keep_larger(expected, granular_share * fall_speed(gravity, drop), "fall of the slide");
  }
  for (const Body& body : c.bodies)
    if (body.kind == BodyKind::free && water)
      keep_larger(expected, fall_speed(gravity, body.centre.z - c.still_water_level), "fall of " + body.name);
}

bool is_gate(const Scene& scene, const std::string& name) {
  return std::any_of(scene.moving.begin(), scene.moving.end(),
                     [&](const MovingBody& body) { return body.name == name && body.kind == "gate"; });
}

void consider_motions(const Case& c, ExpectedSpeed& expected) {
  for (const Body& body : c.bodies) {
    if (body.kind != BodyKind::prescribed || is_gate(c.scene, body.name)) continue;
    const PrescribedMotion& m = body.motion;
    for (std::size_t k = 1; k < m.time.size(); ++k)
      keep_larger(expected, norm(m.displacement[k] - m.displacement[k - 1]) / (m.time[k] - m.time[k - 1]),
                  "motion of " + body.name);
  }
}

sph::ActivityParameters activity_parameters(const Case& c) {
  sph::ActivityParameters p;
  // Walls beside sleeping water keep no pressure, and a body that moves under its load needs that.
  p.sleep = c.scene.economy.sleep &&
            std::all_of(c.bodies.begin(), c.bodies.end(), [](const Body& b) { return b.kind == BodyKind::prescribed; });
  p.wake_speed = c.scene.economy.wake_speed;
  p.near_walls = c.scene.economy.near_walls;
  if (!c.fluid.position.empty()) {
    const Extent water = extent_of(c.fluid.position);
    p.rest_time = rest_over_depth_time *
                  std::sqrt((water.high - water.low + c.scene.dp) / std::max(norm(c.scene.gravity), 1.0e-9));
  }
  return p;
}

sph::FluidParameters fluid_parameters(const Case& c) {
  const Scene& s = c.scene;
  const Numerics& n = s.numerics;
  if (n.time_scheme != "split" && (n.shifting > 0.0 || n.tension == "controlled"))
    throw Error(ErrorKind::input, "numerics.time_scheme = \"" + n.time_scheme +
                                      "\": shifting and tension = \"controlled\" need \"split\"");
  sph::FluidParameters p;
  p.dp = s.dp;
  p.h = n.smoothing_ratio * s.dp;
  p.reference_density = s.fluid.density;
  p.sound_speed = n.sound_speed > 0.0 ? n.sound_speed : sound_over_speed * expected_speed(c).speed;
  p.gravity = s.gravity;
  p.kinematic_viscosity = s.fluid.kinematic_viscosity;
  p.viscosity = n.viscosity == "morris" ? sph::Viscosity::morris
                                        : (n.viscosity == "none" ? sph::Viscosity::none : sph::Viscosity::artificial);
  p.artificial_viscosity = n.artificial_viscosity;
  p.density_diffusion = n.density_diffusion;
  p.extrapolated_walls = n.walls == "extrapolated";
  p.paper_form = n.preset == "paper";
  p.cavitates = n.tension == "cavitation";
  p.tensile_control = n.tension == "controlled";
  p.shifting = n.shifting;
  p.dimensions = s.dimensions;
  p.skin = n.skin;
  p.level = c.still_water_level;
  p.activity = activity_parameters(c);
  if (viscosity_is_without_effect(s)) p.viscosity = sph::Viscosity::none;
  return p;
}

/// Water that brings pressures (Pa) and no densities starts at the densities of these.
void set_density(FluidTable& fluid, const sph::FluidParameters& p) {
  if (fluid.pressure.empty() || !fluid.density.empty()) return;
  const double stiffness = p.reference_density * p.sound_speed * p.sound_speed;
  for (const float pressure : fluid.pressure)
    fluid.density.push_back(
        static_cast<float>(p.reference_density * (1.0 + sph::tait_density(static_cast<float>(pressure / stiffness)))));
}

CouplingParameters coupling_parameters(const Scene& s) {
  CouplingParameters p;
  p.enabled = s.coupling.enabled;
  p.drag = s.coupling.drag == "di-felice" ? coupling::Drag::di_felice : coupling::Drag::ergun_wen_yu;
  p.smoothing_length = s.coupling.smoothing_length;
  p.added_mass = s.coupling.added_mass;
  for (const Slide& slide : s.slides) p.real_diameter.push_back(slide.real_diameter);
  return p;
}

TimeParameters time_parameters(const Numerics& n) {
  TimeParameters p;
  p.scheme = n.time_scheme == "verlet" ? TimeScheme::verlet : TimeScheme::split;
  p.cfl = n.cfl;
  p.fixed_step = n.time_step;
  p.multirate = n.multirate;
  p.grain_step_share = n.grain_time_step_share;
  return p;
}

/// The domain, grown where the case's own particles lie outside (walls reach below the terrain), but not across a
/// period: there the box is the period.
void set_domain(const Case& c, SimulationInput& input) {
  input.lower = c.domain.lower;
  input.upper = c.domain.upper;
  for (const std::string& axis : c.scene.periodic) input.periodic[axis == "x" ? 0 : axis == "y" ? 1 : 2] = true;
  const double margin = c.scene.dp;
  const auto include = [&](const std::vector<Vec3d>& position) {
    for (const Vec3d& r : position)
      for (int axis = 0; axis < 3; ++axis) {
        if (input.periodic[axis]) continue;
        input.lower[axis] = std::min(input.lower[axis], r[axis] - margin);
        input.upper[axis] = std::max(input.upper[axis], r[axis] + margin);
      }
  };
  include(c.fluid.position);
  include(c.boundary.position);
  include(c.grains.position);
  if (c.scene.dimensions == 2) {
    input.lower.y = -margin;
    input.upper.y = margin;
  }
}

}  // namespace

ExpectedSpeed expected_speed(const Case& c) {
  if (c.scene.numerics.expected_speed > 0.0) return {c.scene.numerics.expected_speed, "numerics.expected_speed"};
  const double gravity = norm(c.scene.gravity);
  ExpectedSpeed expected;
  if (!c.fluid.position.empty()) {
    const Extent water = extent_of(c.fluid.position);
    keep_larger(expected, std::sqrt(2.0 * gravity * (water.high - water.low + c.scene.dp)), "height of the water");
  }
  consider_slides(c, gravity, expected);
  consider_motions(c, expected);
  keep_larger(expected, largest(c.fluid.velocity), "velocity of the water at the start");
  keep_larger(expected, largest(c.grains.velocity), "velocity of the grains at the start");
  for (const Slide& slide : c.scene.slides)
    keep_larger(expected, norm(slide.velocity), "velocity of the slide at the start");
  keep_larger(expected, std::sqrt(gravity * c.scene.dp), "fall over one spacing");
  if (!(expected.speed > 0.0))
    throw Error(ErrorKind::input,
                "no speed can be expected (no gravity, nothing moves): give numerics.expected_speed "
                "or numerics.sound_speed (m/s)");
  return expected;
}

bool viscosity_is_without_effect(const Scene& s) {
  return s.economy.viscosity && s.numerics.viscosity == "morris" &&
         std::sqrt(s.fluid.kinematic_viscosity * s.time.end) < unresolved_layer * s.dp;
}

dem::ContactParameters contact_parameters(const Contact& c) {
  dem::ContactParameters p;
  p.law = c.law == "linear" ? dem::ContactLawKind::linear : dem::ContactLawKind::hertz;
  p.youngs_modulus = c.youngs_modulus;
  p.poisson_ratio = c.poisson_ratio;
  p.stiffness = c.stiffness;
  p.stiffness_ratio = c.stiffness_ratio;
  p.restitution = c.restitution;
  p.friction = c.friction;
  p.wall_friction = c.wall_friction;
  p.rolling_friction = c.rolling_friction;
  p.cohesion = c.cohesion;
  return p;
}

void choose_youngs_modulus(SimulationInput& input, double expected_speed) {
  double& E = input.contact.youngs_modulus;
  if (E > 0.0) return;
  E = 1.0e7;
  const bool weighs = !input.grains.position.empty() && norm(input.fluid_parameters.gravity) > 0.0;
  if (weighs && input.contact.law == dem::ContactLawKind::hertz) E = contact_softness(input, expected_speed).stiffness;
}

SimulationInput case_to_input(Case& c) {
  SimulationInput input;
  const double speed = norm(c.scene.gravity) > 0.0 ? expected_speed(c).speed : 0.0;  // before the particles move out
  set_domain(c, input);
  input.fluid_parameters = fluid_parameters(c);
  input.contact = contact_parameters(c.scene.contact);
  input.coupling = coupling_parameters(c.scene);
  input.time = time_parameters(c.scene.numerics);
  for (const Slide& slide : c.scene.slides) input.release_time.push_back(slide.release_at);
  input.fluid = std::move(c.fluid);
  set_density(input.fluid, input.fluid_parameters);
  input.boundary = std::move(c.boundary);
  input.grains = std::move(c.grains);
  choose_youngs_modulus(input, speed);
  input.walls = c.walls;
  input.bodies = c.bodies;
  return input;
}

}  // namespace gdesp::tool
