// SPDX-License-Identifier: GPL-3.0-or-later
#include "guard.hpp"

#include "core/error.hpp"
#include "scene_summary.hpp"

namespace gdesp::tool {
namespace {

std::string moment(const Diagnostics& d) {
  return "step " + std::to_string(d.step) + ", t = " + number_text(d.time, 6) + " s: ";
}

const char* const remedy = "numerics.sound_speed (or expected_speed) is too low for this flow, or the time step too long "
                           "(numerics.cfl, numerics.time_step)";

}  // namespace

std::string Guard::mach_text(const Diagnostics& d) {
  return moment(d) + "the water reaches " + number_text(d.largest_speed) + " m/s, Mach " + number_text(d.mach, 3) +
         " (meant: below 0.1 or so); " + remedy;
}

std::string Guard::density_text(const Diagnostics& d) {
  return moment(d) + "the density of some water is off by " + number_text(100.0 * d.largest_density_error, 3) +
         " % (meant: about 1 %); " + remedy;
}

std::string Guard::lost_text(const Diagnostics& d) {
  return moment(d) + std::to_string(d.lost_fluid) + " fluid particles and " + std::to_string(d.lost_grains) +
         " grains have left the domain; log.ndjson keeps the count (a larger [domain] keeps the particles)";
}

void Guard::check_limits(const Diagnostics& d) {
  if (!(d.mach <= mach_limit)) throw Error(ErrorKind::numerical, mach_text(d));
  if (!(d.largest_density_error <= density_limit)) throw Error(ErrorKind::numerical, density_text(d));
  if (d.fluid_particles + d.grains == 0)
    throw Error(ErrorKind::numerical, moment(d) + "all particles have left the domain");
}

}  // namespace gdesp::tool
