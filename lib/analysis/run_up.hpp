// SPDX-License-Identifier: GPL-3.0-or-later
// Run-up: how high the water climbs a bank.
//
// Definition. R(t) = highest point of the connected water that lies on a bank, above the still-water level:
//   R = max z_i + dp/2 - z_still  over particles i that
//     - belong to the connected main body (connected_water.hpp: chains of neighbours within 1.5 dp, at least one particle
//       thick, of water whose density is whole; drops, spray, threads and torn water are splash and reported apart),
//     - touch a wall at rest (terrain, tank): centre within 2.6 dp (the support of the smoothing) of its surface,
//     - and touch it where it was dry: the nearest point of that surface lies no deeper than dp below still water. (A wave that passes
//       over a bed 2 dp deep has not climbed anything yet.)
// A tongue thinner than dp is there too: a single layer of whole particles on the wall (centre within dp of it, no other water over it within 1.5 dp),
// drawn apart, so that a film of thickness e has them (dp/e) dp apart along the flow. Such a particle belongs to the sheet when it is nearer than 2.6 dp
// to particles of it: to one in the plane, to three in space. So the film is followed down to a thickness of 0.4 dp; drops on the bank are
// splash. (Experiments see the film; read at whole thickness the solitary wave on a beach of 1:5 loses a seventh of its run-up.)
// The dp/2 carries the particle's centre to the edge of the water it stands for, so that still water reads R = 0.
// No such particle above still water: R = 0. Resolution of the reading: dp (reported by the tool).
// This is the run-up of the coastal literature, the maximum elevation of wave uprush above still water
// (Synolakis 1987, J. Fluid Mech. 185, 523-545, doi 10.1017/S002211208700329X), read at the moving waterline.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/column_grid.hpp"
#include "analysis/connected_water.hpp"
#include "analysis/wall_surface.hpp"
#include "scene/scene.hpp"

namespace gdesp::analysis {

/// A part of the shore that gets a row of its own. Case coordinates; an empty polygon is everywhere.
struct BankRegion {
  std::string name;
  std::vector<Point2> polygon;
  std::optional<Point2> side_of;  ///< with `side_axis`: only the half plane to the left of the axis through it
  Point2 side_axis;
  bool contains(double x, double y) const;
};

bool point_in_polygon(const std::vector<Point2>& polygon, double x, double y);

struct RunUpRule {
  double contact = 2.6;  ///< dp; distance from the wall at which water counts as lying on it
  ConnectivityRule connectivity;
};

struct RunUpReading {
  double height = 0.0;  ///< m above still water, connected sheet
  Vec3d at;             ///< where; case coordinates
  bool climbs = false;  ///< anything above still water at all
  double splash = 0.0;  ///< m above still water, highest particle that is not connected; 0: none
};

/// One particle of the sheet that lies above still water on a bank.
struct BankParticle {
  Vec3d position;
  double height;  ///< z + dp/2 - still water, m
};

struct RunUpFrame {
  std::vector<RunUpReading> region;   ///< one per region asked for
  std::vector<BankParticle> on_bank;  ///< for profiles along the shore and run-up lines
};

/// Level and contact distance of a reading, m.
struct BankContact {
  double dp, still_water_level, contact;
};

/// `walls` empty: every particle of the main body counts as on a bank (a file without its case).
RunUpFrame measure_run_up(const ColumnGrid& grid, const ConnectedWater& water, const BankContact& at,
                          const WallSurface& walls, std::span<const BankRegion> regions);

/// Highest run-up in bins along a straight line (a section, or the lake's long axis), over all frames added.
class ShoreProfile {
 public:
  /// From `from` along the line to `to`; bins of `width` m.
  ShoreProfile(Point2 from, Point2 to, double width);
  void add(double time, std::span<const BankParticle> particles, const BankRegion& region);

  struct Bin {
    double distance = 0.0, height = 0.0, time = 0.0;
    Vec3d at;
    bool any = false;
  };
  const std::vector<Bin>& bins() const { return bins_; }

 private:
  Point2 from_, direction_;
  double length_, width_;
  std::vector<Bin> bins_;
};

/// The line through the centroid of the points along their longest extent (principal axis), end to end.
struct LongAxis {
  Point2 from, to, centre, direction;
};
LongAxis find_long_axis(std::span<const Vec3d> position);

}  // namespace gdesp::analysis
