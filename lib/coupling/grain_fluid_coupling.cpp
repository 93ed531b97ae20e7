// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/grain_fluid_coupling.hpp"

#include "coupling/coupling_passes.hpp"
#include "coupling/node_reading.hpp"

namespace gdesp::coupling {
template <class Exec>
GrainFluidCoupling<Exec>::GrainFluidCoupling(const Exec& exec, const Domain& domain, const CouplingLaw& law)
    : exec_(exec), domain_(domain), law_(law), lattice_(domain, node_spacing(law.smoothing_length, law.dimensions)),
      nodes_(exec, lattice_), node_grain_(exec), node_fluid_(exec), node_wall_(exec), node_sums_(exec),
      real_diameter_(exec), record_(exec), sums_(exec), water_(exec), velocity_before_(exec), porosity_(exec),
      drag_coefficient_(exec), fluid_mass_(exec), added_mass_(exec), fluid_velocity_(exec), fluid_acceleration_(exec),
      other_force_(exec), reaction_(exec) {
  real_diameter_.assign(law.real_diameter);
  const double sigma = law.smoothing_length * std::sqrt(law.dimensions == 2 ? 5.0 / 18.0 : 4.0 / 15.0);
  wall_factor_ = static_cast<float>(1.0 / std::erf(3.0 * law.dp / (std::sqrt(2.0) * sigma)));
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
  record_.resize_discard(n * 8);
  sums_.resize_discard(n * sums_of_grain);

  for (auto* array : {&porosity_, &drag_coefficient_, &fluid_mass_, &added_mass_}) array->resize_discard(n);
  for (auto* array : {&velocity_before_, &fluid_velocity_, &fluid_acceleration_, &other_force_})
    array->resize_discard(n);
  reaction_.resize_discard(water_clusters * 4 * exec::cluster_size);
  water_.resize_discard(water_clusters * water_rows);
  place(grains, 0.0);
  const CellGridView fluid_grid = fluid.set().view(), grain_grid = grains.set().view();
  nodes_.build(grain_grid, {grains.places(), grains.ids(), grains.slots()},
               {fluid.positions(), fluid.ids(), fluid.slots()}, skin);
  node_sums_.resize_discard(static_cast<std::size_t>(nodes_.clusters()) * node_rows);
  walls_summed_ = false;
  const auto cutoff = static_cast<float>(lattice_.reach() + skin);
  const CellGridView node_grid = nodes_.set().view();
  node_grain_.build(node_grid, nodes_.records(), grain_grid, record_.data(), cutoff);
  node_fluid_.build(node_grid, nodes_.records(), fluid_grid, fluid.records(), cutoff);
  node_wall_.build(node_grid, nodes_.records(), fluid.wall_set().view(), fluid.wall_records(), cutoff);
}

template <class Exec>
void GrainFluidCoupling<Exec>::place(const dem::GrainSystem<Exec>& grains, double ahead) {
  exec::parallel_for(
      exec_, "coupling::place", grains.slots(),
      PackGrains{domain_, grains.set().view().cluster_tile, grains.places(), grains.ids(), law_.dimensions == 2,
                 record_.data(), velocity_before_.data(), grains.velocities(), static_cast<float>(ahead)});
}

template <class Exec>
void GrainFluidCoupling<Exec>::pack_water(const sph::FluidSystem<Exec>& fluid) {
  const double c = fluid.parameters().sound_speed;
  exec::parallel_for(
      exec_, "coupling::pack_water", fluid.slots(),
      PackWater{fluid.ids(), fluid.densities(), fluid.porosity(), fluid.mass_share(), fluid.parameters().cavitates,
                lattice_volume(), static_cast<float>(law_.fluid_density * c * c), water_.data()});
}

template <class Exec>
NodePairs GrainFluidCoupling<Exec>::grains_at_nodes() const {
  return {lattice_.spline(), node_grain_.view(), nodes_.records(), record_.data()};
}
template <class Exec>
NodePairs GrainFluidCoupling<Exec>::water_at_nodes(const sph::FluidSystem<Exec>& fluid) const {
  return {lattice_.spline(), node_fluid_.view(), nodes_.records(), fluid.records()};
}
template <class Exec>
NodePairs GrainFluidCoupling<Exec>::walls_at_nodes(const sph::FluidSystem<Exec>& fluid) const {
  return {lattice_.spline(), node_wall_.view(), nodes_.records(), fluid.wall_records()};
}
template <class Exec>
NodeReader GrainFluidCoupling<Exec>::nodes_at_grains(const dem::GrainSystem<Exec>& grains) const {
  return {lattice_.spline(), nodes_.bricks(), grains.set().view().cluster_tile, record_.data()};
}
template <class Exec>
NodeReader GrainFluidCoupling<Exec>::nodes_at_water(const sph::FluidSystem<Exec>& fluid) const {
  return {lattice_.spline(), nodes_.bricks(), fluid.set().view().cluster_tile, fluid.records()};
}

template <class Exec>
void GrainFluidCoupling<Exec>::find_porosity(const dem::GrainSystem<Exec>& grains, sph::FluidSystem<Exec>& fluid,
                                             Start start) {
  const Index nodes = nodes_.clusters();
  float* sums = node_sums_.data();
  pack_water(fluid);
  if (!walls_summed_ || fluid.walls_move()) {
    exec::pair_pass(exec_, "coupling::walls", nodes,
                    AddAtNodes{walls_at_nodes(fluid), nullptr, 0, lattice_volume(), sums + node_wall});
    walls_summed_ = true;
  }
  exec::pair_pass(exec_, "coupling::room", nodes,
                  AddAtNodes{water_at_nodes(fluid), water_.data(), water_rows, 1.0f, sums + node_water});
  nodes_.fill_bricks("coupling::bricks", sums, node_rows, RoomOfNodes{});
  exec::pair_pass(exec_, "coupling::wet", grains.set().clusters(),
                  ReadNodes{nodes_at_grains(grains), sums_.data(), sums_of_grain});
  exec::parallel_for(exec_, "coupling::deposit", grains.slots(),
                     Deposit{sums_.data(), record_.data(), wall_factor_, start == Start::guess});
  exec::pair_pass(exec_, "coupling::solid", nodes, SolidAtNodes{grains_at_nodes(), sums});
  nodes_.fill_bricks("coupling::bricks", sums, node_rows, RoomOfNodes{});
  exec::pair_pass(exec_, "coupling::porosity", fluid.set().clusters(),
                  ReadNodes{nodes_at_water(fluid), reaction_.data(), 4});
}

template <class Exec>
void GrainFluidCoupling<Exec>::take_porosity(sph::FluidSystem<Exec>& fluid, Start start) {
  exec::parallel_for(exec_, "coupling::porosity_finish", fluid.slots(),
                     RoomOfWater{reaction_.data(), fluid.densities(), wall_factor_, water_.data(), fluid.porosity(),
                                 start == Start::settle});
}

template <class Exec>
void GrainFluidCoupling<Exec>::update_porosity(const dem::GrainSystem<Exec>& grains, sph::FluidSystem<Exec>& fluid) {
  find_porosity(grains, fluid, Start::none);
  take_porosity(fluid, Start::none);
}

template <class Exec>
void GrainFluidCoupling<Exec>::start_porosity(const dem::GrainSystem<Exec>& grains, sph::FluidSystem<Exec>& fluid) {
  // What is left after it, over 1 - rate (0.5 to 0.7) and a porosity of 0.4, is an error of the density.
  constexpr float settled = 2.0e-6f;
  constexpr int most_rounds = 100;
  find_porosity(grains, fluid, Start::guess);
  take_porosity(fluid, Start::guess);
  fluid.fill_pores(true);
  float off = 1.0f;
  for (int round = 0; off > settled && round < most_rounds; ++round) {
    place(grains, 0.0);
    find_porosity(grains, fluid, Start::settle);
    off = exec::reduce(exec_, "coupling::porosity_off", fluid.slots(), 0.0f,
                       PorosityOff{fluid.ids(), reaction_.data(), fluid.porosity()}, Larger{});
    take_porosity(fluid, Start::settle);
    fluid.fill_pores(false);
  }
}

template <class Exec>
void GrainFluidCoupling<Exec>::gather_forces(dem::GrainSystem<Exec>& grains, sph::FluidSystem<Exec>& fluid) {
  const Vec3f rho_g = static_cast<Vec3f>(law_.gravity * law_.fluid_density);
  pack_water(fluid);
  const Index nodes = nodes_.clusters();
  float* sums = node_sums_.data();
  exec::pair_pass(exec_, "coupling::water_at_nodes", nodes,
                  WaterAtNodes{water_at_nodes(fluid), rho_g, water_.data(), sums});
  nodes_.fill_bricks("coupling::bricks", sums, node_rows, WaterOfNodes{rho_g});
  exec::pair_pass(exec_, "coupling::gather", grains.set().clusters(),
                  GatherAtGrains{nodes_at_grains(grains), sums_.data()});
  exec::parallel_for(exec_, "coupling::forces", grains.slots(),
                     ForcesOnGrains{grains.records(),
                                    grains.ids(),
                                    grains.groups(),
                                    record_.data(),
                                    sums_.data(),
                                    real_diameter_.empty() ? nullptr : real_diameter_.data(),
                                    law_.drag,
                                    law_.dimensions == 2,
                                    static_cast<float>(law_.fluid_density),
                                    static_cast<float>(law_.dynamic_viscosity),
                                    static_cast<float>(law_.added_mass),
                                    wall_factor_,
                                    static_cast<Vec3f>(law_.gravity),
                                    porosity_.data(),
                                    drag_coefficient_.data(),
                                    fluid_mass_.data(),
                                    added_mass_.data(),
                                    fluid_velocity_.data(),
                                    fluid_acceleration_.data(),
                                    other_force_.data()});
  const double c = fluid.parameters().sound_speed;
  exec::pair_pass(exec_, "coupling::mixture", nodes, MixtureAtNodes{grains_at_nodes(), rho_g, sums});
  nodes_.fill_bricks("coupling::bricks", sums, node_rows, MixtureOfNodes{rho_g});
  exec::pair_pass(
      exec_, "coupling::mixture_read", fluid.set().clusters(),
      MixturePressure{nodes_at_water(fluid), rho_g, static_cast<float>(1.0 / (law_.fluid_density * c * c)),
                      water_.data(), fluid.porosity(), fluid.parameters().paper_form ? fluid.densities() : nullptr,
                      fluid.mixture_records()});
  grains.set_fluid({drag_coefficient_.data(), fluid_mass_.data(), added_mass_.data(), other_force_.data(),
                    fluid_acceleration_.data(), fluid_velocity_.data()});
  grains.clear_drag_impulse();
}

template <class Exec>
void GrainFluidCoupling<Exec>::react(const dem::GrainSystem<Exec>& grains, sph::FluidSystem<Exec>& fluid, float dt) {
  exec::parallel_for(exec_, "coupling::pack_reaction", grains.slots(),
                     PackReaction{grains.ids(), grains.velocities(), velocity_before_.data(),
                                  fluid_acceleration_.data(), added_mass_.data(), grains.drag_impulse(), sums_.data(),
                                  1.0f / dt, static_cast<float>(grains.kicked()) / dt, record_.data()});
  const Vec3f rho_g = static_cast<Vec3f>(law_.gravity * law_.fluid_density);
  exec::pair_pass(exec_, "coupling::reaction", nodes_.clusters(),
                  ReactionAtNodes{grains_at_nodes(), rho_g, node_sums_.data()});
  nodes_.fill_bricks("coupling::bricks", node_sums_.data(), node_rows, ReactionOfNodes{rho_g});
  exec::pair_pass(exec_, "coupling::reaction_read", fluid.set().clusters(),
                  ReactionOnFluid{nodes_at_water(fluid), rho_g, water_.data(), reaction_.data()});
  exec::parallel_for(
      exec_, "coupling::unpack", fluid.slots(),
      UnpackReaction{reaction_.data(), water_.data(), fluid.mass_share(),
                     static_cast<float>(1.0 / law_.fluid_density) / lattice_volume(), fluid.external_acceleration()});
}

template class GrainFluidCoupling<exec::CompiledBackend>;

}  // namespace gdesp::coupling
