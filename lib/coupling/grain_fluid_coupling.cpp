// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/grain_fluid_coupling.hpp"

#include "coupling/buoyancy.hpp"
#include "coupling/drag.hpp"
#include "sph/cavitation.hpp"
#include "sph/tait.hpp"
#include "sph/wendland_c2.hpp"

namespace gdesp::coupling {
namespace {

// Rows of a record of grains (four floats each), as the passes leave them.
enum GrainRow { row_x = 0, row_y = 4, row_z = 8, row_volume = 12, row_force = 16, row_offset = 28 };
// Rows of the water's own: volume (m3) and pressure (Pa).
constexpr Index water_rows = 8;
// Rows of the sums at grains.
constexpr Index sum_rows = 64;
enum SumRow { sum_water = 0, sum_walls = 4, sum_porosity = 8, sum_velocity = 12, sum_pressure = 24,
              sum_water_gradient = 28, sum_walls_gradient = 40, sum_pressure_gradient = 52 };

struct CouplingKernel {
  float inverse_support;  // 1/(2 h_c)
  float alpha;            // of W(h_c)
  float slope;            // 5 alpha/h_c^2
  template <class Real>
  GDESP_HD Real t(const Real& rx, const Real& ry, const Real& rz) const {
    using real::max;
    using real::sqrt;
    return max(Real(0.0f), Real(1.0f) - sqrt(rx * rx + ry * ry + rz * rz) * Real(inverse_support));
  }
  template <class Real>
  GDESP_HD Real W(const Real& rx, const Real& ry, const Real& rz) const {
    return Real(alpha) * sph::wendland_shape(t(rx, ry, rz));
  }
};

// The four grains or water particles of a cluster, and one of the other kind against them.
template <class Real>
struct Place { Real x, y, z; };
template <class Lanes>
GDESP_HD inline Place<typename Lanes::Real> place_i(const Lanes& lanes, const float* r) {
  return {lanes.load_i(r + row_x), lanes.load_i(r + row_y), lanes.load_i(r + row_z)};
}
template <class Lanes>
GDESP_HD inline Place<typename Lanes::Real> separation(const Lanes& lanes, const Place<typename Lanes::Real>& i,
                                                       const float* rj, const Vec3f& shift) {
  using Real = typename Lanes::Real;
  return {i.x + Real(shift.x) - lanes.load_j(rj + row_x), i.y + Real(shift.y) - lanes.load_j(rj + row_y),
          i.z + Real(shift.z) - lanes.load_j(rj + row_z)};
}

GDESP_HD inline float grain_volume(float R, bool discs) {
  return discs ? 3.14159265f * R * R : 4.18879020f * R * R * R;
}

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
  float ahead;  // s
  GDESP_HD void operator()(Index s) const {
    const Index c = s / exec::cluster_size;
    float* r = record + record_offset(c) + s % exec::cluster_size;
    const bool real_grain = id[s] != no_particle;
    const Vec3f x = real_grain ? domain.relative_to_tile(position[s], cluster_tile[c])
                               : Vec3f{padding_coordinate, padding_coordinate, padding_coordinate};
    const float R = real_grain ? grain[s].radius : 0.0f;
    const bool moves = real_grain && grain[s].mobility > 0.0f;
    const float dt = moves ? ahead : 0.0f;
    r[0] = x.x + grain[s].vx * dt;
    r[4] = x.y + grain[s].vy * dt;
    r[8] = x.z + grain[s].vz * dt;
    r[row_volume] = grain_volume(R, discs);
    r[16] = r[20] = r[24] = r[row_offset] = 0.0f;
    velocity_before[s] = velocity[s];
  }
};

// Volume and pressure of the water, whatever form its records have.
struct PackWater {
  const std::uint32_t* id;
  const float* density;
  const float* porosity;
  const float* mass_share;
  bool cavitates;
  float V0, stiffness;
  float* water;
  GDESP_HD void operator()(Index s) const {
    float* r = water + water_rows * static_cast<std::int64_t>(s / exec::cluster_size) + s % exec::cluster_size;
    const bool real_particle = id[s] != no_particle;
    const float ratio = 1.0f + density[s], eps = porosity[s];
    r[0] = real_particle ? V0 * mass_share[s] / sph::cavitated_density(ratio, eps, cavitates) : 0.0f;
    r[4] = real_particle ? stiffness * sph::cavitated_pressure(sph::tait_pressure(ratio / eps - 1.0f), cavitates) : 0.0f;
  }
};

// Room around a grain that is water, and that is wall.
struct RoomAtGrains {
  CouplingKernel kernel;
  float V0;
  ClusterListView water_list, wall_list;
  const float* grains;
  const float* fluid;
  const float* walls;
  const float* water;
  float* sums;
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const Place<Real> i = place_i(lanes, grains + record_offset(c));
    Real S(0.0f), wall(0.0f);
    for_each_cluster(water_list, c, [&](Index j, const Vec3f& shift) {
      const Place<Real> r = separation(lanes, i, fluid + record_offset(j), shift);
      S += lanes.load_j(water + water_rows * static_cast<std::int64_t>(j)) * kernel.W(r.x, r.y, r.z);
    });
    for_each_cluster(wall_list, c, [&](Index j, const Vec3f& shift) {
      const Place<Real> r = separation(lanes, i, walls + record_offset(j), shift);
      wall += kernel.W(r.x, r.y, r.z);
    });
    float* out = sums + sum_rows * static_cast<std::int64_t>(c);
    lanes.store_sum_i(out + sum_water, S);
    lanes.store_sum_i(out + sum_walls, wall * Real(V0));
  }
};

// V to V w/S.
struct Deposit {
  const float* sums;
  float* record;
  GDESP_HD void operator()(Index s) const {
    const std::int64_t c = s / exec::cluster_size, lane = s % exec::cluster_size;
    const float* q = sums + sum_rows * c + lane;
    float* r = record + record_offset(static_cast<Index>(c)) + lane;
    r[row_volume] = deposited_volume(r[row_volume], q[sum_water], q[sum_walls]);
  }
};

// sum V w/S W_ai, and the room that is wall.
struct FluidPorosity {
  CouplingKernel kernel;
  float V0;
  ClusterListView list, wall_list;
  const float* fluid;
  const float* grains;
  const float* walls;
  float* solid;  // two rows of 4 a cluster
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const Place<Real> i = place_i(lanes, fluid + record_offset(c));
    Real share(0.0f), wall(0.0f);
    for_each_cluster(list, c, [&](Index j, const Vec3f& shift) {
      const float* rj = grains + record_offset(j);
      const Place<Real> r = separation(lanes, i, rj, shift);
      share += lanes.load_j(rj + row_volume) * kernel.W(r.x, r.y, r.z);
    });
    for_each_cluster(wall_list, c, [&](Index j, const Vec3f& shift) {
      const Place<Real> r = separation(lanes, i, walls + record_offset(j), shift);
      wall += kernel.W(r.x, r.y, r.z);
    });
    float* out = solid + water_rows * static_cast<std::int64_t>(c);
    lanes.store_sum_i(out, share);
    lanes.store_sum_i(out + 4, wall * Real(V0));
  }
};
struct SolidToPorosity {
  const float* solid;
  float* value;
  GDESP_HD void operator()(Index s) const {
    const float* q = solid + water_rows * static_cast<std::int64_t>(s / exec::cluster_size) + s % exec::cluster_size;
    value[s] = real::max(1.0f - q[0] / open_share(q[4]), least_porosity);
  }
};

// Sums over water and walls at a grain.
struct GatherAtGrains {
  CouplingKernel kernel;
  float V0, stiffness;
  ClusterListView water_list, wall_list;
  const float* grains;
  const float* fluid;
  const float* walls;
  const float* water;
  const float* porosity;
  float* sums;

  template <class Real>
  struct Sums {
    Real water{0.0f}, walls{0.0f}, porosity{0.0f}, pressure{0.0f};
    Real velocity[3] = {Real(0.0f), Real(0.0f), Real(0.0f)}, water_gradient[3] = {Real(0.0f), Real(0.0f), Real(0.0f)};
    Real walls_gradient[3] = {Real(0.0f), Real(0.0f), Real(0.0f)}, pressure_gradient[3] = {Real(0.0f), Real(0.0f), Real(0.0f)};
  };
  template <class Lanes>
  GDESP_HD void add_water(const Lanes& lanes, const Place<typename Lanes::Real>& i, Index j, const Vec3f& shift,
                          Sums<typename Lanes::Real>& q) const {
    using Real = typename Lanes::Real;
    const float* rj = fluid + record_offset(j);
    const float* wj = water + water_rows * static_cast<std::int64_t>(j);
    const Place<Real> r = separation(lanes, i, rj, shift);
    const Real t = kernel.t(r.x, r.y, r.z), V = lanes.load_j(wj), P = lanes.load_j(wj + 4);
    const Real VW = V * Real(kernel.alpha) * sph::wendland_shape(t);
    const Real VG = V * Real(kernel.slope) * sph::wendland_slope_shape(t);
    q.water += VW;
    q.porosity += VW * lanes.load_j(porosity + 4 * static_cast<std::int64_t>(j));
    q.pressure += VW * P;
    const Real d[3] = {VG * r.x, VG * r.y, VG * r.z};
    for (int k = 0; k < 3; ++k) {
      q.velocity[k] += VW * lanes.load_j(rj + 16 + 4 * k);
      q.water_gradient[k] -= d[k];
      q.pressure_gradient[k] -= d[k] * P;
    }
  }
  template <class Lanes>
  GDESP_HD void add_wall(const Lanes& lanes, const Place<typename Lanes::Real>& i, Index j, const Vec3f& shift,
                         Sums<typename Lanes::Real>& q) const {
    using Real = typename Lanes::Real;
    const float* rj = walls + record_offset(j);
    const Place<Real> r = separation(lanes, i, rj, shift);
    const Real t = kernel.t(r.x, r.y, r.z), P = Real(stiffness) * lanes.load_j(rj + 28);
    const Real VW = Real(V0 * kernel.alpha) * sph::wendland_shape(t);
    const Real VG = Real(V0 * kernel.slope) * sph::wendland_slope_shape(t);
    q.walls += VW;
    q.pressure += VW * P;
    const Real d[3] = {VG * r.x, VG * r.y, VG * r.z};
    for (int k = 0; k < 3; ++k) {
      q.walls_gradient[k] -= d[k];
      q.pressure_gradient[k] -= d[k] * P;
    }
  }
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const Place<Real> i = place_i(lanes, grains + record_offset(c));
    Sums<Real> q;
    for_each_cluster(water_list, c, [&](Index j, const Vec3f& shift) { add_water(lanes, i, j, shift, q); });
    for_each_cluster(wall_list, c, [&](Index j, const Vec3f& shift) { add_wall(lanes, i, j, shift, q); });
    float* out = sums + sum_rows * static_cast<std::int64_t>(c);
    lanes.store_sum_i(out + sum_water, q.water);
    lanes.store_sum_i(out + sum_walls, q.walls);
    lanes.store_sum_i(out + sum_porosity, q.porosity);
    lanes.store_sum_i(out + sum_pressure, q.pressure);
    for (int k = 0; k < 3; ++k) {
      lanes.store_sum_i(out + sum_velocity + 4 * k, q.velocity[k]);
      lanes.store_sum_i(out + sum_water_gradient + 4 * k, q.water_gradient[k]);
      lanes.store_sum_i(out + sum_walls_gradient + 4 * k, q.walls_gradient[k]);
      lanes.store_sum_i(out + sum_pressure_gradient + 4 * k, q.pressure_gradient[k]);
    }
  }
};

GDESP_HD inline Vec3f vector_at(const float* q) { return {q[0], q[4], q[8]}; }

struct ForcesOnGrains {
  const dem::GrainRecord* grain;
  const std::uint32_t* id;
  const std::int32_t* group;
  float* record;
  const float* sums;
  const float* real_diameter;  // per group; null: their own
  Drag law;
  bool discs;
  float density, viscosity, added_mass_factor, dt;
  Vec3f gravity;
  float* porosity;
  float* drag_coefficient;
  float* added_mass;
  Vec3f* fluid_velocity;
  Vec3f* other_force;
  Vec3f* inertia_force;

  GDESP_HD void operator()(Index s) const {
    const std::int64_t c = s / exec::cluster_size, lane = s % exec::cluster_size;
    const float* q = sums + sum_rows * c + lane;
    float* r = record + record_offset(static_cast<Index>(c)) + lane;
    r[row_volume] = r[row_offset] = 0.0f;
    drag_coefficient[s] = 0.0f;
    added_mass[s] = 0.0f;
    porosity[s] = 1.0f;
    fluid_velocity[s] = other_force[s] = inertia_force[s] = {};
    const float S = q[sum_water], share = share_in_water(S, q[sum_walls]), wet = immersion(share);
    if (id[s] == no_particle || wet <= 0.0f) return;
    const float inverse = 1.0f / S;
    const float eps = real::min(real::max(q[sum_porosity] * inverse, porosity_floor), 1.0f);
    const Vec3f u = vector_at(q + sum_velocity) * inverse;
    const float R = grain[s].radius, V = grain_volume(R, discs);
    const Buoyancy push = buoyancy(V, {S, q[sum_walls], q[sum_pressure], vector_at(q + sum_water_gradient),
                                       vector_at(q + sum_walls_gradient), vector_at(q + sum_pressure_gradient)});
    const float given = real_diameter ? real_diameter[group[s]] : 0.0f;
    const Vec3f v{grain[s].vx, grain[s].vy, grain[s].vz};
    const DragState state{eps, norm(u - v), given > 0.0f ? given : 2.0f * R, density, viscosity};
    const float K = law == Drag::ergun_wen_yu ? ergun_wen_yu_drag(state) : di_felice_drag(state);
    // Fluid that belongs to the grain: less of it where the room around is only partly wet.
    const float fluid_mass = density * V * eps * real::min(share, 1.0f) / real::max(1.0f - eps, 1.0e-3f);
    // Faded out towards a packed bed: buoyancy and added mass together react with (1 - eps)(1 + C_m) of the water's own
    // pressure acceleration, which explicit coupling bears only below one.
    const float dilute = real::min(real::max((eps - 0.6f) / 0.3f, 0.0f), 1.0f);
    const float m_added = wet * dilute * added_mass_factor * density * V;
    r[row_volume] = push.slope;
    r[row_offset] = push.offset;
    porosity[s] = eps;
    fluid_velocity[s] = u;
    drag_coefficient[s] = implicit_drag(wet * K * V, grain[s].mass + m_added, fluid_mass, dt);
    added_mass[s] = m_added;
    // The added mass's share of the fluid's own acceleration.
    inertia_force[s] = (push.gradient * (-1.0f / density) + gravity) * m_added;
    other_force[s] = push.force + inertia_force[s];
  }
};

// What each grain took besides pressure, over S, into its record.
struct PackReaction {
  const std::uint32_t* id;
  const Vec3f* velocity;
  const Vec3f* velocity_before;
  const Vec3f* inertia_force;
  const float* added_mass;
  const Vec3d* drag_impulse;
  const float* sums;
  float inverse_dt;
  float* record;
  GDESP_HD void operator()(Index s) const {
    const std::int64_t c = s / exec::cluster_size, lane = s % exec::cluster_size;
    float* r = record + record_offset(static_cast<Index>(c)) + lane;
    if (id[s] == no_particle || r[row_volume] <= 0.0f) return;   // dry
    const float S = sums[sum_rows * c + lane + sum_water];
    const Vec3f change = velocity[s] - velocity_before[s];
    const Vec3f F = inertia_force[s] + static_cast<Vec3f>(drag_impulse[s] * static_cast<double>(inverse_dt)) -
                    change * (added_mass[s] * inverse_dt);
    r[row_force] = F.x / S;
    r[row_force + 4] = F.y / S;
    r[row_force + 8] = F.z / S;
  }
};

struct ReactionOnFluid {
  CouplingKernel kernel;
  float inverse_mass;  // 1 / (rho0 V0)
  ClusterListView list;
  const float* fluid;
  const float* grains;
  const float* water;
  const float* mass_share;
  float* reaction;
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const Place<Real> i = place_i(lanes, fluid + record_offset(c));
    const float* w = water + water_rows * static_cast<std::int64_t>(c);
    const Real P = lanes.load_i(w + 4);
    Real fx(0.0f), fy(0.0f), fz(0.0f);
    for_each_cluster(list, c, [&](Index j, const Vec3f& shift) {
      const float* rj = grains + record_offset(j);
      const Place<Real> r = separation(lanes, i, rj, shift);
      const Real t = kernel.t(r.x, r.y, r.z), W = Real(kernel.alpha) * sph::wendland_shape(t);
      const Real push = (lanes.load_j(rj + row_volume) * P + lanes.load_j(rj + row_offset)) * Real(kernel.slope) *
                        sph::wendland_slope_shape(t);
      fx += push * r.x - W * lanes.load_j(rj + row_force);
      fy += push * r.y - W * lanes.load_j(rj + row_force + 4);
      fz += push * r.z - W * lanes.load_j(rj + row_force + 8);
    });
    const Real scale = Real(inverse_mass) * lanes.load_i(w) /
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
  const double h = law.smoothing_length, alpha = sph::wendland_normalisation(h, law.dimensions);
  return {static_cast<float>(1.0 / (2.0 * h)), static_cast<float>(alpha), static_cast<float>(5.0 * alpha / (h * h))};
}

}  // namespace

template <class Exec>
GrainFluidCoupling<Exec>::GrainFluidCoupling(const Exec& exec, const Domain& domain, const CouplingLaw& law)
    : exec_(exec), domain_(domain), law_(law), grain_fluid_(exec), fluid_grain_(exec), grain_wall_(exec),
      fluid_wall_(exec), real_diameter_(exec), record_(exec), sums_(exec), water_(exec), solid_(exec),
      velocity_before_(exec), porosity_(exec), drag_coefficient_(exec), added_mass_(exec), fluid_velocity_(exec),
      other_force_(exec), inertia_force_(exec), reaction_(exec) {
  real_diameter_.assign(law.real_diameter);
}

template <class Exec>
float GrainFluidCoupling<Exec>::lattice_volume() const {
  return static_cast<float>(std::pow(law_.dp, law_.dimensions));
}

template <class Exec>
void GrainFluidCoupling<Exec>::rebuild(const dem::GrainSystem<Exec>& grains, const sph::FluidSystem<Exec>& fluid,
                                       double skin) {
  const auto n = static_cast<std::size_t>(grains.slots());
  const auto water_clusters = static_cast<std::size_t>(fluid.set().clusters());
  grain_slots_ = grains.slots();
  fluid_slots_ = fluid.slots();
  record_.resize_discard(n * 8);
  sums_.resize_discard(n * 16);
  for (auto* array : {&porosity_, &drag_coefficient_, &added_mass_}) array->resize_discard(n);
  for (auto* array : {&velocity_before_, &fluid_velocity_, &other_force_, &inertia_force_}) array->resize_discard(n);
  reaction_.resize_discard(water_clusters * 12);
  water_.resize_discard(water_clusters * water_rows);
  solid_.resize_discard(water_clusters * water_rows);
  place(grains, 0.0);
  const auto cutoff = static_cast<float>(2.0 * law_.smoothing_length + skin);
  const CellGridView fluid_grid = fluid.set().view(), grain_grid = grains.set().view(), wall_grid = fluid.wall_set().view();
  grain_fluid_.build(grain_grid, record_.data(), fluid_grid, fluid.records(), cutoff);
  fluid_grain_.build(fluid_grid, fluid.records(), grain_grid, record_.data(), cutoff);
  grain_wall_.build(grain_grid, record_.data(), wall_grid, fluid.wall_records(), cutoff);
  fluid_wall_.build(fluid_grid, fluid.records(), wall_grid, fluid.wall_records(), cutoff);
}

template <class Exec>
void GrainFluidCoupling<Exec>::place(const dem::GrainSystem<Exec>& grains, double ahead) {
  exec::parallel_for(exec_, "coupling::place", grains.slots(),
                     PackGrains{domain_, grains.set().view().cluster_tile, grains.positions(), grains.records(),
                                grains.ids(), law_.dimensions == 2, record_.data(), velocity_before_.data(),
                                grains.velocities(), static_cast<float>(ahead)});
}

template <class Exec>
void GrainFluidCoupling<Exec>::pack_water(const sph::FluidSystem<Exec>& fluid) {
  const double c = fluid.parameters().sound_speed;
  exec::parallel_for(exec_, "coupling::pack_water", fluid.slots(),
                     PackWater{fluid.ids(), fluid.densities(), fluid.porosity(), fluid.mass_share(),
                               fluid.parameters().cavitates, lattice_volume(),
                               static_cast<float>(law_.fluid_density * c * c), water_.data()});
}

template <class Exec>
void GrainFluidCoupling<Exec>::update_porosity(sph::FluidSystem<Exec>& fluid, Index grain_clusters) {
  pack_water(fluid);
  exec::pair_pass(exec_, "coupling::room", grain_clusters,
                  RoomAtGrains{kernel_of(law_), lattice_volume(), grain_fluid_.view(), grain_wall_.view(),
                               record_.data(), fluid.records(), fluid.wall_records(), water_.data(), sums_.data()});
  exec::parallel_for(exec_, "coupling::deposit", grain_slots_, Deposit{sums_.data(), record_.data()});
  exec::pair_pass(exec_, "coupling::porosity", fluid.set().clusters(),
                  FluidPorosity{kernel_of(law_), lattice_volume(), fluid_grain_.view(), fluid_wall_.view(),
                                fluid.records(), record_.data(), fluid.wall_records(), solid_.data()});
  exec::parallel_for(exec_, "coupling::porosity_finish", fluid.slots(),
                     SolidToPorosity{solid_.data(), fluid.porosity()});
}

template <class Exec>
void GrainFluidCoupling<Exec>::gather_forces(dem::GrainSystem<Exec>& grains, const sph::FluidSystem<Exec>& fluid,
                                             float dt) {
  const double c = fluid.parameters().sound_speed;
  pack_water(fluid);
  exec::pair_pass(exec_, "coupling::gather", grains.set().clusters(),
                  GatherAtGrains{kernel_of(law_), lattice_volume(), static_cast<float>(law_.fluid_density * c * c),
                                 grain_fluid_.view(), grain_wall_.view(), record_.data(), fluid.records(),
                                 fluid.wall_records(), water_.data(), fluid.porosity(), sums_.data()});
  exec::parallel_for(exec_, "coupling::forces", grains.slots(),
                     ForcesOnGrains{grains.records(), grains.ids(), grains.groups(), record_.data(), sums_.data(),
                                    real_diameter_.empty() ? nullptr : real_diameter_.data(), law_.drag,
                                    law_.dimensions == 2, static_cast<float>(law_.fluid_density),
                                    static_cast<float>(law_.dynamic_viscosity), static_cast<float>(law_.added_mass),
                                    dt, static_cast<Vec3f>(law_.gravity), porosity_.data(),
                                    drag_coefficient_.data(), added_mass_.data(), fluid_velocity_.data(),
                                    other_force_.data(), inertia_force_.data()});
  grains.set_fluid(drag_coefficient_.data(), fluid_velocity_.data(), other_force_.data(), added_mass_.data());
  grains.clear_drag_impulse();
}

template <class Exec>
void GrainFluidCoupling<Exec>::react(const dem::GrainSystem<Exec>& grains, sph::FluidSystem<Exec>& fluid, float dt) {
  exec::parallel_for(exec_, "coupling::pack_reaction", grains.slots(),
                     PackReaction{grains.ids(), grains.velocities(), velocity_before_.data(), inertia_force_.data(),
                                  added_mass_.data(), grains.drag_impulse(), sums_.data(), 1.0f / dt,
                                  record_.data()});
  exec::pair_pass(exec_, "coupling::reaction", fluid.set().clusters(),
                  ReactionOnFluid{kernel_of(law_), static_cast<float>(1.0 / law_.fluid_density) / lattice_volume(),
                                  fluid_grain_.view(), fluid.records(), record_.data(), water_.data(),
                                  fluid.mass_share(), reaction_.data()});
  exec::parallel_for(exec_, "coupling::unpack", fluid.slots(),
                     UnpackReaction{reaction_.data(), fluid.external_acceleration()});
}

template class GrainFluidCoupling<exec::CompiledBackend>;

}  // namespace gdesp::coupling
