// SPDX-License-Identifier: GPL-3.0-or-later
// How a packing of grains came to rest: what lib/dem says of it, and lib/geometry reports.
#pragma once

#include <cstddef>

namespace gdesp {

struct Settlement {
  double time = 0.0;   ///< s, simulated
  double speed = 0.0;  ///< m/s, root mean square at the end, rotation counted as if it were translation
  bool at_rest =
      false;  ///< the speed fell below the bound of rest before the time was up, or that of nearly all grains did
  std::size_t lost = 0;  ///< grains that left the walls' box
};

}  // namespace gdesp
