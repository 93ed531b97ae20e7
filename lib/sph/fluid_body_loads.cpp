// SPDX-License-Identifier: GPL-3.0-or-later
// @eq sph.body-load
//   F = sum_w f_w,  T = sum_w (r_w - X) x f_w,  f_w = sum_a m_a c^2 B_w B_a (A_a + A_w + viscosity) G_aw (r_w - r_a)
//   F [N], T [N m]: load of the water on a body with centre X [m], from its wall particles w and the fluid particles a; A, B, G as
//   in sph.momentum. f_w is, term by term, what the momentum pass takes from the fluid: action = reaction to round-off.
//   Sums are in whole units (64-bit), so that their order does not matter.
//   Source: Monaghan, Kos, Issa (2003), J. Waterway Port Coastal Ocean Eng. 129, 250, doi:10.1061/(ASCE)0733-950X(2003)129:6(250).
#include <cmath>

#include "sph/fluid_system.hpp"
#include "sph/pressure_and_viscosity.hpp"
#include "sph/wall_extrapolation.hpp"

namespace gdesp::sph {
namespace {

// Force on each wall particle of a body that is asked for, in the units of `scale`.
template <Viscosity Kind>
struct WallForces {
  FluidPairLaw law;
  float scale;  // rho0 dp^dimensions c^2, J
  ClusterListView list;
  const float* fluid;
  const float* walls;
  const float* wall_friction;
  const std::int32_t* body;
  const std::int32_t* asked;  // by body number
  const float* own_pressure;  // of the fluid; null: A of the record
  const float* wall_ghost;    // null: no no-slip walls
  float* force;               // fx fy fz, 4 each, per cluster

  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const std::int32_t* b = body + 4 * static_cast<std::int64_t>(c);
    if (!asked[b[0]] && !asked[b[1]] && !asked[b[2]] && !asked[b[3]]) return;
    const float* ri = walls + record_offset(c);
    const Real x = lanes.load_i(ri), y = lanes.load_i(ri + 4), z = lanes.load_i(ri + 8), B = lanes.load_i(ri + 12);
    const float* vi = wall_ghost ? wall_ghost + 16 * static_cast<std::int64_t>(c) : ri + 16;
    const Real vx = lanes.load_i(vi), vy = lanes.load_i(vi + 4), vz = lanes.load_i(vi + 8), A = lanes.load_i(ri + 28);
    const Real friction = lanes.load_i(wall_friction + 4 * static_cast<std::int64_t>(c));
    FluidRates<Real> rates;
    for_each_cluster(list, c, [&](Index j, const Vec3f& shift) {
      const float* rj = fluid + record_offset(j);
      const float* Aj = own_pressure ? own_pressure + 4 * static_cast<std::int64_t>(j) : rj + 28;
      const Real A_f = lanes.load_j(Aj);
      add_fluid_pair<true, false, Kind, false>(
          law, x + Real(shift.x) - lanes.load_j(rj), y + Real(shift.y) - lanes.load_j(rj + 4),
          z + Real(shift.z) - lanes.load_j(rj + 8), vx - lanes.load_j(rj + 16), vy - lanes.load_j(rj + 20),
          vz - lanes.load_j(rj + 24), pressing_wall(A, A_f), A_f, lanes.load_j(rj + 12), friction, rates);
    });
    float* out = force + 12 * static_cast<std::int64_t>(c);
    const Real factor = Real(scale) * B;
    lanes.store_sum_i(out, rates.ax * factor);
    lanes.store_sum_i(out + 4, rates.ay * factor);
    lanes.store_sum_i(out + 8, rates.az * factor);
  }
};

struct AddLoads {
  Domain domain;
  const std::uint32_t* id;
  const std::int32_t* body;
  const std::int32_t* asked;
  const FixedPosition* position;
  const WallBodyState* bodies;
  const float* force;
  double inverse_unit, inverse_torque_unit;
  std::int64_t* sum;  // 6 a body
  GDESP_HD void operator()(Index s) const {
    if (id[s] == no_particle || !asked[body[s]]) return;
    const float* f = force + 12 * static_cast<std::int64_t>(s / exec::cluster_size) + s % exec::cluster_size;
    const Vec3d load{static_cast<double>(f[0]), static_cast<double>(f[4]), static_cast<double>(f[8])};
    if (load == Vec3d{}) return;
    const Vec3d torque = cross(domain.metres(position[s]) - bodies[body[s] - 1].centre, load);
    std::int64_t* to = sum + 6 * (body[s] - 1);
    for (int axis = 0; axis < 3; ++axis) {
      exec::add_units(to + axis, static_cast<std::int64_t>(::llrint(load[axis] * inverse_unit)));
      exec::add_units(to + 3 + axis, static_cast<std::int64_t>(::llrint(torque[axis] * inverse_torque_unit)));
    }
  }
};

}  // namespace

template <class Exec>
std::vector<WallLoad> FluidSystem<Exec>::body_loads(const std::vector<std::int32_t>& asked, LoadsOf pass) {
  const std::size_t bodies = asked.size() - 1;
  std::vector<WallLoad> loads(bodies);
  if (wall_set_.clusters() == 0 || wall_bodies_.empty()) return loads;
  const FluidParameters& p = parameters_;
  const double c2 = p.sound_speed * p.sound_speed, volume = std::pow(p.dp, p.dimensions);
  body_asked_.assign(asked);
  body_sum_.assign(std::vector<std::int64_t>(6 * bodies, 0));
  body_force_.resize_discard(3 * static_cast<std::size_t>(wall_set_.slots()));
  body_force_.fill_bytes(0);
  const auto run = [&](auto pass) { exec::pair_pass(exec_, "sph::body_loads", wall_set_.clusters(), pass); };
  const auto scale = static_cast<float>(p.reference_density * volume * c2);
  const ClusterListView list = wall_fluid_.view();
  // As the pass saw the water and the walls.
  const bool light = pass == LoadsOf::momentum_pass;
  const float* own_pressure = light && p.tensile_control ? own_pressure_.data() : nullptr;
  const float* ghost = light && no_slip_ ? wall_ghost_.data() : nullptr;
  if (p.viscosity == Viscosity::none) {
    run(WallForces<Viscosity::none>{pair_law(), scale, list, record_.data(), wall_record_.data(), wall_friction_.data(),
                                    wall_body_.data(), body_asked_.data(), own_pressure, ghost, body_force_.data()});
  } else if (p.viscosity == Viscosity::morris) {
    run(WallForces<Viscosity::morris>{pair_law(), scale, list, record_.data(), wall_record_.data(),
                                      wall_friction_.data(), wall_body_.data(), body_asked_.data(), own_pressure, ghost,
                                      body_force_.data()});
  } else {
    run(WallForces<Viscosity::artificial>{pair_law(), scale, list, record_.data(), wall_record_.data(),
                                          wall_friction_.data(), wall_body_.data(), body_asked_.data(), own_pressure,
                                          ghost, body_force_.data()});
  }
  // The force of a pressure rho0 c^2 on one particle's face is 2^40 units: sums reach 2^23 of them. Torques: arms of dp.
  const double unit = std::ldexp(p.reference_density * c2 * volume / p.dp, -40), torque_unit = unit * p.dp;
  exec::parallel_for(
      exec_, "sph::body_loads", wall_set_.slots(),
      AddLoads{domain_, wall_id_.data(), wall_body_.data(), body_asked_.data(), wall_position_.data(),
               wall_bodies_.data(), body_force_.data(), 1.0 / unit, 1.0 / torque_unit, body_sum_.data()});
  const std::vector<std::int64_t> sum = body_sum_.to_host();
  for (std::size_t b = 0; b < bodies; ++b) {
    for (int axis = 0; axis < 3; ++axis) {
      loads[b].force[axis] = unit * static_cast<double>(sum[6 * b + static_cast<std::size_t>(axis)]);
      loads[b].torque[axis] = torque_unit * static_cast<double>(sum[6 * b + 3 + static_cast<std::size_t>(axis)]);
    }
  }
  return loads;
}

template std::vector<WallLoad> FluidSystem<exec::CompiledBackend>::body_loads(const std::vector<std::int32_t>&,
                                                                              LoadsOf);

}  // namespace gdesp::sph
