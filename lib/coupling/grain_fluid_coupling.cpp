// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/grain_fluid_coupling.hpp"

#include "coupling/coupling_passes.hpp"

namespace gdesp::coupling {
namespace {

CouplingKernel kernel_of(const CouplingLaw& law) {
  const double h = law.smoothing_length, alpha = sph::wendland_normalisation(h, law.dimensions);
  return {static_cast<float>(1.0 / (2.0 * h)), static_cast<float>(alpha), static_cast<float>(5.0 * alpha / (h * h))};
}

}  // namespace

template <class Exec>
GrainFluidCoupling<Exec>::GrainFluidCoupling(const Exec& exec, const Domain& domain, const CouplingLaw& law)
    : exec_(exec), domain_(domain), law_(law), grain_fluid_(exec), fluid_grain_(exec), fluid_wall_(exec),
      real_diameter_(exec), record_(exec), sums_(exec), water_(exec), 
      velocity_before_(exec), porosity_(exec), drag_coefficient_(exec), fluid_mass_(exec), added_mass_(exec),
      fluid_velocity_(exec), fluid_acceleration_(exec), other_force_(exec), reaction_(exec) {
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
  sums_.resize_discard(n * 12);
  for (auto* array : {&porosity_, &drag_coefficient_, &fluid_mass_, &added_mass_}) array->resize_discard(n);
  for (auto* array : {&velocity_before_, &fluid_velocity_, &fluid_acceleration_, &other_force_}) array->resize_discard(n);
  reaction_.resize_discard(water_clusters * 12);
  water_.resize_discard(water_clusters * water_rows);
  place(grains, 0.0);
  const auto cutoff = static_cast<float>(2.0 * law_.smoothing_length + skin);
  const CellGridView fluid_grid = fluid.set().view(), grain_grid = grains.set().view(), wall_grid = fluid.wall_set().view();
  grain_fluid_.build(grain_grid, record_.data(), fluid_grid, fluid.records(), cutoff);
  fluid_grain_.build(fluid_grid, fluid.records(), grain_grid, record_.data(), cutoff);
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
void GrainFluidCoupling<Exec>::find_porosity(sph::FluidSystem<Exec>& fluid, Index grain_clusters, Start start) {
  const Index water_clusters = fluid.set().clusters();
  exec::pair_pass(exec_, "coupling::room", water_clusters,
                  RoomOfWater{kernel_of(law_), lattice_volume(), fluid_wall_.view(), fluid.records(),
                              fluid.wall_records(), water_.data()});
  exec::parallel_for(exec_, "coupling::room_finish", fluid.slots(), RoomToBoost{water_.data()});
  pack_water(fluid);
  exec::pair_pass(exec_, "coupling::wet", grain_clusters,
                  WaterAtGrains{kernel_of(law_), grain_fluid_.view(), record_.data(), fluid.records(), water_.data(),
                                sums_.data()});
  exec::parallel_for(exec_, "coupling::deposit", grain_slots_, Deposit{sums_.data(), record_.data(), start == Start::guess});
  exec::pair_pass(exec_, "coupling::porosity", water_clusters,
                  FluidPorosity{kernel_of(law_), fluid_grain_.view(), fluid.records(), record_.data(), water_.data(),
                                reaction_.data()});
  exec::parallel_for(exec_, "coupling::porosity_finish", fluid.slots(),
                     SolidToPorosity{reaction_.data(), fluid.densities(), fluid.porosity(), start == Start::settle});
}

template <class Exec>
void GrainFluidCoupling<Exec>::update_porosity(sph::FluidSystem<Exec>& fluid, Index grain_clusters) {
  find_porosity(fluid, grain_clusters, Start::none);
}

template <class Exec>
void GrainFluidCoupling<Exec>::start_porosity(const dem::GrainSystem<Exec>& grains, sph::FluidSystem<Exec>& fluid) {
  const Index clusters = grains.set().clusters();
  find_porosity(fluid, clusters, Start::guess);
  fluid.fill_pores(true);
  for (int round = 0; round < 12; ++round) {
    place(grains, 0.0);
    find_porosity(fluid, clusters, Start::settle);
    fluid.fill_pores(false);
  }
}

template <class Exec>
void GrainFluidCoupling<Exec>::gather_forces(dem::GrainSystem<Exec>& grains, sph::FluidSystem<Exec>& fluid) {
  const Vec3f rho_g = static_cast<Vec3f>(law_.gravity * law_.fluid_density);
  pack_water(fluid);
  exec::pair_pass(exec_, "coupling::gather", grains.set().clusters(),
                  GatherAtGrains{kernel_of(law_), rho_g, grain_fluid_.view(), record_.data(), fluid.records(),
                                 water_.data(), fluid.porosity(), sums_.data()});
  exec::parallel_for(exec_, "coupling::forces", grains.slots(),
                     ForcesOnGrains{grains.records(), grains.ids(), grains.groups(), record_.data(), sums_.data(),
                                    real_diameter_.empty() ? nullptr : real_diameter_.data(), law_.drag,
                                    law_.dimensions == 2, static_cast<float>(law_.fluid_density),
                                    static_cast<float>(law_.dynamic_viscosity), static_cast<float>(law_.added_mass),
                                    static_cast<Vec3f>(law_.gravity), porosity_.data(), drag_coefficient_.data(),
                                    fluid_mass_.data(), added_mass_.data(), fluid_velocity_.data(),
                                    fluid_acceleration_.data(), other_force_.data()});
  const double c = fluid.parameters().sound_speed;
  exec::pair_pass(exec_, "coupling::mixture", fluid.set().clusters(),
                  MixturePressure{kernel_of(law_), rho_g, static_cast<float>(1.0 / (law_.fluid_density * c * c)),
                                  fluid_grain_.view(), record_.data(), water_.data(), fluid.porosity(),
                                  fluid.parameters().paper_form ? fluid.densities() : nullptr, fluid.mixture_records()});
  grains.set_fluid({drag_coefficient_.data(), fluid_mass_.data(), added_mass_.data(), other_force_.data(),
                    fluid_acceleration_.data(), fluid_velocity_.data()});
  grains.clear_drag_impulse();
}

template <class Exec>
void GrainFluidCoupling<Exec>::react(const dem::GrainSystem<Exec>& grains, sph::FluidSystem<Exec>& fluid, float dt) {
  exec::parallel_for(exec_, "coupling::pack_reaction", grains.slots(),
                     PackReaction{grains.ids(), grains.velocities(), velocity_before_.data(), fluid_acceleration_.data(),
                                  added_mass_.data(), grains.drag_impulse(), sums_.data(), 1.0f / dt,
                                  static_cast<float>(grains.kicked()) / dt, record_.data()});
  exec::pair_pass(exec_, "coupling::reaction", fluid.set().clusters(),
                  ReactionOnFluid{kernel_of(law_), static_cast<Vec3f>(law_.gravity * law_.fluid_density),
                                  static_cast<float>(1.0 / law_.fluid_density) / lattice_volume(),
                                  fluid_grain_.view(), fluid.records(), record_.data(), water_.data(),
                                  fluid.mass_share(), reaction_.data()});
  exec::parallel_for(exec_, "coupling::unpack", fluid.slots(),
                     UnpackReaction{reaction_.data(), fluid.external_acceleration()});
}

template class GrainFluidCoupling<exec::CompiledBackend>;

}  // namespace gdesp::coupling
