// SPDX-License-Identifier: GPL-3.0-or-later
#include "dem/grain_step.hpp"

#include "dem/grain_motion.hpp"

namespace gdesp::dem {
namespace {

using exec::Float4;

template <class Law, bool Rolling>
struct GrainStep {
  ContactLaws<Law> laws;
  GrainStepView v;
  Float4 gravity, unit, inverse_unit;  // of v, side by side
  // 0 where a disc of a plane scene cannot go: rounding in the normals of walls would make a loaded heap buckle.
  Float4 moves, turns;

  template <class R>
  struct Sums {
    Vec3<R> force{}, torque{};  // N; N m / radius
    R overlap{0.0f};            // overlap / sum of radii
  };

  // What rolling resistance needs of a row besides the contacts: which lanes touch, and the neighbours' records.
  template <class R, class Mask>
  struct Neighbours {
    const Mask& touching;
    const R& radius;
    const R& mass;
    const R* surface;  // three: radius times angular velocity
  };

  // Eight contacts. q: gathered quarters of the neighbours' records.
  template <class Lanes>
  GDESP_HD void add_row(const GrainRecord& own, Index index, const Lanes& lanes,
                        Sums<typename Lanes::Real>& sums) const {
    using R = typename Lanes::Real;
    using I = typename Lanes::Int;
    using real::inverse_sqrt;
    using real::max;
    using real::select;
    ContactRow& row = v.contacts.rows[index];
    const I j = lanes.load(row.neighbour);
    const float* records = reinterpret_cast<const float*>(v.grains.record);
    R q[4];
    lanes.gather4(records, record_floats, j, q);
    const Vec3<R> r{lanes.value(I(own.x) - lanes.bits(q[0])) * R(v.unit.metres.x),
                    lanes.value(I(own.y) - lanes.bits(q[1])) * R(v.unit.metres.y),
                    lanes.value(I(own.z) - lanes.bits(q[2])) * R(v.unit.metres.z)};
    const R distance2 = max(dot(r, r), R(1.0e-30f)), inverse = inverse_sqrt(distance2), distance = distance2 * inverse;
    const R reach = R(own.radius) + q[3];
    const R overlap = reach - distance;
    const auto touching = overlap > R(0.0f);
    const R zero(0.0f);
    if (!lanes.any(touching)) {
      clear_history(row, index, lanes);
      return;
    }
    ContactGeometry<R> g;
    g.n = {r.x * inverse, r.y * inverse, r.z * inverse};
    g.overlap = max(overlap, R(1.0e-30f));
    const R inverse_reach = R(1.0f) / reach;
    g.radius = (R(own.radius) * q[3]) * inverse_reach;
    R velocity[4];
    lanes.gather4(records + 4, record_floats, j, velocity);
    g.mass = harmonic_half(R(own.mass), velocity[3]);
    const R mass_j = velocity[3], radius_j = q[3];
    R spin[4];
    lanes.gather4(records + 8, record_floats, j, spin);
    // Arms share the distance as the radii do: together they are |r_ij|, so angular momentum is kept exactly.
    const R share = distance * inverse_reach;
    const Vec3<R> surface{(R(own.sx) + spin[0]) * share, (R(own.sy) + spin[1]) * share, (R(own.sz) + spin[2]) * share};
    const Vec3<R> turning = cross(surface, g.n);
    g.velocity = {(R(own.vx) - velocity[0]) - turning.x, (R(own.vy) - velocity[1]) - turning.y,
                  (R(own.vz) - velocity[2]) - turning.z};
    Vec3<R> history{lanes.load(row.fx), lanes.load(row.fy), lanes.load(row.fz)};
    const ContactForce<R> c = contact_force(laws, g, v.half, history);
    lanes.store(row.fx, select(touching, history.x, zero));
    lanes.store(row.fy, select(touching, history.y, zero));
    lanes.store(row.fz, select(touching, history.z, zero));
    const Vec3<R> force{select(touching, c.force.x, zero), select(touching, c.force.y, zero),
                        select(touching, c.force.z, zero)};
    const Vec3<R> torque = cross(force, g.n);
    sums.force = {sums.force.x + force.x, sums.force.y + force.y, sums.force.z + force.z};
    sums.torque = {sums.torque.x + select(touching, torque.x * share, zero),
                   sums.torque.y + select(touching, torque.y * share, zero),
                   sums.torque.z + select(touching, torque.z * share, zero)};
    sums.overlap = max(sums.overlap, select(touching, overlap * inverse_reach, zero));
    if constexpr (Rolling) {
      const Vec3<R> t = rolling(own, v.contacts.rolling[index], g, c,
                                Neighbours<R, decltype(touching)>{touching, radius_j, mass_j, spin}, lanes);
      sums.torque = sums.torque + t;
    }
  }

  // Rolling torques over the grain's radius, N.
  template <class R, class Mask, class Lanes>
  GDESP_HD Vec3<R> rolling(const GrainRecord& own, RollingRow& row, const ContactGeometry<R>& g,
                           const ContactForce<R>& c, const Neighbours<R, Mask>& other, const Lanes& lanes) const {
    using real::select;
    const R zero(0.0f), radius_i(own.radius), about_contact(1.0f + v.inertia_factor);
    const R inertia_i = about_contact * R(own.mass) * R(own.radius) * R(own.radius);
    const R inertia_j = about_contact * other.mass * other.radius * other.radius;
    RollingMotion<R> motion;
    motion.n = g.n;
    // Quotients, not products: a fused multiply-add would round the two copies of the contact differently.
    motion.w = {R(own.sx) / radius_i - other.surface[0] / other.radius,
                R(own.sy) / radius_i - other.surface[1] / other.radius,
                R(own.sz) / radius_i - other.surface[2] / other.radius};
    motion.radius = g.radius;
    motion.inertia = harmonic_half(inertia_i, inertia_j);
    motion.normal_force = c.normal_force;
    motion.half_before = R(v.half.before);
    motion.half_after = R(v.half.after);
    Vec3<R> history{lanes.load(row.mx), lanes.load(row.my), lanes.load(row.mz)};
    const Vec3<R> t = rolling_torque(laws.rolling_friction, c.normal_stiffness, motion, history);
    lanes.store(row.mx, select(other.touching, history.x, zero));
    lanes.store(row.my, select(other.touching, history.y, zero));
    lanes.store(row.mz, select(other.touching, history.z, zero));
    return {select(other.touching, t.x / radius_i, zero), select(other.touching, t.y / radius_i, zero),
            select(other.touching, t.z / radius_i, zero)};
  }

  template <class Lanes>
  GDESP_HD void clear_history(ContactRow& row, Index index, const Lanes& lanes) const {
    using R = typename Lanes::Real;
    const R zero(0.0f);
    lanes.store(row.fx, zero);
    lanes.store(row.fy, zero);
    lanes.store(row.fz, zero);
    if constexpr (Rolling) {
      RollingRow& roll = v.contacts.rolling[index];
      lanes.store(roll.mx, zero);
      lanes.store(roll.my, zero);
      lanes.store(roll.mz, zero);
    }
  }

  // v(n+1/2) from all forces. What drag gave is what they leave of the change: momentum balances to round-off.
  GDESP_HD Float4 kicked_velocity(Index i, const GrainRecord& own, Float4 force, float kick, bool writes) const {
    const Float4 old = exec::load3(v.velocity[i]);
    force = force + own.mass * gravity;
    if (!v.fluid.drag_coefficient) return old + (kick / own.mass) * (moves * force);
    force = moves * (force + exec::load3(v.fluid.other_force[i]));
    const float mass = own.mass + v.fluid.added_mass[i];
    const Float4 free = old + (kick / mass) * force;
    const Float4 velocity = free + (1.0f / mass) * dragged(i, free, 1.0f / mass, kick, writes);
    if (writes) {
      const auto change = static_cast<Vec3d>(exec::first3(velocity)) - static_cast<Vec3d>(exec::first3(old));
      v.fluid.drag_impulse[i] +=
          static_cast<double>(mass) * change - static_cast<double>(kick) * static_cast<Vec3d>(exec::first3(force));
    }
    return velocity;
  }
  // Impulse of drag on a grain that would have the velocity `free`; the water around it answers.
  GDESP_HD Float4 dragged(Index i, const Float4& free, float inverse_mass, float kick, bool writes) const {
    const float drag = v.fluid.drag_coefficient[i];
    if (!(drag > 0.0f)) return Float4{0.0f, 0.0f, 0.0f, 0.0f};
    const DraggedPair pair{drag, inverse_mass, 1.0f / v.fluid.fluid_mass[i]};
    const Float4 u = exec::load3(v.fluid.fluid_velocity[i]) + kick * exec::load3(v.fluid.fluid_acceleration[i]);
    const Float4 impulse = drag_impulse(pair, kick, moves * (u - free));
    if (writes) v.fluid.fluid_velocity[i] = exec::first3(u - pair.inverse_water * impulse);
    return impulse;
  }

  // The four quarters of a record change side by side; what is last in each (radius, mass, mobility, wall) stays.
  GDESP_HD exec::Largest finish(Index i, const GrainRecord& own, const Float4& force, const Float4& torque,
                                float overlap, bool writes) const {
    // A grain released now starts from rest at time n: its first kick has no half before.
    const float kick = (own.mobility < 1.0f ? 0.0f : v.half.before) + v.half.after, drift = 2.0f * v.half.after;
    const Float4 velocity_old = exec::load3(v.velocity[i]), spin_old = exec::load3(v.spin[i]);
    const Float4 velocity = kicked_velocity(i, own, force, kick, writes);
    const float turn = kick / (v.inertia_factor * own.mass * own.radius * own.radius);
    const Float4 spin = spin_old + turn * (turns * torque);
    // Moves by whole units; the part of a unit that is left is owed.
    const float* record = reinterpret_cast<const float*>(&own);
    const Float4 wanted = drift * velocity * inverse_unit + exec::load3(Vec3f{own.rest_x, own.rest_y, own.rest_z});
    const Float4 whole = exec::rint(wanted);
    const exec::Int4 place = exec::bits(exec::load4(record)) + exec::truncate(whole);
    const float ahead = kick > 0.0f ? v.half.after / kick : 0.0f;
    const Float4 predicted = velocity + ahead * (velocity - velocity_old);
    const Float4 surface = own.radius * (spin + ahead * (spin - spin_old));
    if (writes) {
      v.velocity[i] = exec::first3(velocity);
      v.spin[i] = exec::first3(spin);
      float* next = reinterpret_cast<float*>(v.next + i);
      exec::store4(next, exec::from_bits(place));
      exec::store4(next + 4, exec::with_last_of(predicted, exec::load4(record + 4)));
      exec::store4(next + 8, exec::with_last_of(surface, Float4{1.0f, 1.0f, 1.0f, 1.0f}));
      exec::store4(next + 12, exec::with_last_of(wanted - whole, exec::load4(record + 12)));
    }
    const Float4 moved = exec::value(place - exec::load3(v.grains.listed_bits(i))) * unit;
    const float speed2 = exec::dot3(velocity, velocity);
    return {{exec::dot3(moved, moved), speed2, overlap, speed2 + exec::dot3(surface, surface) < 1.0e12f ? 0.0f : 1.0f}};
  }

  // Asks for the records that grain i will gather (host only: a device hides the wait by other warps).
  void prefetch(Index i) const {
    for (const Index j : v.contacts.rows[i].neighbour) __builtin_prefetch(v.grains.record + j);
  }

  template <class Lanes>
  GDESP_HD exec::Largest operator()(Index i, const Lanes& lanes) const {
    using R = typename Lanes::Real;
    const GrainRecord& own = v.grains.record[i];
    if (own.radius < 0.0f) return {};
    if (own.mobility == 0.0f) {
      if (lanes.leader()) {
        v.next[i] = own;
        if (v.fluid.drag_coefficient) {  // held against the flow: all that drag gives
          const Float4 pull = dragged(i, Float4{0.0f, 0.0f, 0.0f, 0.0f}, 0.0f, v.half.before + v.half.after, true);
          v.fluid.drag_impulse[i] += static_cast<Vec3d>(exec::first3(pull));
        }
      }
      return {};
    }
    const RowRange range = v.contacts.range[i];
    Sums<R> sums;
    for (Index k = 0; k * 8 < range.count; ++k) add_row(own, k == 0 ? i : range.overflow + k - 1, lanes, sums);
    Float4 force{0.0f, 0.0f, 0.0f, 0.0f}, torque = force;
    float overlap = 0.0f;
    if (range.count > 0) {
      force = lanes.sums(sums.force.x, sums.force.y, sums.force.z);
      torque = own.radius * lanes.sums(sums.torque.x, sums.torque.y, sums.torque.z);
      overlap = lanes.largest(sums.overlap);
    }
    if (own.wall >= 0) {
      force = force + exec::load3(v.walls[own.wall].force);
      torque = torque + exec::load3(v.walls[own.wall].torque);
    }
    return finish(i, own, force, torque, overlap, lanes.leader());
  }
};

}  // namespace

template <class Exec, class Law>
void run_grain_step(const Exec& exec, const ContactLaws<Law>& laws, const GrainStepView& view, Index slots,
                    const exec::Gate& gate, exec::Largest* measure) {
  const Float4 gravity = exec::load3(view.gravity), unit = exec::load3(view.unit.metres),
               inverse = exec::load3(view.unit.inverse);
  const float across = view.plane ? 0.0f : 1.0f;
  const Float4 moves{1.0f, across, 1.0f, 0.0f}, turns{across, 1.0f, across, 0.0f};
  if (view.contacts.rolling) {
    exec::row_pass(exec, "dem::step", slots, GrainStep<Law, true>{laws, view, gravity, unit, inverse, moves, turns},
                   gate, measure);
  } else {
    exec::row_pass(exec, "dem::step", slots, GrainStep<Law, false>{laws, view, gravity, unit, inverse, moves, turns},
                   gate, measure);
  }
}

template void run_grain_step(const exec::CompiledBackend&, const ContactLaws<HertzMindlin>&, const GrainStepView&,
                             Index, const exec::Gate&, exec::Largest*);
template void run_grain_step(const exec::CompiledBackend&, const ContactLaws<LinearSpringDashpot>&,
                             const GrainStepView&, Index, const exec::Gate&, exec::Largest*);

}  // namespace gdesp::dem
