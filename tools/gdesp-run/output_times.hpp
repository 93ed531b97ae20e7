// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace gdesp::tool {

/// The times of frames: 0, interval, 2 interval, ... and the end (s).
struct OutputTimes {
  double interval = 0.0, end = 0.0;

  /// The first of them after t. A rest before the end that is shorter than a millionth of the interval is none.
  double next(double t) const {
    const double time = (std::floor(t / interval + 1e-9) + 1.0) * interval;
    return time > end - 1e-6 * interval ? end : time;
  }
};

}  // namespace gdesp::tool
