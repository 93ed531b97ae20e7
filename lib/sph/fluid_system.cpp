// SPDX-License-Identifier: GPL-3.0-or-later
// Start, sorting, lists and output of the fluid system. The passes are in fluid_passes.cpp, the updates in
// fluid_updates.cpp.
#include "sph/fluid_system.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "core/error.hpp"
#include "exec/permute.hpp"
#include "sph/lattice_count.hpp"
#include "sph/tait.hpp"

namespace gdesp::sph {
namespace {

// Rates live four a cluster row by row; one row is gathered by slot.
struct GatherRates {
  const float* from;
  const Index* source;
  float* to;
  GDESP_HD void operator()(Index s) const {
    const Index old = source[s];
    for (int row = 0; row < 4; ++row) {
      to[16 * static_cast<std::int64_t>(s / 4) + 4 * row + s % 4] =
          old >= 0 ? from[16 * static_cast<std::int64_t>(old / 4) + 4 * row + old % 4] : 0.0f;
    }
  }
};

struct WrapPosition {
  Domain domain;
  FixedPosition* position;
  GDESP_HD void operator()(Index s) const { position[s] = domain.wrapped(position[s]); }
};

struct KeepFilling {
  ShareOfCount share_of;
  const float* density;
  const float* count;
  float* filling;
  GDESP_HD void operator()(Index s) const {
    filling[2 * static_cast<std::int64_t>(s)] = density[s];
    const float* q = count + 8 * static_cast<std::int64_t>(s / exec::cluster_size) + s % exec::cluster_size;
    // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): null only where there is no slot
    filling[2 * static_cast<std::int64_t>(s) + 1] =
        share_of(q[0] / real::max(1.0f - q[4], 0.1f));  // of the room that walls leave
  }
};
// Water at its true density in pores: the masses are what the pores hold, over the particles that the table has there (all
// of the lattice, or already fewer). Overfull pores stay so, since SPH does not look at particles a volume again.
struct FillPores {
  const std::uint32_t* id;
  const float* porosity;
  const float* filling;
  float* density;
  float* mass_share;
  GDESP_HD void operator()(Index s) const {
    if (id[s] == no_particle) return;
    const float eps = porosity[s], share = filling[2 * static_cast<std::int64_t>(s) + 1];
    density[s] = (1.0f + filling[2 * static_cast<std::int64_t>(s)]) * eps - 1.0f;
    // Near the free surface the lattice share says nothing.
    mass_share[s] = eps > 0.99f || share < 0.9f * eps ? 1.0f : eps / share;
  }
};

struct SetOne {
  float* value;
  GDESP_HD void operator()(Index s) const { value[s] = 1.0f; }
};

std::uint64_t column_key(const Vec3d& r, double width) {
  const auto ix = static_cast<std::int64_t>(std::floor(r.x / width)),
             iy = static_cast<std::int64_t>(std::floor(r.y / width));
  return (static_cast<std::uint64_t>(ix) << 32) ^ (static_cast<std::uint64_t>(iy) & 0xffffffffu);
}

// Hydrostatic D under the highest water of each column of width dp.
std::vector<float> hydrostatic_density(const FluidTable& fluid, const FluidParameters& p) {
  std::unordered_map<std::uint64_t, double> top;
  for (const Vec3d& r : fluid.position) {
    auto [it, fresh] = top.try_emplace(column_key(r, p.dp), r.z);
    if (!fresh) it->second = std::max(it->second, r.z);
  }
  std::vector<float> density(fluid.position.size());
  const double c2 = p.sound_speed * p.sound_speed;
  for (std::size_t i = 0; i < density.size(); ++i) {
    const double head = top[column_key(fluid.position[i], p.dp)] + 0.5 * p.dp - fluid.position[i].z;
    density[i] = tait_density(static_cast<float>(-p.gravity.z * head / c2));
  }
  return density;
}

template <class T>
std::vector<T> value_or(const std::vector<T>& given, std::size_t n, const T& value) {
  return given.empty() ? std::vector<T>(n, value) : given;
}

std::vector<std::uint32_t> numbered(std::size_t n) {
  std::vector<std::uint32_t> ids(n);
  std::iota(ids.begin(), ids.end(), 0u);
  return ids;
}

}  // namespace

template <class Exec>
FluidSystem<Exec>::FluidSystem(const Exec& exec, const Domain& domain, const FluidParameters& parameters,
                               const FluidTable& fluid, const BoundaryTable& walls)
    : exec_(exec), domain_(domain), parameters_(parameters), set_(exec, domain, 2.0 * parameters.dp),
      wall_set_(exec, domain, 2.0 * parameters.dp), fluid_fluid_(exec), fluid_wall_(exec), wall_fluid_(exec),
      activity_(exec, domain, parameters.activity, parameters.dp, norm(parameters.gravity)), awake_(exec),
      near_walls_(exec), position_(exec), velocity_(exec), density_(exec), id_(exec), mass_share_(exec),
      porosity_(exec), external_(exec), record_(exec), rate_(exec), wall_position_(exec), wall_start_(exec),
      wall_velocity_(exec), wall_body_(exec), wall_density_(exec), wall_friction_(exec), wall_id_(exec),
      wall_record_(exec), wall_rate_(exec), wall_normal_(exec), wall_depth_(exec), wall_surface_(exec),
      surface_at_rest_(exec), near_wall_(exec), near_wall_at_rest_(exec), wall_ghost_(exec), spacing_(exec),
      near_surface_(exec), own_pressure_(exec), wall_bodies_(exec), body_asked_(exec), body_sum_(exec),
      body_force_(exec), filling_(exec) {
  start_fluid(fluid);
  start_walls(walls);
  sort_walls();
  rebuild(0.0);
}

template <class Exec>
void FluidSystem<Exec>::start_fluid(const FluidTable& fluid) {
  const std::size_t n = fluid.position.size();
  std::vector<FixedPosition> position(n);
  std::transform(fluid.position.begin(), fluid.position.end(), position.begin(),
                 [&](const Vec3d& r) { return domain_.fixed(r); });
  std::vector<float> density;
  if (fluid.density.empty()) {
    density = hydrostatic_density(fluid, parameters_);
  } else {
    density.resize(n);
    std::transform(fluid.density.begin(), fluid.density.end(), density.begin(), [&](float rho) {
      return static_cast<float>(static_cast<double>(rho) / parameters_.reference_density - 1.0);
    });
  }
  position_.assign(position);
  velocity_.assign(value_or(fluid.velocity, n, Vec3f{}));
  density_.assign(density);
  id_.assign(fluid.id.empty() ? numbered(n) : fluid.id);
  if (std::any_of(fluid.mass_share.begin(), fluid.mass_share.end(), [](float share) { return share != 1.0f; }))
    mass_share_.assign(fluid.mass_share);
  rate_.resize_discard(4 * (n + 3));
  rate_.fill_bytes(0);
}

template <class Exec>
void FluidSystem<Exec>::start_walls(const BoundaryTable& walls) {
  const std::size_t n = walls.position.size();
  std::vector<FixedPosition> position(n);
  std::transform(walls.position.begin(), walls.position.end(), position.begin(),
                 [&](const Vec3d& r) { return domain_.fixed(r); });
  wall_position_.assign(position);
  wall_velocity_.assign(std::vector<Vec3f>(n));
  wall_body_.assign(value_or(walls.body, n, 0));
  wall_friction_.assign(value_or(walls.friction, n, 0.0f));
  wall_density_.assign(std::vector<float>(n, 0.0f));
  guarded_ = parameters_.extrapolated_walls && walls.normal.size() == n && walls.depth.size() == n && n > 0;
  if (guarded_) {
    wall_normal_.assign(walls.normal);
    wall_depth_.assign(walls.depth);
  }
  no_slip_ = parameters_.extrapolated_walls && parameters_.viscosity != Viscosity::none &&
             std::any_of(walls.friction.begin(), walls.friction.end(), [](float f) { return f > 0.0f; });
  wall_id_.assign(numbered(n));
  walls_move_ = std::any_of(walls.body.begin(), walls.body.end(), [](std::int32_t b) { return b > 0; });
  if (walls_move_) wall_start_.assign(position);
}

template <class Exec>
void FluidSystem<Exec>::sort_fluid() {
  set_.build(position_, id_, static_cast<Index>(position_.size()), record_);
  lost_ += set_.lost();
  const Index n = set_.slots();
  const Index* source = set_.source();
  record_.resize_discard(static_cast<std::size_t>(set_.clusters()) * record_size);  // the room for all below
  exec::permute(exec_, position_, record_, source, n, FixedPosition{});
  if (domain_.periodic[0] || domain_.periodic[1] || domain_.periodic[2]) {
    exec::parallel_for(exec_, "sort::gather", n, WrapPosition{domain_, position_.data()});
  }
  exec::permute(exec_, velocity_, record_, source, n, Vec3f{});
  exec::permute(exec_, density_, record_, source, n, 0.0f);
  if (!mass_share_.empty()) exec::permute(exec_, mass_share_, record_, source, n, 1.0f);
  exec::permute(exec_, id_, record_, source, n, no_particle);
  if (coupled_) {
    exec::permute(exec_, porosity_, record_, source, n, 1.0f);
    exec::permute(exec_, external_, record_, source, n, Vec3f{});
  }
  exec::parallel_for(exec_, "sort::gather", n, GatherRates{rate_.data(), source, record_.data()});
  rate_.resize_discard(4 * static_cast<std::size_t>(n));
  exec::parallel_for(exec_, "sort::gather", 4 * n, exec::CopyEach<float>{record_.data(), rate_.data()});
  if (guarded_) near_wall_.resize_discard(6 * static_cast<std::size_t>(n));
  if (guarded_ && walls_move_) near_wall_at_rest_.resize_discard(6 * static_cast<std::size_t>(n));
  if (needs_spacing()) {
    spacing_.resize_discard(4 * static_cast<std::size_t>(n));
    near_surface_.resize_discard(static_cast<std::size_t>(n));
  }
  if (parameters_.tensile_control) own_pressure_.resize_discard(static_cast<std::size_t>(n));
}

template <class Exec>
void FluidSystem<Exec>::sort_walls() {
  if (wall_position_.empty()) return;
  wall_set_.build(wall_position_, wall_id_, static_cast<Index>(wall_position_.size()), wall_record_);
  const Index n = wall_set_.slots();
  const Index* source = wall_set_.source();
  wall_record_.resize_discard(static_cast<std::size_t>(wall_set_.clusters()) * record_size);  // the room for all below
  exec::permute(exec_, wall_position_, wall_record_, source, n, FixedPosition{});
  if (walls_move_) exec::permute(exec_, wall_start_, wall_record_, source, n, FixedPosition{});
  exec::permute(exec_, wall_velocity_, wall_record_, source, n, Vec3f{});
  exec::permute(exec_, wall_body_, wall_record_, source, n, 0);
  exec::permute(exec_, wall_friction_, wall_record_, source, n, 0.0f);
  exec::permute(exec_, wall_density_, wall_record_, source, n, 0.0f);
  exec::permute(exec_, wall_id_, wall_record_, source, n, no_particle);
  if (guarded_) {
    exec::permute(exec_, wall_normal_, wall_record_, source, n, Vec3f{});
    exec::permute(exec_, wall_depth_, wall_record_, source, n, 0.0f);
    wall_surface_.resize_discard(4 * static_cast<std::size_t>(n));
    if (walls_move_) surface_at_rest_.resize_discard(4 * static_cast<std::size_t>(n));
    spread_surface();
  }
  if (no_slip_) {
    wall_ghost_.resize_discard(4 * static_cast<std::size_t>(n));
    wall_ghost_.fill_bytes(0);
  }
  wall_rate_.resize_discard(static_cast<std::size_t>(n));
  wall_rate_.fill_bytes(0);
  exec::parallel_for(exec_, "sph::walls_reset", n,
                     EvolvedWallReset{wall_density_.data(), parameters_.paper_form, wall_record_.data()});
  pack_walls();
  if (walls_move_) return;
  wall_set_.free_workspace();
  wall_normal_.free();
  wall_depth_.free();
}

template <class Exec>
void FluidSystem<Exec>::rebuild(double move_per_step, double t, const Movers& movers, double next_move) {
  // A rebuild costs about a pass of each kind every s/(2 m) steps, the skin 0.4 s/h of a pass every step, when lists are
  // trimmed: the sum is least near s = sqrt(5 m h) (docs/decisions/0011).
  skin_ = parameters_.skin > 0.0
              ? parameters_.skin
              : std::clamp(std::sqrt(5.0 * move_per_step * parameters_.h), 0.06 * parameters_.h, 0.8 * parameters_.h);
  skin_ = std::max(skin_, 2.1 * next_move);
  sort_fluid();
  pack_all();
  if (walls_move_) sort_walls();
  update_activity(t, movers);
  build_lists();
  moved_ = 0.0;
  steps_since_rebuild_ = 0;
}

template <class Exec>
void FluidSystem<Exec>::build_lists() {
  const auto cutoff = static_cast<float>(2.0 * parameters_.h + skin_);
  const ChosenIndex water{awake_list(), awake_clusters()}, walls{near_walls_.list(), near_walls_.count()};
  fluid_fluid_.build(set_.view(), record_.data(), set_.view(), record_.data(), cutoff, water);
  fluid_wall_.build(set_.view(), record_.data(), wall_set_.view(), wall_record_.data(), cutoff, water);
  wall_fluid_.build(wall_set_.view(), wall_record_.data(), set_.view(), record_.data(), cutoff, walls);
  trimmed_ = trim_skin_ = 0.0;
  trims_next_ = false;
}

template <class Exec>
void FluidSystem<Exec>::trim_lists(double move) {
  trimmed_ += 0.5 * move;
  if (trim_skin_ == 0.0 || trimmed_ + 0.5 * move > 0.5 * trim_skin_) {
    // Two passes feel the skin, a trim costs a part of one.
    const double skin = std::max(std::sqrt(0.2 * move * parameters_.h), 1.01 * move);
    if (trim_skin_ == 0.0 && skin > 0.6 * skin_) return;  // not worth it
    trims_next_ = true;
    trim_skin_ = skin;
    trimmed_ = 0.0;
  }
  trimmed_ += 0.5 * move;
}

template <class Exec>
void FluidSystem<Exec>::enable_coupling() {
  const auto n = static_cast<std::size_t>(slots());
  porosity_.resize_discard(n);
  external_.resize_discard(n);
  coupled_ = true;
  if (mass_share_.empty()) {  // water between grains may get less
    mass_share_.resize_discard(n);
    exec::parallel_for(exec_, "sph::mass_share", slots(), SetOne{mass_share_.data()});
  }
  reset_coupling();
}

template <class Exec>
void FluidSystem<Exec>::reset_coupling() {
  porous_ = false;
  exec::parallel_for(exec_, "sph::porosity", slots(), SetOne{porosity_.data()});
  external_.fill_bytes(0);
}

template <class Exec>
void FluidSystem<Exec>::fill_pores(bool first) {
  if (first) {
    Array<float, Exec> count(exec_);
    count.resize_discard(2 * static_cast<std::size_t>(slots()));
    lattice_share_pass(count.data());
    filling_.resize_discard(2 * static_cast<std::size_t>(slots()));
    const ShareOfCount share_of(parameters_.h / parameters_.dp, parameters_.dimensions);
    exec::parallel_for(exec_, "sph::keep_filling", slots(),
                       KeepFilling{share_of, density_.data(), count.data(), filling_.data()});
  }
  exec::parallel_for(exec_, "sph::fill_pores", slots(),
                     FillPores{id_.data(), porosity_.data(), filling_.data(), density_.data(), mass_share_.data()});
  pack_all();
}

template <class Exec>
FluidTable FluidSystem<Exec>::table(float density_lag) const {
  const auto position = position_.to_host();
  const auto velocity = velocity_.to_host();
  const auto density = density_.to_host();
  const auto share = mass_share_.to_host();
  const auto porosity = coupled_ ? porosity_.to_host() : std::vector<float>();
  const auto rate = rate_.to_host();
  const auto id = id_.to_host();
  std::vector<std::size_t> order;
  for (std::size_t s = 0; s < id.size(); ++s)
    if (id[s] != no_particle) order.push_back(s);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return id[a] < id[b]; });
  FluidTable t;
  const double stiffness = parameters_.reference_density * parameters_.sound_speed * parameters_.sound_speed;
  for (std::size_t s : order) {
    const float eps = coupled_ ? porosity[s] : 1.0f;
    const float D = (1.0f + density[s] + density_lag * rate[16 * (s / 4) + 12 + s % 4]) / eps - 1.0f;
    t.position.push_back(domain_.metres(position[s]));
    t.velocity.push_back(velocity[s]);
    t.density.push_back(static_cast<float>(parameters_.reference_density * (1.0 + static_cast<double>(D))));
    t.pressure.push_back(static_cast<float>(
        stiffness * static_cast<double>(cavitated_pressure(tait_pressure(D), parameters_.cavitates))));
    t.porosity.push_back(eps);
    t.mass_share.push_back(share.empty() ? 1.0f : share[s]);
    t.id.push_back(id[s]);
  }
  return t;
}

template <class Exec>
BoundaryTable FluidSystem<Exec>::wall_table() const {
  const auto position = wall_position_.to_host();
  const auto velocity = wall_velocity_.to_host();
  const auto record = wall_record_.to_host();
  const auto id = wall_id_.to_host();
  const auto body = wall_body_.to_host();
  std::vector<std::size_t> order;
  for (std::size_t s = 0; s < id.size(); ++s)
    if (id[s] != no_particle) order.push_back(s);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return id[a] < id[b]; });
  BoundaryTable t;
  const double stiffness = parameters_.reference_density * parameters_.sound_speed * parameters_.sound_speed;
  for (std::size_t s : order) {
    t.position.push_back(domain_.metres(position[s]));
    t.velocity.push_back(velocity[s]);
    t.body.push_back(body[s]);
    t.pressure.push_back(static_cast<float>(stiffness * static_cast<double>(record[32 * (s / 4) + 28 + s % 4])));
  }
  return t;
}

template class FluidSystem<exec::CompiledBackend>;

}  // namespace gdesp::sph
