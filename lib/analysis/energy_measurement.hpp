// SPDX-License-Identifier: GPL-3.0-or-later
// `surge-analyze energy`: the energy budget by phase and kind.
//
// Definitions (J; J per metre of width in two dimensions), sums over particles of mass m:
//   kinetic       sum m v^2 / 2 (grains: of translation), rotation sum I w^2 / 2, I = m d^2 / 10 (sphere), m d^2 / 8 (disc);
//   potential     sum m g z, counted from its value in the first frame;
//   compression   of the water, sum m e, e = int p / rho^2 d rho along Tait's law p = B ((rho/rho0)^7 - 1):
//                 e = B/rho0 [ r^6/6 + 1/r - 7/6 ], r = rho/rho0 (Monaghan 1994, J. Comput. Phys. 110, 399,
//                 doi 10.1006/jcph.1994.1034, eq 3.9 for p); B is fitted to the frame's own p and rho;
//   lost          what is missing of the first frame's total: dissipation of the flow, of the contacts, of the method.
#pragma once

#include "analysis/measurement.hpp"

namespace gdesp::analysis {

struct EnergyState {
  double water_kinetic = 0, water_potential = 0, water_compression = 0;
  double solid_kinetic = 0, solid_rotation = 0, solid_potential = 0;
};
EnergyState measure_energy(const Frame& frame, const RunInfo& info);

class EnergyMeasurement : public Measurement {
 public:
  std::vector<std::string> begin(const RunInfo& info) override;
  void add(FrameView& view, const RowSink& emit) override;
  Figure figure() const override;
  std::string summary() const override;

 private:
  RunInfo info_;
  std::optional<EnergyState> first_;
  std::vector<double> time_;
  std::vector<std::vector<double>> value_;  // by column
};

}  // namespace gdesp::analysis
