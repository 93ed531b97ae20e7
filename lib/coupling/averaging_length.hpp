// SPDX-License-Identifier: GPL-3.0-or-later
// The length h_c over which grains and water are averaged where the scene gives none.
#pragma once

#include <algorithm>

namespace gdesp::coupling {

/// m. `h`: smoothing length of the water, `diameter`: of the largest grain (m). Two diameters, so that a kernel holds many
/// grains (Robinson, Ramaioli, Luding 2014, doi:10.1016/j.ijmultiphaseflow.2013.11.003); and enough of the water that stands in
/// their pores, which a shorter kernel counts unevenly and so makes energy: by measurement, docs/decisions/0041.
inline double default_averaging_length(double h, double diameter, int dimensions) {
  return std::max((dimensions == 2 ? 4.0 : 3.0) * h, 2.0 * diameter);
}

}  // namespace gdesp::coupling
