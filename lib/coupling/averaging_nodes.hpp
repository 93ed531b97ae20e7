// SPDX-License-Identifier: GPL-3.0-or-later
// The nodes through which grains and water are averaged over each other (coupling.averaging): those points of a lattice,
// fixed in space, that have both grains and water in reach. A set of places like the others, with records for lists.
#pragma once

#include "coupling/node_bricks.hpp"
#include "dem/grain_views.hpp"
#include "neighbors/cluster_list.hpp"

namespace gdesp::coupling {

/// Particles that nodes are chosen for.
template <class Position>
struct PlacesOfSet {
  Position position;  ///< position[slot]
  const std::uint32_t* id;
  Index slots;
};

template <class Exec>
class AveragingNodes {
 public:
  AveragingNodes(const Exec& exec, const NodeLattice& lattice);

  /// Chooses the nodes: in reach of grains and of water, while they move less than `skin` (m). `grain_grid`: of the grains' set.
  void build(const CellGridView& grain_grid, const PlacesOfSet<dem::GrainPlaces>& grains,
             const PlacesOfSet<const FixedPosition*>& water, double skin);

  const ClusterSet<Exec>& set() const { return set_; }
  Index clusters() const { return set_.clusters(); }
  const float* records() const { return record_.data(); }  ///< places; padding beyond reach
  /// The same nodes as particles read them: from their sums (NodeBricks::fill), and where they are.
  template <class Recipe>
  void fill_bricks(const char* name, const float* sums, Index rows, const Recipe& recipe) {
    bricks_.fill(name, sums, rows, recipe);
  }
  NodeBricksView bricks() const { return bricks_.view(node_cells()); }

  /// The members that a checkpoint keeps (exec/state_archive.hpp).
  template <class Archive>
  void archive(Archive& a) {
    a(set_, record_, wanted_, storage_, bricks_);
  }

 private:
  NodeCells node_cells() const { return {lattice_, wanted_.data(), storage_.data()}; }
  template <class Position>
  void mark_near(const PlacesOfSet<Position>& places, Index cells, int reach, Array<std::uint8_t, Exec>& near);

  Exec exec_;
  NodeLattice lattice_;
  ClusterSet<Exec> set_;
  NodeBricks<Exec> bricks_;
  Array<Index, Exec> wanted_, storage_, tile_, row_count_, row_begin_, node_of_cell_, slot_of_node_;
  Array<std::uint8_t, Exec> occupied_, near_grains_, near_water_;
  Array<FixedPosition, Exec> position_;
  Array<std::uint32_t, Exec> id_;
  Array<float, Exec> record_, room_;
};

}  // namespace gdesp::coupling
