// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/grain_fluid_coupling.hpp"

#include "coupling/drag.hpp"
#include "sph/wendland_c2.hpp"

namespace gdesp::coupling {
namespace {

constexpr float shepard_dry = 0.35f, shepard_wet = 0.65f;

// Share of a grain that is in the water, from its Shepard sum.
GDESP_HD inline float immersion(float S) {
  const float t = real::min(real::max((S - shepard_dry) / (shepard_wet - shepard_dry), 0.0f), 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

struct CouplingKernel {
  float inverse_support;  // 1/(2 h_c)
  float alpha;            // of W(h_c)
  template <class Real>
  GDESP_HD Real W(const Real& rx, const Real& ry, const Real& rz) const {
    using real::max;
    using real::sqrt;
    const Real t = max(Real(0.0f), Real(1.0f) - sqrt(rx * rx + ry * ry + rz * rz) * Real(inverse_support));
    return Real(alpha) * sph::wendland_shape(t);
  }
};

struct PackGrains {
  Domain domain;
  const Vec3<std::int32_t>* cluster_tile;
  const FixedPosition* position;
  const dem::GrainRecord* grain;
  const std::uint32_t* id;
  bool discs;
  float* record;
  Vec3f* velocity_before;
  const Vec3f* velocity;
  GDESP_HD void operator()(Index s) const {
    const Index c = s / exec::cluster_size;
    float* r = record + record_offset(c) + s % exec::cluster_size;
    const bool real_grain = id[s] != no_particle;
    const Vec3f x = real_grain ? domain.relative_to_tile(position[s], cluster_tile[c])
                               : Vec3f{padding_coordinate, padding_coordinate, padding_coordinate};
    const float R = real_grain ? grain[s].radius : 0.0f;
    r[0] = x.x;
    r[4] = x.y;
    r[8] = x.z;
    r[12] = discs ? 3.14159265f * R * R : 4.18879020f * R * R * R;
    r[16] = r[20] = r[24] = r[28] = 0.0f;
    velocity_before[s] = velocity[s];
  }
};

// eps_a = 1 - sum V_i W_ai.
struct FluidPorosity {
  CouplingKernel kernel;
  ClusterListView list;
  const float* fluid;
  const float* grains;
  float* solid;  // solid volume share by slot, 4 a cluster
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const float* ri = fluid + record_offset(c);
    const Real x = lanes.load_i(ri), y = lanes.load_i(ri + 4), z = lanes.load_i(ri + 8);
    Real share(0.0f);
    for_each_cluster(list, c, [&](Index j, const Vec3f& shift) {
      const float* rj = grains + record_offset(j);
      share += lanes.load_j(rj + 12) * kernel.W(x + Real(shift.x) - lanes.load_j(rj),
                                                y + Real(shift.y) - lanes.load_j(rj + 4),
                                                z + Real(shift.z) - lanes.load_j(rj + 8));
    });
    lanes.store_sum_i(solid + 4 * static_cast<std::int64_t>(c), share);
  }
};
struct SolidToPorosity {
  float* value;
  GDESP_HD void operator()(Index s) const { value[s] = real::max(1.0f - value[s], porosity_floor); }
};

// Sums over the fluid at a grain: S, eps, u, mass times acceleration.
struct GatherAtGrains {
  CouplingKernel kernel;
  float V0, m0;
  ClusterListView list;
  const float* grains;
  const float* fluid;
  const float* rate;
  const float* porosity;
  const float* mass_share;
  float* sums;
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const float* ri = grains + record_offset(c);
    const Real x = lanes.load_i(ri), y = lanes.load_i(ri + 4), z = lanes.load_i(ri + 8);
    Real S(0.0f), eps(0.0f), ux(0.0f), uy(0.0f), uz(0.0f), fx(0.0f), fy(0.0f), fz(0.0f);
    for_each_cluster(list, c, [&](Index j, const Vec3f& shift) {
      const float* rj = fluid + record_offset(j);
      const float* aj = rate + 16 * static_cast<std::int64_t>(j);
      const Real W = kernel.W(x + Real(shift.x) - lanes.load_j(rj), y + Real(shift.y) - lanes.load_j(rj + 4),
                              z + Real(shift.z) - lanes.load_j(rj + 8));
      const Real VW = Real(V0) * lanes.load_j(rj + 12) * W;
      const Real mW = Real(m0) * lanes.load_j(mass_share + 4 * static_cast<std::int64_t>(j)) * W;
      S += VW;
      eps += VW * lanes.load_j(porosity + 4 * static_cast<std::int64_t>(j));
      ux += VW * lanes.load_j(rj + 16);
      uy += VW * lanes.load_j(rj + 20);
      uz += VW * lanes.load_j(rj + 24);
      fx += mW * lanes.load_j(aj);
      fy += mW * lanes.load_j(aj + 4);
      fz += mW * lanes.load_j(aj + 8);
    });
    float* out = sums + record_offset(c);
    lanes.store_sum_i(out, S);
    lanes.store_sum_i(out + 4, eps);
    lanes.store_sum_i(out + 8, ux);
    lanes.store_sum_i(out + 12, uy);
    lanes.store_sum_i(out + 16, uz);
    lanes.store_sum_i(out + 20, fx);
    lanes.store_sum_i(out + 24, fy);
    lanes.store_sum_i(out + 28, fz);
  }
};

struct ForcesOnGrains {
  const dem::GrainRecord* grain;
  const std::uint32_t* id;
  const std::int32_t* group;
  float* record;
  const float* sums;
  const float* real_diameter;  // per group; null: their own
  Drag law;
  float density, viscosity, added_mass_factor, dt;
  Vec3f gravity;
  float* porosity;
  float* drag_coefficient;
  float* added_mass;
  Vec3f* fluid_velocity;
  Vec3f* other_force;

  GDESP_HD void operator()(Index s) const {
    const std::int64_t at = record_offset(s / exec::cluster_size) + s % exec::cluster_size;
    const float* q = sums + at;
    const float S = q[0];
    const float wet = immersion(S);
    record[at + 28] = S;
    drag_coefficient[s] = 0.0f;
    added_mass[s] = 0.0f;
    porosity[s] = 1.0f;
    fluid_velocity[s] = {};
    other_force[s] = {};
    if (id[s] == no_particle || wet <= 0.0f) return;
    const float inverse = 1.0f / S;
    const float eps = real::min(real::max(q[4] * inverse, porosity_floor), 1.0f);
    const Vec3f u{q[8] * inverse, q[12] * inverse, q[16] * inverse};
    const Vec3f body{q[20] * inverse, q[24] * inverse, q[28] * inverse};  // -grad P + div tau, N/m3
    const float V = record[at + 12];
    const float given = real_diameter ? real_diameter[group[s]] : 0.0f;
    const Vec3f v{grain[s].vx, grain[s].vy, grain[s].vz};
    const DragState state{eps, norm(u - v), given > 0.0f ? given : 2.0f * grain[s].radius, density, viscosity};
    const float K = law == Drag::ergun_wen_yu ? ergun_wen_yu_drag(state) : di_felice_drag(state);
    // Fluid that belongs to the grain.
    const float fluid_mass = density * V * eps / real::max(1.0f - eps, 1.0e-3f);
    // Faded out towards a packed bed: buoyancy and added mass together react with (1 - eps)(1 + C_m) of the water's own
    // pressure acceleration, which explicit coupling bears only below one.
    const float dilute = real::min(real::max((eps - 0.6f) / 0.3f, 0.0f), 1.0f);
    const float m_added = wet * dilute * added_mass_factor * density * V;
    porosity[s] = eps;
    fluid_velocity[s] = u;
    drag_coefficient[s] = implicit_drag(wet * K * V, grain[s].mass + m_added, fluid_mass, dt);
    added_mass[s] = m_added;
    // Buoyancy, and the added mass's share of the fluid's own acceleration.
    other_force[s] = body * (wet * V) + (body * (1.0f / density) + gravity) * m_added;
  }
};

// What each grain took, over S, into its record.
struct PackReaction {
  const std::uint32_t* id;
  const Vec3f* velocity;
  const Vec3f* velocity_before;
  const Vec3f* other_force;
  const float* added_mass;
  const Vec3d* drag_impulse;
  float inverse_dt;
  float* record;
  GDESP_HD void operator()(Index s) const {
    if (id[s] == no_particle) return;
    float* r = record + record_offset(s / exec::cluster_size) + s % exec::cluster_size;
    const float S = r[28];
    if (S <= shepard_dry) return;
    const Vec3f change = velocity[s] - velocity_before[s];
    const Vec3f F = other_force[s] + static_cast<Vec3f>(drag_impulse[s] * static_cast<double>(inverse_dt)) -
                    change * (added_mass[s] * inverse_dt);
    r[16] = F.x / S;
    r[20] = F.y / S;
    r[24] = F.z / S;
  }
};

struct ForceOfRecord {
  const float* record;
  GDESP_HD Vec3d operator()(Index s) const {
    const float* r = record + record_offset(s / exec::cluster_size) + s % exec::cluster_size;
    return Vec3d{static_cast<double>(r[16]), static_cast<double>(r[20]), static_cast<double>(r[24])} *
           static_cast<double>(r[28]);
  }
};
struct AddVectors {
  GDESP_HD Vec3d operator()(const Vec3d& a, const Vec3d& b) const { return a + b; }
};

struct ReactionOnFluid {
  CouplingKernel kernel;
  float inverse_density;  // V0 / m0
  ClusterListView list;
  const float* fluid;
  const float* grains;
  const float* mass_share;
  float* reaction;
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const float* ri = fluid + record_offset(c);
    const Real x = lanes.load_i(ri), y = lanes.load_i(ri + 4), z = lanes.load_i(ri + 8);
    Real fx(0.0f), fy(0.0f), fz(0.0f);
    for_each_cluster(list, c, [&](Index j, const Vec3f& shift) {
      const float* rj = grains + record_offset(j);
      const Real W = kernel.W(x + Real(shift.x) - lanes.load_j(rj), y + Real(shift.y) - lanes.load_j(rj + 4),
                              z + Real(shift.z) - lanes.load_j(rj + 8));
      fx -= W * lanes.load_j(rj + 16);
      fy -= W * lanes.load_j(rj + 20);
      fz -= W * lanes.load_j(rj + 24);
    });
    const Real scale = Real(inverse_density) * lanes.load_i(ri + 12) /
                       lanes.load_i(mass_share + 4 * static_cast<std::int64_t>(c));
    float* out = reaction + 12 * static_cast<std::int64_t>(c);
    lanes.store_sum_i(out, fx * scale);
    lanes.store_sum_i(out + 4, fy * scale);
    lanes.store_sum_i(out + 8, fz * scale);
  }
};
struct UnpackReaction {
  const float* reaction;
  Vec3f* external;
  GDESP_HD void operator()(Index s) const {
    const float* r = reaction + 12 * static_cast<std::int64_t>(s / exec::cluster_size) + s % exec::cluster_size;
    external[s] = {r[0], r[4], r[8]};
  }
};

CouplingKernel kernel_of(const CouplingLaw& law) {
  return {static_cast<float>(1.0 / (2.0 * law.smoothing_length)),
          static_cast<float>(sph::wendland_normalisation(law.smoothing_length, law.dimensions))};
}

}  // namespace

template <class Exec>
GrainFluidCoupling<Exec>::GrainFluidCoupling(const Exec& exec, const Domain& domain, const CouplingLaw& law)
    : exec_(exec), domain_(domain), law_(law), grain_fluid_(exec), fluid_grain_(exec), real_diameter_(exec),
      record_(exec), sums_(exec), velocity_before_(exec), porosity_(exec), drag_coefficient_(exec),
      added_mass_(exec), fluid_velocity_(exec), other_force_(exec), reaction_(exec) {
  real_diameter_.assign(law.real_diameter);
}

template <class Exec>
void GrainFluidCoupling<Exec>::rebuild(const dem::GrainSystem<Exec>& grains, const sph::FluidSystem<Exec>& fluid,
                                       double skin) {
  const auto n = static_cast<std::size_t>(grains.slots());
  grain_slots_ = grains.slots();
  fluid_slots_ = fluid.slots();
  record_.resize_discard(n * 8);
  sums_.resize_discard(n * 8);
  for (auto* array : {&porosity_, &drag_coefficient_, &added_mass_}) array->resize_discard(n);
  for (auto* array : {&velocity_before_, &fluid_velocity_, &other_force_}) array->resize_discard(n);
  reaction_.resize_discard(static_cast<std::size_t>(fluid.set().clusters()) * 12);
  place(grains);
  const auto cutoff = static_cast<float>(2.0 * law_.smoothing_length + skin);
  const CellGridView fluid_grid = fluid.set().view(), grain_grid = grains.set().view();
  grain_fluid_.build(grain_grid, record_.data(), fluid_grid, fluid.records(), cutoff);
  fluid_grain_.build(fluid_grid, fluid.records(), grain_grid, record_.data(), cutoff);
}

template <class Exec>
void GrainFluidCoupling<Exec>::place(const dem::GrainSystem<Exec>& grains) {
  exec::parallel_for(exec_, "coupling::place", grains.slots(),
                     PackGrains{domain_, grains.set().view().cluster_tile, grains.positions(), grains.records(),
                                grains.ids(), law_.dimensions == 2, record_.data(), velocity_before_.data(),
                                grains.velocities()});
}

template <class Exec>
void GrainFluidCoupling<Exec>::update_porosity(sph::FluidSystem<Exec>& fluid) {
  exec::pair_pass(exec_, "coupling::porosity", fluid.set().clusters(),
                  FluidPorosity{kernel_of(law_), fluid_grain_.view(), fluid.records(), record_.data(),
                                fluid.porosity()});
  exec::parallel_for(exec_, "coupling::porosity_finish", fluid.slots(), SolidToPorosity{fluid.porosity()});
}

template <class Exec>
void GrainFluidCoupling<Exec>::gather_forces(dem::GrainSystem<Exec>& grains, const sph::FluidSystem<Exec>& fluid,
                                             float dt) {
  const auto V0 = static_cast<float>(std::pow(law_.dp, law_.dimensions));
  exec::pair_pass(exec_, "coupling::gather", grains.set().clusters(),
                  GatherAtGrains{kernel_of(law_), V0, V0 * static_cast<float>(law_.fluid_density),
                                 grain_fluid_.view(), record_.data(), fluid.records(), fluid.rates(),
                                 fluid.porosity(), fluid.mass_share(), sums_.data()});
  exec::parallel_for(exec_, "coupling::forces", grains.slots(),
                     ForcesOnGrains{grains.records(), grains.ids(), grains.groups(), record_.data(), sums_.data(),
                                    real_diameter_.empty() ? nullptr : real_diameter_.data(), law_.drag,
                                    static_cast<float>(law_.fluid_density),
                                    static_cast<float>(law_.dynamic_viscosity), static_cast<float>(law_.added_mass),
                                    dt, static_cast<Vec3f>(law_.gravity), porosity_.data(),
                                    drag_coefficient_.data(), added_mass_.data(), fluid_velocity_.data(),
                                    other_force_.data()});
  grains.set_fluid(drag_coefficient_.data(), fluid_velocity_.data(), other_force_.data(), added_mass_.data());
  grains.clear_drag_impulse();
}

template <class Exec>
void GrainFluidCoupling<Exec>::react(const dem::GrainSystem<Exec>& grains, sph::FluidSystem<Exec>& fluid, float dt) {
  exec::parallel_for(exec_, "coupling::pack_reaction", grains.slots(),
                     PackReaction{grains.ids(), grains.velocities(), velocity_before_.data(), other_force_.data(),
                                  added_mass_.data(), grains.drag_impulse(), 1.0f / dt, record_.data()});
  exec::pair_pass(exec_, "coupling::reaction", fluid.set().clusters(),
                  ReactionOnFluid{kernel_of(law_), static_cast<float>(1.0 / law_.fluid_density), fluid_grain_.view(),
                                  fluid.records(), record_.data(), fluid.mass_share(), reaction_.data()});
  exec::parallel_for(exec_, "coupling::unpack", fluid.slots(),
                     UnpackReaction{reaction_.data(), fluid.external_acceleration()});
}

template <class Exec>
Vec3d GrainFluidCoupling<Exec>::reaction_of_grains() const {
  return exec::reduce(exec_, "coupling::balance", grain_slots_, Vec3d{}, ForceOfRecord{record_.data()}, AddVectors{});
}

template class GrainFluidCoupling<exec::CompiledBackend>;

}  // namespace gdesp::coupling
