// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over the grains, and the table for the host.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/grain_motion.hpp"
#include "dem/grain_system.hpp"
#include "dem/grain_tables.hpp"

namespace gdesp::dem {
namespace {

struct AddSums {
  GDESP_HD GrainSums operator()(const GrainSums& a, const GrainSums& b) const {
    GrainSums s;
    s.particles = a.particles + b.particles;
    s.mass = a.mass + b.mass;
    s.momentum = a.momentum + b.momentum;
    s.kinetic_energy = a.kinetic_energy + b.kinetic_energy;
    s.potential_energy = a.potential_energy + b.potential_energy;
    s.elastic_energy = a.elastic_energy + b.elastic_energy;
    s.contacts = a.contacts + b.contacts;
    s.wall_contacts = a.wall_contacts + b.wall_contacts;
    s.largest_speed = real::max(a.largest_speed, b.largest_speed);
    s.largest_overlap = real::max(a.largest_overlap, b.largest_overlap);
    return s;
  }
};

// One grain; of a contact each side counts half.
template <class Law>
struct GrainTerms {
  ContactLaws<Law> laws;
  Domain domain;
  PositionUnit unit;
  ContactRowsView rows;
  const GrainRecord* records;
  GrainPlaces position;
  const Vec3f* velocity;
  const WallHistory* walls;
  Vec3d gravity;
  float inertia_factor;

  GDESP_HD void add_contact(const GrainRecord& own, const GrainRecord& other, const ContactRow& row, int lane,
                            GrainSums& s) const {
    const float reach = own.radius + other.radius;
    const float overlap = reach - norm(separation(unit, own, other));
    if (!(overlap > 0.0f)) return;
    const float radius = own.radius * other.radius / reach;
    const ContactCoefficients<float> c = laws.law(overlap, radius, harmonic_half(own.mass, other.mass));
    const Vec3f f{row.fx[lane], row.fy[lane], row.fz[lane]};
    s.elastic_energy += 0.5 * (Law::normal_energy(c.elastic_force, overlap) +
                               0.5f * dot(f, f) / real::max(c.tangential_stiffness, 1.0e-30f));
    s.contacts += 1;
  }
  GDESP_HD GrainSums operator()(Index i) const {
    GrainSums s;
    const GrainRecord& own = records[i];
    if (own.radius < 0.0f) return s;
    const double m = own.mass;
    const Vec3d v{own.vx, own.vy, own.vz}, surface{own.sx, own.sy, own.sz};
    s.particles = 1;
    s.mass = m;
    s.momentum = (own.mobility > 0.0f ? m : 0.0) * static_cast<Vec3d>(velocity[i]);
    s.kinetic_energy = 0.5 * m * (dot(v, v) + inertia_factor * dot(surface, surface));
    s.potential_energy = -m * dot(gravity, domain.metres(position[i]) - domain.lower);
    s.largest_speed = static_cast<float>(norm(v));
    const RowRange range = rows.range[i];
    for (Index k = 0; k * 8 < range.count; ++k) {
      const ContactRow& row = rows.rows[k == 0 ? i : range.overflow + k - 1];
      for (int lane = 0; lane < 8; ++lane) add_contact(own, records[row.neighbour[lane]], row, lane, s);
    }
    if (own.wall >= 0) s.wall_contacts = walls[own.wall].count;
    return s;
  }
};

}  // namespace

template <class Exec>
template <class Law>
GrainSums GrainSystem<Exec>::sums_with(const ContactLaws<Law>& pair) {
  const GrainTerms<Law> terms{
      pair,     domain_,          position_unit(domain_),  contacts_.view(), now_.data(),
      places(), velocity_.data(), walls_.history().data(), gravity_,         inertia_factor(domain_.dimensions)};
  return exec::reduce(exec_, "dem::sums", slots_, GrainSums{}, terms, AddSums{});
}

template <class Exec>
GrainSums GrainSystem<Exec>::sums() {
  GrainSums total = laws_.kind == ContactLawKind::hertz ? sums_with(laws_.hertz) : sums_with(laws_.linear);
  total.contacts /= 2;
  total.largest_overlap = overlap_;
  overlap_ = 0.0f;
  return total;
}

template <class Exec>
GrainTable GrainSystem<Exec>::table() const {
  const std::vector<FixedPosition> listed = position_.to_host();
  const std::vector<GrainRecord> record = now_.to_host();
  const std::vector<std::uint32_t> id = id_.to_host();
  const std::vector<std::int32_t> group = group_.to_host();
  std::vector<std::size_t> order;
  for (std::size_t s = 0; s < static_cast<std::size_t>(slots_); ++s) {
    if (id[s] != no_particle) order.push_back(s);
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return id[a] < id[b]; });
  const GrainPlaces places{listed.data(), record.data()};
  GrainTable table;
  for (std::size_t s : order) {
    const GrainRecord& r = record[s];
    const float diameter = 2.0f * r.radius;
    table.position.push_back(domain_.metres(places[static_cast<Index>(s)]));
    table.diameter.push_back(diameter);
    table.density.push_back(static_cast<float>(r.mass / grain_mass(diameter, 1.0, domain_.dimensions)));
    table.velocity.push_back({r.vx, r.vy, r.vz});
    table.angular_velocity.push_back((1.0f / r.radius) * Vec3f{r.sx, r.sy, r.sz});
    table.group.push_back(group[s]);
    table.id.push_back(id[s]);
  }
  return table;
}

template GrainSums GrainSystem<exec::CompiledBackend>::sums();
template GrainTable GrainSystem<exec::CompiledBackend>::table() const;

}  // namespace gdesp::dem
