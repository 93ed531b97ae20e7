// SPDX-License-Identifier: GPL-3.0-or-later
// @eq far-lake.columns
//   (m_i + K_i-1 + K_i) a_i - K_i-1 a_i-1 - K_i a_i+1 = Q_i - Q_i-1 + F_i
//   K_j = M_j s_j^2/3,  Q_j = -(2/3) M_j s_j^2 du_j^2/D_j - (1/2) M_j g h_j/D_j,  s_j = h_j/D_j,  h_j = M_j/(rho w D_j)
//   Water far from where waves are made, as columns between nodes: column j lies between the nodes j and j+1, which move along the
//   lake. a_i: acceleration of node i [m/s2], 0 at the last, a wall; m_i: half of the columns beside it [kg]; M_j: mass of a
//   column [kg], constant; D_j: its length, h_j: its depth [m]; du_j = u_j+1 - u_j [m/s]; rho: density [kg/m3]; w: width [m]; g: gravity
//   [m/s2]; F_0: force of the particles' water on node 0, their wall [N]; all other F: 0.
//   From the Lagrangian sum m_i u_i^2/2 + sum M_j (hdot_j^2/6 - g h_j/2), hdot_j = -s_j du_j: the equations of Serre, Green and Naghdi
//   on a grid that moves with the water. Flat bed, constant width, waves that do not break (height below 0.6 of the depth or so) and are
//   longer than about 4.5 depths. Source: Green and Naghdi (1976), J. Fluid Mech. 78, 237, doi:10.1017/S0022112076002425;
//   own discretisation (docs/decisions/0081).
#pragma once

#include <vector>

#include "particles/particle_tables.hpp"

namespace gdesp {

/// Sums over the columns. SI units; potential energy from the bed.
struct FarLakeSums {
  double mass = 0.0, momentum = 0.0;  ///< momentum: along x
  double kinetic = 0.0, potential = 0.0;
  double highest = 0.0;  ///< largest rise of a column above still water, over the depth at rest
};

class FarLake {
 public:
  /// At rest. `density` kg/m3, `gravity` m/s2. For `settling` (s) node 0 is held, and the mean force of the particles' water on it over the
  /// second half is taken for that of water at rest. It lacks some percent of rho g w H^2/2 (a share of dp/H); what it lacks is added
  /// from then on as a constant, or node 0 would go to where the two agree.
  FarLake(const FarLakeShape& shape, double density, double gravity, double settling = 0.0);

  /// Displacement (m) of node 0 along x since the start; `ahead` (s): where it will be when nothing acts.
  double displacement(double ahead = 0.0) const { return shape_.side * (x_.front() + ahead * u_.front()); }
  double velocity() const { return shape_.side * u_.front(); }  ///< m/s, of node 0 along x
  /// One step of dt (s) under the force (N, along x) of the particles' water on node 0, constant over it: half a drift, a kick by the
  /// implicit midpoint rule, half a drift. Second order, the same backwards; mass and momentum are kept to round-off.
  /// Throws Error(numerical) when a node has caught up with the next, Error(input) when the force at rest is not that of the depth.
  void step(double dt, double force);

  FarLakeSums sums() const;
  /// N along x, of the far wall on the water in the step just taken (mean).
  double far_wall_force() const { return shape_.side * far_wall_force_; }
  FarLakeTable table() const;

  /// Distances (m) of the nodes from the place of node 0 at the start, and velocities (m/s), both into the lake. A column keeps its
  /// mass, so these give its depth.
  const std::vector<double>& nodes() const { return x_; }
  const std::vector<double>& velocities() const { return u_; }
  void set_state(std::vector<double> nodes, std::vector<double> velocities);

  template <class Archive>
  void archive(Archive& a) {
    a(time_, rest_time_, rest_impulse_, lacking_, x_, u_, far_wall_force_);
  }

 private:
  std::size_t columns() const { return x_.size() - 1; }
  double length(std::size_t j) const { return x_[j + 1] - x_[j]; }
  double depth(std::size_t j) const { return area_ / length(j); }
  void settle(double dt, double force);
  void drift(double dt);
  void factorise();
  void solve(const std::vector<double>& u, double force);

  FarLakeShape shape_;
  double gravity_ = 0.0, column_mass_ = 0.0;  ///< all columns have the same mass
  double area_ = 0.0;                         ///< m2, of a column in the plane along the lake
  double settling_ = 0.0;                     ///< s, held until then
  double time_ = 0.0, rest_time_ = 0.0,
         rest_impulse_ = 0.0;  ///< s, s, N s; the last two of the second half of the settling
  double lacking_ = 0.0;       ///< N, added to the force on node 0
  std::vector<double> x_, u_;  ///< of the nodes
  std::vector<double> inertia_, pivot_, pressure_, a_,
      middle_;  ///< K, elimination, Q, accelerations; of the step under way
  double far_wall_force_ = 0.0;
};

}  // namespace gdesp
