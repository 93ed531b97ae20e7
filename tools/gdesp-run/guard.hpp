// SPDX-License-Identifier: GPL-3.0-or-later
// Says when the method leaves the range in which its results mean something.
#pragma once

#include "simulation/simulation.hpp"

namespace gdesp::tool {

/// Looks at the diagnostics of a run. Weakly compressible flow means Mach numbers and density errors well below one
/// (error of the order of Mach squared): a warning, once each, past 0.2 and 10 %; an end past 1 and 100 %.
class Guard {
 public:
  static constexpr double mach_warning = 0.2, mach_limit = 1.0;
  static constexpr double density_warning = 0.1, density_limit = 1.0;

  /// `warn` is called with one line. Throws Error(numerical) that names step, time, value, cause and remedy.
  template <class Warn>
  void check(const Diagnostics& d, const Warn& warn) {
    check_limits(d);
    if (d.mach > mach_warning) tell(mach_told_, warn, mach_text(d));
    if (d.largest_density_error > density_warning) tell(density_told_, warn, density_text(d));
    if (d.lost_fluid + d.lost_grains > 0) tell(lost_told_, warn, lost_text(d));
  }

 private:
  static void check_limits(const Diagnostics& d);
  static std::string mach_text(const Diagnostics& d);
  static std::string density_text(const Diagnostics& d);
  static std::string lost_text(const Diagnostics& d);
  template <class Warn>
  static void tell(bool& told, const Warn& warn, const std::string& text) {
    if (!told) warn(text);
    told = true;
  }
  bool mach_told_ = false, density_told_ = false, lost_told_ = false;
};

}  // namespace gdesp::tool
