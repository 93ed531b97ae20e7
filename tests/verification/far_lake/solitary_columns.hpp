// SPDX-License-Identifier: GPL-3.0-or-later
// A far lake with a solitary wave in it.
#pragma once

#include <cmath>
#include <vector>

#include "simulation/far_lake.hpp"

namespace gdesp::test {

/// The solitary wave of the equations of Serre, Green and Naghdi: eta = a sech^2 k(x - ct), u = c eta/(H + eta), c^2 = g(H + a),
/// k^2 = 3a/(4 H^2 (H + a)) (Rayleigh). Lengths in m.
struct SolitaryWave {
  double depth, height, gravity;
  double k() const { return std::sqrt(0.75 * height / (depth * depth * (depth + height))); }
  double speed() const { return std::sqrt(gravity * (depth + height)); }
  double rise(double x) const {
    const double s = 1.0 / std::cosh(k() * x);
    return height * s * s;
  }
  double water_speed(double x) const { return speed() * rise(x) / (depth + rise(x)); }
  /// Its volume, m3 a metre of width.
  double volume() const { return 2.0 * height / k(); }
};

/// Puts the wave on the lake, its crest at `crest`, running to larger x for `direction` 1. The depth over a node's label, x H, gives its
/// place; what the crest needs comes from node 0, which starts behind its place at rest.
inline void set_solitary_wave(FarLake& lake, const SolitaryWave& wave, double crest, double direction) {
  std::vector<double> x = lake.nodes(), u(x.size(), 0.0);
  const double end = x.back(), k = wave.k();
  const auto beyond = [&](double place) {  // volume above still water between the place and the end
    return wave.height / k * (std::tanh(k * (end - crest)) - std::tanh(k * (place - crest)));
  };
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    const double volume = (end - x[i]) * wave.depth;
    double place = x[i];
    for (int n = 0; n < 50; ++n)
      place += ((end - place) * wave.depth + beyond(place) - volume) / (wave.depth + wave.rise(place - crest));
    x[i] = place;
    u[i] = direction * wave.water_speed(place - crest);
  }
  lake.set_state(x, u);
}

}  // namespace gdesp::test
