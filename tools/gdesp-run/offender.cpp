// SPDX-License-Identifier: GPL-3.0-or-later
#include "offender.hpp"

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "scene_summary.hpp"

namespace gdesp::tool {
namespace {

using Cause = Trouble::Cause;

double speed(const Vec3f& v) {
  return std::sqrt(static_cast<double>(v.x) * static_cast<double>(v.x) +
                   static_cast<double>(v.y) * static_cast<double>(v.y) +
                   static_cast<double>(v.z) * static_cast<double>(v.z));
}

std::string speed_text(double v) { return std::isfinite(v) ? number_text(v) + " m/s" : "a speed that is no number"; }

/// The row with the largest value; one that is not a number counts as the largest.
template <class Value>
std::optional<std::size_t> worst(std::size_t count, const Value& value) {
  std::optional<std::size_t> found;
  double largest = -1.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double v = value(k);
    if (!std::isfinite(v)) return k;
    if (v > largest) {
      largest = v;
      found = k;
    }
  }
  return found;
}

template <class Table>
Offender row_of(const Table& table, std::size_t k, bool is_grain, const std::string& value) {
  Offender o;
  o.is_grain = is_grain;
  o.id = table.id[k];
  o.value = value;
  o.place = table.position[k];
  o.has_place = std::isfinite(speed(table.velocity[k]));  // else it went wherever
  return o;
}

template <class Table>
std::optional<Offender> fastest(const Table& table, bool is_grain) {
  const auto k = worst(table.position.size(), [&](std::size_t i) { return speed(table.velocity[i]); });
  if (!k) return std::nullopt;
  return row_of(table, *k, is_grain, speed_text(speed(table.velocity[*k])));
}

std::optional<Offender> fastest_of_all(Simulation& simulation) {
  auto water = fastest(simulation.fluid(), false), grain = fastest(simulation.grains(), true);
  if (!water || !grain) return water ? water : grain;
  if (!water->has_place) return water;
  if (!grain->has_place) return grain;
  const Diagnostics d = simulation.diagnostics();
  return d.largest_speed >= d.largest_grain_speed ? water : grain;
}

std::optional<Offender> densest(const FluidTable& water, double reference) {
  const auto error = [&](std::size_t k) { return static_cast<double>(water.density[k]) / reference - 1.0; };
  const auto k = worst(water.density.size(), [&](std::size_t i) { return std::abs(error(i)); });
  if (!k) return std::nullopt;
  return row_of(water, *k, false, "density " + number_text(static_cast<double>(water.density[*k])) + " kg/m3");
}

/// The pair of grains with the largest overlap over diameter, by cells one largest diameter wide.
std::optional<Offender> deepest_overlap(const GrainTable& grains) {
  double width = 0.0;
  for (const float d : grains.diameter) width = std::max(width, static_cast<double>(d));
  std::map<std::array<long, 3>, std::vector<std::size_t>> cells;
  const auto cell_of = [&](const Vec3d& r) {
    return std::array<long, 3>{std::lround(r.x / width), std::lround(r.y / width), std::lround(r.z / width)};
  };
  for (std::size_t i = 0; i < grains.position.size(); ++i) cells[cell_of(grains.position[i])].push_back(i);
  double most = 0.0;
  std::size_t first = 0, second = 0;
  for (std::size_t i = 0; i < grains.position.size(); ++i) {
    const std::array<long, 3> c = cell_of(grains.position[i]);
    for (int n = 0; n < 27; ++n) {
      const auto cell = cells.find({c[0] + n % 3 - 1, c[1] + n / 3 % 3 - 1, c[2] + n / 9 - 1});
      if (cell == cells.end()) continue;
      for (const std::size_t j : cell->second) {
        if (j <= i) continue;
        const double reach = 0.5 * static_cast<double>(grains.diameter[i] + grains.diameter[j]);
        const double share = 1.0 - norm(grains.position[i] - grains.position[j]) / reach;
        if (share > most) most = share, first = i, second = j;
      }
    }
  }
  if (most <= 0.0) return fastest(grains, true);  // it was a wall, or is over
  return row_of(grains, first, true,
                "which overlaps grain " + std::to_string(grains.id[second]) + " by " + number_text(100.0 * most, 3) +
                    " % of their diameter");
}

template <class Table>
std::optional<Vec3d> place_in(const Table& table, std::uint32_t id) {
  for (std::size_t k = 0; k < table.id.size(); ++k)
    if (table.id[k] == id) return table.position[k];
  return std::nullopt;
}

}  // namespace

std::optional<Offender> find_offender(Simulation& simulation, const Trouble& trouble, double reference_density) {
  switch (trouble.cause) {
    case Cause::all_lost:
      return std::nullopt;
    case Cause::mach:
    case Cause::step_collapse:
      return fastest(simulation.fluid(), false);
    case Cause::density:
      return densest(simulation.fluid(), reference_density);
    case Cause::overlap:
      return deepest_overlap(simulation.grains());
    case Cause::in_wall: {
      Offender o;
      o.id = trouble.id;
      const std::optional<Vec3d> place = place_of(simulation, o);
      o.has_place = place.has_value();
      o.place = place.value_or(Vec3d{});
      return o;
    }
    default:
      return fastest_of_all(simulation);
  }
}

std::optional<Vec3d> place_of(Simulation& simulation, const Offender& offender) {
  return offender.is_grain ? place_in(simulation.grains(), offender.id) : place_in(simulation.fluid(), offender.id);
}

std::string offender_text(const Offender& o, const Vec3d& offset) {
  std::string text = (o.is_grain ? "grain " : "water particle ") + std::to_string(o.id);
  if (o.has_place) {
    const Vec3d r = o.place + offset;
    text += " at (" + number_text(r.x, 9) + ", " + number_text(r.y, 9) + ", " + number_text(r.z, 9) + ") m";
  }
  return o.value.empty() ? text : text + ", " + o.value;
}

}  // namespace gdesp::tool
