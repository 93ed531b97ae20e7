// SPDX-License-Identifier: GPL-3.0-or-later
#include "scenes.hpp"

namespace gdesp::bench {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr long patch_across = 16, patch_layers = 22;  // grains of the patch that is let settle

// A wall particle outside the inside [0, size] of a tank: depth below the nearest face, normal into the tank.
void add_wall_particle(BoundaryTable& walls, const Vec3d& r, const Vec3d& size) {
  Vec3d out;
  for (int axis = 0; axis < 3; ++axis) {
    if (r[axis] < 0.0) out[axis] = r[axis];
    if (r[axis] > size[axis]) out[axis] = r[axis] - size[axis];
  }
  const double depth = norm(out);
  walls.position.push_back(r);
  walls.depth.push_back(static_cast<float>(depth));
  walls.normal.push_back(static_cast<Vec3f>(out * (-1.0 / depth)));
}

// Three layers around nx x ny x nz cells of spacing dp; open at the top.
BoundaryTable tank_walls(long nx, long ny, long nz, double dp) {
  BoundaryTable walls;
  const Vec3d size{static_cast<double>(nx) * dp, static_cast<double>(ny) * dp, static_cast<double>(nz) * dp};
  const auto place = [&](long k) { return (static_cast<double>(k) + 0.5) * dp; };
  for (long i = -3; i < nx + 3; ++i)
    for (long j = -3; j < ny + 3; ++j)
      for (long k = -3; k < nz; ++k) {
        if (i >= 0 && i < nx && j >= 0 && j < ny && k >= 0) {
          k = nz - 1;  // the column is inside
          continue;
        }
        add_wall_particle(walls, {place(i), place(j), place(k)}, size);
      }
  return walls;
}

void set_water(SimulationInput& input, double depth, double h_over_dp) {
  auto& p = input.fluid_parameters;
  p.dp = spacing;
  p.h = h_over_dp * spacing;
  p.sound_speed = 10.0 * std::sqrt(2.0 * 9.81 * depth);
  p.kinematic_viscosity = 1.0e-6;
  p.artificial_viscosity = 0.05;
}

// Loose grains in a periodic column, jittered, falling.
GrainTable loose_patch() {
  const double pitch = static_cast<double>(patch_across) * grain_diameter / static_cast<double>(patch_across - 1);
  GrainTable table;
  Random random;
  for (long k = 0; k < (patch_across - 1) * (patch_across - 1) * patch_layers; ++k) {
    const long i = k % (patch_across - 1), j = k / (patch_across - 1) % (patch_across - 1);
    const long layer = k / ((patch_across - 1) * (patch_across - 1));
    const auto at = [&](long n) {
      return (static_cast<double>(n) + 0.5) * pitch + 0.05 * grain_diameter * (random() - 0.5);
    };
    table.position.push_back({at(i), at(j), at(layer)});
    table.diameter.push_back(static_cast<float>(grain_diameter));
    table.density.push_back(2500.0f);
    const auto v = [&] { return static_cast<float>(0.4 * (random() - 0.5)); };
    table.velocity.push_back({v(), v(), v()});
  }
  return table;
}

const GrainTable& settled_patch() {
  static const GrainTable patch = [] {
    const double side = static_cast<double>(patch_across) * grain_diameter;
    dem::GrainSystem<exec::OpenMP> grains({}, layer_domain(side, 0.5), loose_patch(), glass_like(), floor_of(side),
                                          {0.0, 0.0, -9.81});
    const double dt = grains.stable_time_step(0.2);
    grains.advance(0.35, static_cast<int>(0.35 / dt) + 1);
    GrainTable table = grains.table();
    for (Vec3d& r : table.position) {  // inside the period
      r.x -= side * std::floor(r.x / side);
      r.y -= side * std::floor(r.y / side);
    }
    return table;
  }();
  return patch;
}

}  // namespace

FluidTable jittered_block(int n, double dp) {
  FluidTable table;
  Random random;
  const auto jitter = [&] { return 0.3 * dp * (random() - 0.5); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        table.position.push_back({(i + 0.5) * dp + jitter(), (j + 0.5) * dp + jitter(), (k + 0.5) * dp + jitter()});
        table.velocity.push_back(
            {static_cast<float>(jitter()), static_cast<float>(jitter()), static_cast<float>(jitter())});
        table.density.push_back(1000.0f);
      }
  return table;
}

SimulationInput dam_break(long particles, double h_over_dp) {
  const int n = static_cast<int>(std::lround(std::cbrt(static_cast<double>(particles))));
  const double depth = n * spacing, speed = std::sqrt(2.0 * 9.81 * depth);
  SimulationInput input;
  set_water(input, depth, h_over_dp);
  input.fluid = jittered_block(n, spacing);
  const double half = 0.5 * spacing;
  for (std::size_t k = 0; k < input.fluid.position.size(); ++k) {
    Vec3d& r = input.fluid.position[k];
    for (int axis = 0; axis < 3; ++axis) r[axis] = std::clamp(r[axis], half, depth - half);
    // A stagnation flow: no divergence, no flow through the floor or the back wall.
    const double x = r.x / depth, z = r.z / depth;
    input.fluid.velocity[k] += Vec3f{static_cast<float>(speed * x), 0.0f, static_cast<float>(-speed * z)};
    input.fluid.density[k] =
        static_cast<float>(1000.0 * (1.0 + 9.81 * (depth - r.z) / std::pow(input.fluid_parameters.sound_speed, 2.0)));
  }
  const long height = n + n / 2;
  input.boundary = tank_walls(3L * n, n, height, spacing);
  const double margin = 6.0 * spacing;
  input.lower = {-margin, -margin, -margin};
  input.upper = {3.0 * depth + margin, depth + margin, static_cast<double>(height) * spacing + margin};
  return input;
}

dem::ContactParameters glass_like() {
  dem::ContactParameters contact;
  contact.youngs_modulus = 2.0e7;
  contact.restitution = 0.5;
  contact.friction = 0.5;
  return contact;
}

TriangleTable floor_of(double side) {
  TriangleTable t;
  const double d = grain_diameter;
  t.vertex = {{-d, -d, 0.0}, {side + d, -d, 0.0}, {side + d, side + d, 0.0}, {-d, side + d, 0.0}};
  t.triangle = {{0, 1, 2}, {0, 2, 3}};
  t.body = {0, 0};
  return t;
}

Domain layer_domain(double side, double height) {
  const bool periodic[3] = {true, true, false};
  return make_domain({0.0, 0.0, -0.1}, {side, side, height}, grain_diameter, periodic, 3);
}

GrainTable settled_grains(long grains, double& side) {
  const GrainTable& patch = settled_patch();
  const double width = static_cast<double>(patch_across) * grain_diameter;
  const long copies =
      std::max(1L, std::lround(std::sqrt(static_cast<double>(grains) / static_cast<double>(patch.position.size()))));
  side = static_cast<double>(copies) * width;
  GrainTable table;
  for (long i = 0; i < copies; ++i)
    for (long j = 0; j < copies; ++j) {
      for (const Vec3d& r : patch.position) {
        table.position.push_back(r + Vec3d{static_cast<double>(i) * width, static_cast<double>(j) * width, 0.0});
      }
      table.velocity.insert(table.velocity.end(), patch.velocity.begin(), patch.velocity.end());
      table.angular_velocity.insert(table.angular_velocity.end(), patch.angular_velocity.begin(),
                                    patch.angular_velocity.end());
      table.diameter.insert(table.diameter.end(), patch.diameter.begin(), patch.diameter.end());
      table.density.insert(table.density.end(), patch.density.begin(), patch.density.end());
    }
  return table;
}

SimulationInput flooded_bed(long particles) {
  SimulationInput input;
  double side = 0.0;
  const long water_layers = 2 * patch_layers;
  // A grain has pi/6 d^3/0.6 of the layer, a particle of water d^3; both have one diameter.
  input.grains = settled_grains(std::lround(static_cast<double>(particles) * 0.36), side);
  const double depth = static_cast<double>(water_layers) * spacing;
  set_water(input, depth, 1.5);
  const long n = std::lround(side / spacing);
  for (long i = 0; i < n; ++i)
    for (long j = 0; j < n; ++j)
      for (long k = 0; k < water_layers; ++k) {
        const auto at = [](long m) { return (static_cast<double>(m) + 0.5) * spacing; };
        input.fluid.position.push_back({at(i), at(j), at(k)});
        const double swirl = std::sin(2.0 * pi * at(i) / side);
        input.fluid.velocity.push_back({1.0f, static_cast<float>(0.2 * swirl), 0.0f});
      }
  for (long i = 0; i < n; ++i)
    for (long j = 0; j < n; ++j)
      for (long k = -3; k < 0; ++k) {
        input.boundary.position.push_back({(static_cast<double>(i) + 0.5) * spacing,
                                           (static_cast<double>(j) + 0.5) * spacing,
                                           (static_cast<double>(k) + 0.5) * spacing});
        input.boundary.depth.push_back(static_cast<float>((-static_cast<double>(k) - 0.5) * spacing));
        input.boundary.normal.push_back({0.0f, 0.0f, 1.0f});
      }
  for (Vec3f& v : input.grains.velocity) v += Vec3f{0.3f, 0.0f, 0.0f};
  input.contact = glass_like();
  input.walls = floor_of(side);
  input.lower = {0.0, 0.0, -0.1};
  input.upper = {side, side, 2.0 * depth};
  input.periodic[0] = input.periodic[1] = true;
  return input;
}

}  // namespace gdesp::bench
