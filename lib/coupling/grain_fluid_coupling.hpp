// SPDX-License-Identifier: GPL-3.0-or-later
// Grains and water: porosity, what the water does to the grains, and its exact reaction.
// @eq coupling.porosity
//   eps_a = 1 - sum_i V_i (w_i/n_i) W_ai(h_c), n_i = sum_a V_a W_ia, not below least_porosity; what drag sees at a grain:
//   eps_i = 1 - sum_j V_j w_j W_ij/(1 - S_i), v_i = sum_a u_a v_a W_ia / N_i, N_i = sum_a u_a W_ia, u_a = V_a/(1 - S_a),
//   S = sum_w V_w W over walls, for u_a scaled as in coupling.buoyancy.
//   V_a: volume of mixture of fluid particle a (mass over superficial density) [m3]; V_i: volume of the grain [m3]; h_c:
//   coupling length, at least two grain diameters [m], W: coupling.averaging; w_i: immersion (coupling.buoyancy), a dry grain takes no room in the
//   water. So each grain's volume is taken from the water around it, all of it beside a wall too, where n_i is small.
//   Source: eqs 12, 13, 18 of the paper as meant (physics errata); Robinson, Ramaioli, Luding (2014), eqs 10-14,
//   doi:10.1016/j.ijmultiphaseflow.2013.11.003; walls and immersion: own.
// @eq coupling.reaction
//   f_a = -sum_i F_ia - u_a sum_i D_i W_ai / N_i, so that sum_a f_a = -sum_i (force of the water on grain i). F_ia: pressure
//   (coupling.buoyancy); D_i: drag and added mass on grain i, averaged over the step [N]. Source: eqs 17-18 of the paper.
// @eq coupling.added-mass
//   f_i = C_m rho V_i (Du/Dt - dv/dt) [N], C_m = 1/2 for a sphere; faded out from eps = 0.9 to 0.6 (explicit coupling is not
//   stable with it in a packed bed). Source: Maxey and Riley (1983), doi:10.1063/1.864230.
#pragma once

#include "coupling/averaging_nodes.hpp"
#include "coupling/drag_kinds.hpp"
#include "dem/grain_system.hpp"
#include "neighbors/cluster_list.hpp"
#include "sph/fluid_system.hpp"

namespace gdesp::coupling {

struct CouplingLaw {
  Drag drag = Drag::di_felice;
  double smoothing_length = 0.0;      ///< m, h_c
  double added_mass = 0.5;            ///< C_m
  double fluid_density = 1000.0;      ///< kg/m3
  double dynamic_viscosity = 1.0e-3;  ///< Pa s
  Vec3d gravity;
  double dp = 0.0;
  int dimensions = 3;
  std::vector<float> real_diameter;  ///< m per grain group; 0: its own
};

struct NodePairs;   // coupling_passes.hpp
struct NodeReader;  // node_reading.hpp

/// Lowest porosity the laws are given (random loose packings lie near 0.4; closer is outside Ergun's data).
inline constexpr float porosity_floor = 0.3f;
/// Lowest porosity that the water sees (discs can be packed to 0.1).
inline constexpr float least_porosity = 0.1f;

template <class Exec>
class GrainFluidCoupling {
 public:
  GrainFluidCoupling(const Exec& exec, const Domain& domain, const CouplingLaw& law);

  /// Chooses the nodes and builds the lists for the current order of both sets; valid while the movements of water and grains add up to
  /// less than `skin` (m).
  void rebuild(const dem::GrainSystem<Exec>& grains, const sph::FluidSystem<Exec>& fluid, double skin);
  /// False when no grain is in reach of water: nothing else needs to be called.
  bool in_contact() const { return nodes_.clusters() > 0; }

  /// Packs the grains' records where they will be in `ahead` seconds at their present velocity: half a step makes the
  /// coupling a leapfrog (at their place now it is explicit Euler, which feeds energy into waves between grains and water).
  void place(const dem::GrainSystem<Exec>& grains, double ahead);
  /// Porosity at the fluid particles, from the grains as placed.
  void update_porosity(const dem::GrainSystem<Exec>& grains, sph::FluidSystem<Exec>& fluid);
  /// At the start: porosity, and water at its true density in the pores. Room and porosity depend on each other.
  void start_porosity(const dem::GrainSystem<Exec>& grains, sph::FluidSystem<Exec>& fluid);
  /// From the fluid's records: what it asks of the grains for a step. Leaves the mixture pressure in the records, for the fluid's momentum, which is next.
  void gather_forces(dem::GrainSystem<Exec>& grains, sph::FluidSystem<Exec>& fluid);
  /// The reaction to what the grains took since gather_forces: external acceleration of the fluid.
  void react(const dem::GrainSystem<Exec>& grains, sph::FluidSystem<Exec>& fluid, float dt);

  /// By grain slot at the last gather_forces.
  const float* porosity() const { return porosity_.data(); }
  double smoothing_length() const { return law_.smoothing_length; }

  /// The members that a checkpoint keeps (exec/state_archive.hpp).
  template <class Archive>
  void archive(Archive& a) {
    a(nodes_, node_grain_, node_fluid_, node_wall_, node_sums_, record_, sums_, water_, velocity_before_, porosity_,
      drag_coefficient_, fluid_mass_, added_mass_, fluid_velocity_, fluid_acceleration_, other_force_, reaction_);
  }

 private:
  enum class Start { none, guess, settle };
  void find_porosity(const dem::GrainSystem<Exec>& grains, sph::FluidSystem<Exec>& fluid, Start start);
  void take_porosity(sph::FluidSystem<Exec>& fluid, Start start);
  float lattice_volume() const;  ///< m3, or m2 in two dimensions
  void pack_water(const sph::FluidSystem<Exec>& fluid);
  // What nodes add up, and who reads them.
  NodePairs grains_at_nodes() const;
  NodePairs water_at_nodes(const sph::FluidSystem<Exec>& fluid) const;
  NodePairs walls_at_nodes(const sph::FluidSystem<Exec>& fluid) const;
  NodeReader nodes_at_grains(const dem::GrainSystem<Exec>& grains) const;
  NodeReader nodes_at_water(const sph::FluidSystem<Exec>& fluid) const;

  Exec exec_;
  Domain domain_;
  CouplingLaw law_;
  NodeLattice lattice_;
  AveragingNodes<Exec> nodes_;
  ClusterList<Exec> node_grain_, node_fluid_, node_wall_;
  float wall_factor_;             ///< of the wall's share: three layers of particles stand for a wall without end
  Array<float, Exec> node_sums_;  ///< rows of coupling_passes.hpp, per cluster of nodes
  bool walls_summed_ = false;     ///< at the nodes; walls at rest are summed once a rebuild
  Array<float, Exec> real_diameter_;
  Array<float, Exec> record_;           ///< x y z V w/N | D/N (3) and offset (coupling.buoyancy), 4 each, per cluster
  Array<float, Exec> sums_;             ///< GrainSum of coupling_slots.hpp, per slot
  Array<float, Exec> water_;            ///< volume (m3), pressure (Pa), 1/(1 - S) of the water, 4 each, per cluster
  Array<Vec3f, Exec> velocity_before_;  ///< m/s, when placed
  Array<float, Exec> porosity_, drag_coefficient_, fluid_mass_, added_mass_;
  Array<Vec3f, Exec> fluid_velocity_, fluid_acceleration_, other_force_;
  Array<float, Exec> reaction_;  ///< what the water reads of the nodes, 4 a slot
};

}  // namespace gdesp::coupling
