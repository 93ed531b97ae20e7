// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem/grain_tables.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.hpp"
#include "dem/time_step_limits.hpp"

namespace gdesp::dem {
namespace {

constexpr double pi = 3.14159265358979324;

void check_column(const char* name, std::size_t size, std::size_t grains, bool required) {
  if (size == grains || (size == 0 && !required)) return;
  throw Error(ErrorKind::input, "grains: column " + std::string(name) + " has " + std::to_string(size) +
                                    " values for " + std::to_string(grains) + " grains");
}

void check_positive(const char* name, double value, const char* unit, std::size_t grain) {
  if (value > 0.0 && std::isfinite(value)) return;
  throw Error(ErrorKind::input, "grains: " + std::string(name) + " of grain " + std::to_string(grain) + " is " +
                                    std::to_string(value) + " " + unit + "; it must be positive");
}

void check_table(const GrainTable& table) {
  const std::size_t n = table.position.size();
  check_column("diameter", table.diameter.size(), n, true);
  check_column("density", table.density.size(), n, true);
  check_column("velocity", table.velocity.size(), n, false);
  check_column("angular_velocity", table.angular_velocity.size(), n, false);
  check_column("group", table.group.size(), n, false);
  check_column("id", table.id.size(), n, false);
  for (std::size_t i = 0; i < n; ++i) {
    check_positive("diameter", table.diameter[i], "m", i);
    check_positive("density", table.density[i], "kg/m3", i);
  }
}

}  // namespace

double grain_mass(double diameter, double density, int dimensions) {
  const double r = 0.5 * diameter;
  return density * (dimensions == 2 ? pi * r * r : 4.0 / 3.0 * pi * r * r * r);
}

GrainStart make_grain_start(const Domain& domain, const GrainTable& table) {
  check_table(table);
  GrainStart start;
  const std::size_t n = table.position.size();
  start.largest_radius = n == 0 ? 1.0e-3 * domain.tile_size.x : 0.0;
  start.smallest_radius = n == 0 ? start.largest_radius : 1.0e30;
  start.mean_radius = n == 0 ? start.largest_radius : 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    Vec3d place = table.position[i];
    if (domain.dimensions == 2) place.y = 0.0;
    const FixedPosition p = domain.wrapped(domain.fixed(place));
    Vec3f v = table.velocity.empty() ? Vec3f{} : table.velocity[i];
    Vec3f w = table.angular_velocity.empty() ? Vec3f{} : table.angular_velocity[i];
    if (domain.dimensions == 2) v.y = w.x = w.z = 0.0f;
    GrainRecord record{};
    record.x = static_cast<std::int32_t>(Domain::fraction_of(p.x));
    record.y = static_cast<std::int32_t>(Domain::fraction_of(p.y));
    record.z = static_cast<std::int32_t>(Domain::fraction_of(p.z));
    record.radius = 0.5f * table.diameter[i];
    record.mass = static_cast<float>(grain_mass(table.diameter[i], table.density[i], domain.dimensions));
    record.vx = v.x;
    record.vy = v.y;
    record.vz = v.z;
    record.sx = record.radius * w.x;
    record.sy = record.radius * w.y;
    record.sz = record.radius * w.z;
    record.mobility = 1.0f;
    record.wall = -1;
    start.position.push_back(p);
    start.id.push_back(table.id.empty() ? static_cast<std::uint32_t>(i) : table.id[i]);
    start.group.push_back(table.group.empty() ? 0 : table.group[i]);
    start.record.push_back(record);
    start.velocity.push_back(v);
    start.spin.push_back(w);
    const double r = record.radius;
    start.largest_radius = std::max(start.largest_radius, r);
    start.smallest_radius = std::min(start.smallest_radius, r);
    start.mean_radius += r / static_cast<double>(n);
    start.mass += record.mass;
    start.speed2 = std::max(start.speed2, dot(v, v));
  }
  return start;
}

double critical_time(const GrainStart& start, const ContactParameters& contact, const ContactLawSet& laws) {
  double shortest = 1.0e30;
  for (const GrainRecord& grain : start.record) {
    const double r = grain.radius;
    if (laws.kind == ContactLawKind::linear) {
      const double stiffness = std::max(laws.linear.law.stiffness, 0.5f * laws.linear_wall.law.stiffness);
      shortest = std::min(shortest, 0.25 * linear_contact_time(stiffness, 0.5 * grain.mass, contact.restitution));
    } else {
      const double density = grain.mass / (4.0 / 3.0 * pi * r * r * r);
      shortest = std::min(shortest, rayleigh_time(r, density, contact.youngs_modulus, contact.poisson_ratio));
    }
  }
  return shortest;
}

void check_reach(const Domain& domain, double reach) {
  for (int axis = 0; axis < 3; ++axis) {
    if (domain.dimensions == 2 && axis == 1) continue;
    if (reach <= 0.25 * domain.tile_size[axis]) continue;
    if (domain.periodic[axis] && domain.tiles[axis] == 1)
      throw Error(ErrorKind::input, "grains: the largest diameter with its skin, " + std::to_string(reach) +
                                        " m, is more than a quarter of the period of " +
                                        std::to_string(domain.tile_size[axis]) + " m along " + "xyz"[axis] +
                                        "; smaller grains or a wider slab (domain.lower, domain.upper) are needed");
    throw Error(ErrorKind::input, "grains: the largest diameter with its skin, " + std::to_string(reach) +
                                      " m, is more than a quarter of a block of the domain, " +
                                      std::to_string(domain.tile_size[axis]) +
                                      " m (64 particle spacings); a larger resolution.dp is needed");
  }
}

}  // namespace gdesp::dem
