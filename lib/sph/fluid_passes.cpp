// SPDX-License-Identifier: GPL-3.0-or-later
// The pair passes of the fluid: momentum, continuity, both at once, and the extrapolation of wall pressure.
#include "sph/fluid_system.hpp"
#include "sph/pressure_and_viscosity.hpp"
#include "sph/tait.hpp"
#include "sph/wall_extrapolation.hpp"
#include "sph/wall_guard.hpp"
#include "sph/wall_volume.hpp"

namespace gdesp::sph {
namespace {

// Rows of a record (four floats each) and of a rate.
enum RecordRow { row_x = 0, row_y = 4, row_z = 8, row_B = 12, row_vx = 16, row_vy = 20, row_vz = 24, row_A = 28 };

template <bool WithMomentum, bool WithContinuity, Viscosity Kind>
struct FluidPass {
  FluidPairLaw law;
  float c2;         // m2/s2
  float diffusion;  // 2 delta h c, m2/s
  ClusterListView fluid_list, wall_list;
  const float* fluid;
  const float* walls;
  const float* wall_friction;
  const float* mass_share;    // null: 1
  const float* porosity;      // null: 1
  const float* own_pressure;  // null: A of the record
  const float* wall_ghost;    // null: no no-slip walls
  const float* wall_volume;   // null: none is handed back (`dynamic` walls)
  float* rate;
  bool trims;
  ClusterTrim fluid_trim, wall_trim;

  template <class Real>
  struct Particle {
    Real x, y, z, vx, vy, vz, A;
  };

  template <bool Wall, class Lanes>
  GDESP_HD void add_cluster(const Lanes& lanes, const Particle<typename Lanes::Real>& i, const float* rj,
                            const float* vj, const typename Lanes::Real& friction, const Vec3f& shift,
                            FluidRates<typename Lanes::Real>& rates) const {
    using Real = typename Lanes::Real;
    Real A_j = lanes.load_j(rj + row_A);
    if constexpr (Wall) A_j = pressing_wall(A_j, i.A);
    add_fluid_pair<WithMomentum, WithContinuity, Kind, !Wall>(
        law, i.x + Real(shift.x) - lanes.load_j(rj + row_x), i.y + Real(shift.y) - lanes.load_j(rj + row_y),
        i.z + Real(shift.z) - lanes.load_j(rj + row_z), i.vx - lanes.load_j(vj), i.vy - lanes.load_j(vj + 4),
        i.vz - lanes.load_j(vj + 8), i.A, A_j, lanes.load_j(rj + row_B), friction, rates);
  }

  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    if (WithMomentum && trims) {
      fluid_trim(c, lanes);
      wall_trim(c, lanes);
    }
    const float* ri = fluid + record_offset(c);
    const Particle<Real> i{lanes.load_i(ri + row_x),
                           lanes.load_i(ri + row_y),
                           lanes.load_i(ri + row_z),
                           lanes.load_i(ri + row_vx),
                           lanes.load_i(ri + row_vy),
                           lanes.load_i(ri + row_vz),
                           lanes.load_i(own_pressure ? own_pressure + 4 * static_cast<std::int64_t>(c) : ri + row_A)};
    FluidRates<Real> rates;
    for_each_cluster(fluid_list, c, [&](Index j, const Vec3f& shift) {
      const float* rj = fluid + record_offset(j);
      add_cluster<false>(lanes, i, rj, rj + row_vx, Real(1.0f), shift, rates);
    });
    Real of_walls(0.0f);
    for_each_cluster(wall_list, c, [&](Index j, const Vec3f& shift) {
      const float* rj = walls + record_offset(j);
      const float* vj = wall_ghost ? wall_ghost + 16 * static_cast<std::int64_t>(j) : rj + row_vx;
      add_cluster<true>(lanes, i, rj, vj, lanes.load_j(wall_friction + 4 * static_cast<std::int64_t>(j)), shift, rates);
      if (WithContinuity && wall_volume) {
        const Real w =
            wendland_at(law.inverse_support, i.x + Real(shift.x) - lanes.load_j(rj + row_x),
                        i.y + Real(shift.y) - lanes.load_j(rj + row_y), i.z + Real(shift.z) - lanes.load_j(rj + row_z));
        of_walls += w * lanes.load_j(wall_volume + 4 * static_cast<std::int64_t>(j));
      }
    });
    float* out = rate + 16 * static_cast<std::int64_t>(c);
    // V_i / (m_i / rho0), that is rho0 / rho_i (and 1 in the form of the paper).
    Real specific_volume = lanes.load_i(ri + row_B);
    if (mass_share) specific_volume = specific_volume / lanes.load_i(mass_share + 4 * static_cast<std::int64_t>(c));
    if constexpr (WithMomentum) {
      const Real scale = Real(c2) * specific_volume;
      lanes.store_sum_i(out, rates.ax * scale);
      lanes.store_sum_i(out + 4, rates.ay * scale);
      lanes.store_sum_i(out + 8, rates.az * scale);
    }
    if constexpr (WithContinuity) {
      // Diffusion acts on the true density, the rate is that of the superficial one.
      Real diffused = Real(diffusion) * rates.diffusion;
      if (porosity) diffused = diffused * lanes.load_i(porosity + 4 * static_cast<std::int64_t>(c));
      const Real compression = rates.compression + of_walls / lanes.load_i(ri + row_B);
      lanes.store_sum_i(out + 12, compression / specific_volume + diffused);
    }
  }
};

// sum V0 W over water and over walls, two rows of 4 a cluster.
struct LatticeShare {
  float inverse_support, scale;
  ClusterListView fluid_list, wall_list;
  const float* fluid;
  const float* walls;
  float* share;
  template <class Lanes>
  GDESP_HD typename Lanes::Real sum(const ClusterListView& list, Index c, const float* others,
                                    const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const float* ri = fluid + record_offset(c);
    const Real x = lanes.load_i(ri + row_x), y = lanes.load_i(ri + row_y), z = lanes.load_i(ri + row_z);
    Real total(0.0f);
    for_each_cluster(list, c, [&](Index j, const Vec3f& shift) {
      const float* rj = others + record_offset(j);
      total += wendland_at(inverse_support, x + Real(shift.x) - lanes.load_j(rj + row_x),
                           y + Real(shift.y) - lanes.load_j(rj + row_y), z + Real(shift.z) - lanes.load_j(rj + row_z));
    });
    return total * Real(scale);
  }
  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    lanes.store_sum_i(share + 8 * static_cast<std::int64_t>(c), sum(fluid_list, c, fluid, lanes));
    lanes.store_sum_i(share + 8 * static_cast<std::int64_t>(c) + 4, sum(wall_list, c, walls, lanes));
  }
};

template <bool NoSlip>
struct ExtrapolateWalls {
  FluidPairLaw law;
  ClusterListView list;
  const float* fluid;
  float* walls;
  float* ghost;          // no-slip walls only
  const float* surface;  // nx ny nz depth, 4 each, per cluster; null: unknown

  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    float* ri = walls + record_offset(c);
    const Real x = lanes.load_i(ri + row_x), y = lanes.load_i(ri + row_y), z = lanes.load_i(ri + row_z);
    WallSums<Real> sums;
    bool any = false;
    for_each_cluster(list, c, [&](Index j, const Vec3f& shift) {
      const float* rj = fluid + record_offset(j);
      const Real w = add_wall_pair(law.inverse_support, x + Real(shift.x) - lanes.load_j(rj + row_x),
                                   y + Real(shift.y) - lanes.load_j(rj + row_y),
                                   z + Real(shift.z) - lanes.load_j(rj + row_z), lanes.load_j(rj + row_A), sums);
      if constexpr (NoSlip) {
        sums.vx += w * lanes.load_j(rj + row_vx);
        sums.vy += w * lanes.load_j(rj + row_vy);
        sums.vz += w * lanes.load_j(rj + row_vz);
      }
      any = true;
    });
    if (!any) return;
    lanes.store_sum_i(ri + row_B, sums.weight);
    lanes.store_sum_i(ri + row_A,
                      sums.pressure + Real(law.gx) * sums.rx + Real(law.gy) * sums.ry + Real(law.gz) * sums.rz);
    if constexpr (NoSlip) {
      float* out = ghost + 16 * static_cast<std::int64_t>(c);
      lanes.store_sum_i(out, sums.vx);
      lanes.store_sum_i(out + 4, sums.vy);
      lanes.store_sum_i(out + 8, sums.vz);
      if (!surface) return;
      const float* n = surface + 16 * static_cast<std::int64_t>(c);
      lanes.store_sum_i(out + 12, Real(0.0f) - lanes.load_i(n) * sums.rx - lanes.load_i(n + 4) * sums.ry -
                                      lanes.load_i(n + 8) * sums.rz);
    }
  }
};

// Second half of the extrapolation: quotient, clip, density.
struct FinishWalls {
  const std::uint32_t* count;
  const float* friction;
  float* walls;
  float* ghost;          // null: no no-slip walls
  const float* surface;  // as above
  GDESP_HD void operator()(Index slot) const {
    const Index c = slot / exec::cluster_size;
    float* r = walls + record_offset(c) + slot % exec::cluster_size;
    if (count[c] == 0) {  // no water near: no pressure left over from earlier
      r[row_A] = 0.0f;
      r[row_B] = 1.0f;
      return;
    }
    const float weight = r[row_B];
    if (ghost) mirror(16 * static_cast<std::int64_t>(c) + slot % exec::cluster_size, r, weight, friction[slot]);
    const float A = weight > 1.0e-6f ? r[row_A] / weight : 0.0f;
    r[row_A] = A;
    r[row_B] = 1.0f / (1.0f + tait_density(real::max(A, 0.0f)));
  }
  GDESP_HD void mirror(std::int64_t at, const float* r, float weight, float has_friction) const {
    const bool slides = !(weight > 1.0e-6f && has_friction > 0.0f);
    const float share = slides || !surface ? 1.0f : no_slip_share(surface[at + 12], ghost[at + 12] / weight);
    for (int row = 0; row < 12; row += 4) {
      const float wall = r[row_vx + row];
      ghost[at + row] = slides ? wall : wall + share * (wall - ghost[at + row] / weight);
    }
  }
};

// What walls hand back to the water around them (sph.wall.volume).
struct MeasureWallVolume {
  FluidPairLaw law;
  ClusterListView list;
  const float* fluid;
  const float* walls;
  const float* porosity;  // of the water; null: 1
  const float* surface;   // nx ny nz depth, 4 each, per cluster; null: unknown
  float* volume;

  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const float* ri = walls + record_offset(c);
    const Real x = lanes.load_i(ri + row_x), y = lanes.load_i(ri + row_y), z = lanes.load_i(ri + row_z);
    const Real vx = lanes.load_i(ri + row_vx), vy = lanes.load_i(ri + row_vy), vz = lanes.load_i(ri + row_vz);
    WallVolumeSums<Real> sums;
    for_each_cluster(list, c, [&](Index j, const Vec3f& shift) {
      const float* rj = fluid + record_offset(j);
      const Real r[3] = {x + Real(shift.x) - lanes.load_j(rj + row_x), y + Real(shift.y) - lanes.load_j(rj + row_y),
                         z + Real(shift.z) - lanes.load_j(rj + row_z)};
      const Real v[3] = {vx - lanes.load_j(rj + row_vx), vy - lanes.load_j(rj + row_vy),
                         vz - lanes.load_j(rj + row_vz)};
      const Real eps = porosity ? lanes.load_j(porosity + 4 * static_cast<std::int64_t>(j)) : Real(1.0f);
      add_wall_volume(law, r, v, lanes.load_j(rj + row_B), eps, sums);
    });
    const WallVolumeSums<Real> all{lanes.sum_i(sums.weight), lanes.sum_i(sums.compression), lanes.sum_i(sums.vx),
                                   lanes.sum_i(sums.vy),     lanes.sum_i(sums.vz),          lanes.sum_i(sums.gx),
                                   lanes.sum_i(sums.gy),     lanes.sum_i(sums.gz)};
    const float* sn = surface + 16 * static_cast<std::int64_t>(c);
    const Real none(0.0f);
    const Real n[3] = {surface ? lanes.load_i(sn) : none, surface ? lanes.load_i(sn + 4) : none,
                       surface ? lanes.load_i(sn + 8) : none};
    lanes.store_max_i(volume + 4 * static_cast<std::int64_t>(c), wall_volume(all, n, lanes.load_i(ri + row_B)));
  }
};

// How evenly particles lie, for shifting and tensile control.
struct FindSpacing {
  FluidPairLaw law;
  ClusterListView fluid_list, wall_list;
  const float* fluid;
  const float* walls;
  float* spacing;

  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const float* ri = fluid + record_offset(c);
    const Real x = lanes.load_i(ri + row_x), y = lanes.load_i(ri + row_y), z = lanes.load_i(ri + row_z);
    SpacingSums<Real> sums;
    const auto add = [&](const float* rj, const Vec3f& shift) {
      const Real r[3] = {x + Real(shift.x) - lanes.load_j(rj + row_x), y + Real(shift.y) - lanes.load_j(rj + row_y),
                         z + Real(shift.z) - lanes.load_j(rj + row_z)};
      add_spacing_pair(law.inverse_support, law.slope, r, lanes.load_j(rj + row_B), sums);
    };
    for_each_cluster(fluid_list, c, [&](Index j, const Vec3f& shift) { add(fluid + record_offset(j), shift); });
    for_each_cluster(wall_list, c, [&](Index j, const Vec3f& shift) { add(walls + record_offset(j), shift); });
    float* out = spacing + 16 * static_cast<std::int64_t>(c);
    lanes.store_sum_i(out, sums.x);
    lanes.store_sum_i(out + 4, sums.y);
    lanes.store_sum_i(out + 8, sums.z);
    lanes.store_sum_i(out + 12, sums.divergence);
  }
};

struct FindNearSurface {
  float inverse_support, least_divergence;
  ClusterListView list;
  const float* fluid;
  const float* spacing;
  float* near_surface;

  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using exec::max;
    using exec::select;
    using exec::sqrt;
    using Real = typename Lanes::Real;
    const float* ri = fluid + record_offset(c);
    const Real x = lanes.load_i(ri + row_x), y = lanes.load_i(ri + row_y), z = lanes.load_i(ri + row_z);
    Real nearest(0.0f);
    for_each_cluster(list, c, [&](Index j, const Vec3f& shift) {
      const float* rj = fluid + record_offset(j);
      const Real rx = x + Real(shift.x) - lanes.load_j(rj + row_x), ry = y + Real(shift.y) - lanes.load_j(rj + row_y),
                 rz = z + Real(shift.z) - lanes.load_j(rj + row_z);
      const Real t = Real(1.0f) - sqrt(rx * rx + ry * ry + rz * rz) * Real(inverse_support);
      const Real divergence = lanes.load_j(spacing + 16 * static_cast<std::int64_t>(j) + 12);
      nearest = max(nearest, select(divergence < Real(least_divergence), t, Real(0.0f)));
    });
    lanes.store_max_i(near_surface + 4 * static_cast<std::int64_t>(c), nearest);
  }
};

struct ControlTension {
  const float* record;
  const float* near_surface;
  float* own_pressure;
  GDESP_HD void operator()(Index s) const {
    own_pressure[s] = controlled_pressure(
        record[record_offset(s / exec::cluster_size) + row_A + s % exec::cluster_size], near_surface[s]);
  }
};

// Where the wall's surface is, for water near it.
struct FindWalls {
  float inverse_reach;
  ClusterListView list;
  const float* fluid;
  const float* walls;
  const float* surface;  // nx ny nz depth, 4 each, per cluster
  float* near_wall;      // six rows of 4 per cluster

  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const float* ri = fluid + record_offset(c);
    const Real x = lanes.load_i(ri + row_x), y = lanes.load_i(ri + row_y), z = lanes.load_i(ri + row_z);
    WallGuardSums<Real> sums;
    for_each_cluster(list, c, [&](Index j, const Vec3f& shift) {
      const float* rj = walls + record_offset(j);
      const float* sj = surface + 16 * static_cast<std::int64_t>(j);
      const Real r[3] = {x + Real(shift.x) - lanes.load_j(rj + row_x), y + Real(shift.y) - lanes.load_j(rj + row_y),
                         z + Real(shift.z) - lanes.load_j(rj + row_z)};
      const Real n[3] = {lanes.load_j(sj), lanes.load_j(sj + 4), lanes.load_j(sj + 8)};
      const Real v[3] = {lanes.load_j(rj + row_vx), lanes.load_j(rj + row_vy), lanes.load_j(rj + row_vz)};
      add_wall_guard(inverse_reach, r, n, lanes.load_j(sj + 12), v, sums);
    });
    float* out = near_wall + 24 * static_cast<std::int64_t>(c);
    lanes.store_sum_i(out, sums.weight);
    lanes.store_sum_i(out + 4, sums.distance);
    lanes.store_sum_i(out + 8, sums.nx);
    lanes.store_sum_i(out + 12, sums.ny);
    lanes.store_sum_i(out + 16, sums.nz);
    lanes.store_sum_i(out + 20, sums.wall_speed);
  }
};

// `dynamic` walls: continuity of wall particles against the fluid.
struct WallContinuity {
  FluidPairLaw law;
  ClusterListView list;
  const float* fluid;
  const float* walls;
  float* rate;

  template <class Lanes>
  GDESP_HD void operator()(Index c, const Lanes& lanes) const {
    using Real = typename Lanes::Real;
    const float* ri = walls + record_offset(c);
    const Real x = lanes.load_i(ri + row_x), y = lanes.load_i(ri + row_y), z = lanes.load_i(ri + row_z);
    const Real vx = lanes.load_i(ri + row_vx), vy = lanes.load_i(ri + row_vy), vz = lanes.load_i(ri + row_vz);
    const Real A = lanes.load_i(ri + row_A);
    FluidRates<Real> rates;
    for_each_cluster(list, c, [&](Index j, const Vec3f& shift) {
      const float* rj = fluid + record_offset(j);
      add_fluid_pair<false, true, Viscosity::none, false>(
          law, x + Real(shift.x) - lanes.load_j(rj + row_x), y + Real(shift.y) - lanes.load_j(rj + row_y),
          z + Real(shift.z) - lanes.load_j(rj + row_z), vx - lanes.load_j(rj + row_vx), vy - lanes.load_j(rj + row_vy),
          vz - lanes.load_j(rj + row_vz), A, lanes.load_j(rj + row_A), lanes.load_j(rj + row_B), Real(1.0f), rates);
    });
    lanes.store_sum_i(rate + 4 * static_cast<std::int64_t>(c), rates.compression / lanes.load_i(ri + row_B));
  }
};

}  // namespace

template <class Exec>
FluidPairLaw FluidSystem<Exec>::pair_law() const {
  const FluidParameters& p = parameters_;
  const double alpha = wendland_normalisation(p.h, p.dimensions);
  const double c = p.sound_speed;
  FluidPairLaw law{};
  law.inverse_support = static_cast<float>(1.0 / (2.0 * p.h));
  const double correction = p.paper_form ? 1.0 : 1.0 / lattice_gradient_moment(p.h / p.dp, p.dimensions);
  law.slope = static_cast<float>(correction * std::pow(p.dp, p.dimensions) * 5.0 * alpha / (p.h * p.h));
  law.artificial = static_cast<float>(p.artificial_viscosity * p.h / c);
  law.eta2 = static_cast<float>(0.01 * p.h * p.h);
  law.morris = static_cast<float>(2.0 * p.kinematic_viscosity / (c * c));
  law.gx = static_cast<float>(p.gravity.x / (c * c));
  law.gy = static_cast<float>(p.gravity.y / (c * c));
  law.gz = static_cast<float>(p.gravity.z / (c * c));
  return law;
}

template <class Exec>
template <bool M, bool C, Viscosity K>
void FluidSystem<Exec>::run_fluid_pass_kind(const char* name) {
  const FluidParameters& p = parameters_;
  const auto cutoff = static_cast<float>(2.0 * p.h + trim_skin_);
  const bool volume = C && p.extrapolated_walls && wall_set_.clusters() > 0;
  if (volume) {
    exec::pair_pass(exec_, "sph::wall_volume", near_walls_.count(),
                    chosen_clusters(near_walls_.list(),
                                    MeasureWallVolume{pair_law(), wall_fluid_.view(), record_.data(),
                                                      wall_record_.data(), porous_ ? porosity_.data() : nullptr,
                                                      guarded_ ? wall_surface_.data() : nullptr, wall_rate_.data()}));
  }
  const bool trims = M && trims_next_;
  if (trims) trims_next_ = false;
  exec::pair_pass(
      exec_, name, awake_clusters(),
      chosen_clusters(
          awake_list(),
          FluidPass<M, C, K>{pair_law(), static_cast<float>(p.sound_speed * p.sound_speed),
                             static_cast<float>(2.0 * p.density_diffusion * p.h * p.sound_speed), fluid_fluid_.view(),
                             fluid_wall_.view(), record_.data(), wall_record_.data(), wall_friction_.data(),
                             mass_share_.data(), porous_ ? porosity_.data() : nullptr,
                             M && !C && p.tensile_control ? own_pressure_.data() : nullptr,
                             M && !C && no_slip_ ? wall_ghost_.data() : nullptr, volume ? wall_rate_.data() : nullptr,
                             rate_.data(), trims, fluid_fluid_.trim(record_.data(), record_.data(), cutoff),
                             fluid_wall_.trim(record_.data(), wall_record_.data(), cutoff)}));
}

template <class Exec>
template <bool M, bool C>
void FluidSystem<Exec>::run_fluid_pass(const char* name) {
  if constexpr (M) {
    if (parameters_.viscosity == Viscosity::morris) return run_fluid_pass_kind<M, C, Viscosity::morris>(name);
    if (parameters_.viscosity == Viscosity::artificial) return run_fluid_pass_kind<M, C, Viscosity::artificial>(name);
  }
  run_fluid_pass_kind<M, C, Viscosity::none>(name);
}

template <class Exec>
void FluidSystem<Exec>::spacing_pass() {
  if (!needs_spacing()) return;
  exec::pair_pass(exec_, "sph::spacing", set_.clusters(),
                  FindSpacing{pair_law(), fluid_fluid_.view(), fluid_wall_.view(), record_.data(), wall_record_.data(),
                              spacing_.data()});
  exec::pair_pass(exec_, "sph::near_surface", set_.clusters(),
                  FindNearSurface{static_cast<float>(0.5 / parameters_.h),
                                  surface_divergence * static_cast<float>(parameters_.dimensions), fluid_fluid_.view(),
                                  record_.data(), spacing_.data(), near_surface_.data()});
  if (!parameters_.tensile_control) return;
  exec::parallel_for(exec_, "sph::control_tension", slots(),
                     ControlTension{record_.data(), near_surface_.data(), own_pressure_.data()});
}

template <class Exec>
void FluidSystem<Exec>::momentum_pass() {
  run_fluid_pass<true, false>("sph::momentum");
}
template <class Exec>
void FluidSystem<Exec>::continuity_pass() {
  run_fluid_pass<false, true>("sph::continuity");
}
template <class Exec>
void FluidSystem<Exec>::combined_pass() {
  run_fluid_pass<true, true>("sph::momentum_and_continuity");
}

template <class Exec>
void FluidSystem<Exec>::extrapolate_walls() {
  if (wall_set_.clusters() == 0 || !parameters_.extrapolated_walls) return;
  float* ghost = no_slip_ ? wall_ghost_.data() : nullptr;
  const float* surface = guarded_ ? wall_surface_.data() : nullptr;
  if (no_slip_) {
    exec::pair_pass(
        exec_, "sph::walls", near_walls_.count(),
        chosen_clusters(near_walls_.list(), ExtrapolateWalls<true>{pair_law(), wall_fluid_.view(), record_.data(),
                                                                   wall_record_.data(), ghost, surface}));
  } else {
    exec::pair_pass(
        exec_, "sph::walls", near_walls_.count(),
        chosen_clusters(near_walls_.list(), ExtrapolateWalls<false>{pair_law(), wall_fluid_.view(), record_.data(),
                                                                    wall_record_.data(), nullptr, nullptr}));
  }
  exec::parallel_for(exec_, "sph::walls_finish", exec::cluster_size * near_walls_.count(),
                     chosen_slots(near_walls_.list(), FinishWalls{wall_fluid_.view().count, wall_friction_.data(),
                                                                  wall_record_.data(), ghost, surface}));
}

template <class Exec>
void FluidSystem<Exec>::lattice_share_pass(float* share) {
  const FluidParameters& p = parameters_;
  const double scale = std::pow(p.dp, p.dimensions) * wendland_normalisation(p.h, p.dimensions);
  exec::pair_pass(exec_, "sph::lattice_share", set_.clusters(),
                  LatticeShare{static_cast<float>(0.5 / p.h), static_cast<float>(scale), fluid_fluid_.view(),
                               fluid_wall_.view(), record_.data(), wall_record_.data(), share});
}

template <class Exec>
void FluidSystem<Exec>::find_walls() {
  if (!guarded_) return;
  const auto find = [&](const Array<float, Exec>& surface, Array<float, Exec>& near) {
    exec::pair_pass(
        exec_, "sph::wall_guard", awake_clusters(),
        chosen_clusters(awake_list(), FindWalls{static_cast<float>(0.5 / parameters_.dp), fluid_wall_.view(),
                                                record_.data(), wall_record_.data(), surface.data(), near.data()}));
  };
  find(wall_surface_, near_wall_);
  if (walls_move_) find(surface_at_rest_, near_wall_at_rest_);
}

template <class Exec>
void FluidSystem<Exec>::wall_continuity_pass() {
  if (wall_set_.clusters() == 0 || parameters_.extrapolated_walls) return;
  exec::pair_pass(exec_, "sph::walls", near_walls_.count(),
                  chosen_clusters(near_walls_.list(), WallContinuity{pair_law(), wall_fluid_.view(), record_.data(),
                                                                     wall_record_.data(), wall_rate_.data()}));
}

using Backend = exec::CompiledBackend;
template FluidPairLaw FluidSystem<Backend>::pair_law() const;
template void FluidSystem<Backend>::spacing_pass();
template void FluidSystem<Backend>::momentum_pass();
template void FluidSystem<Backend>::continuity_pass();
template void FluidSystem<Backend>::combined_pass();
template void FluidSystem<Backend>::extrapolate_walls();
template void FluidSystem<Backend>::find_walls();
template void FluidSystem<Backend>::lattice_share_pass(float*);
template void FluidSystem<Backend>::wall_continuity_pass();

}  // namespace gdesp::sph
