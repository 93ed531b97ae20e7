// SPDX-License-Identifier: GPL-3.0-or-later
#include "guard.hpp"

#include <algorithm>

namespace gdesp::tool {
namespace {

using Cause = Trouble::Cause;

const char* const water_remedy =
    "numerics.sound_speed (or numerics.expected_speed) is too low for this flow, or the time step "
    "too long (numerics.cfl, numerics.time_step)";
const char* const step_remedy =
    "try a smaller numerics.cfl (or numerics.time_step; with grains numerics.grain_time_step_share), "
    "and look at the start: particles that overlap push each other apart at any speed";
const char* const overlap_remedy =
    "the grains are too soft for their load (contact.youngs_modulus or contact.stiffness), or "
    "overlap at the start";
const char* const wall_remedy =
    "the wall has a hole or is thinner than resolution.dp resolves, or the time step is too long "
    "(numerics.cfl)";

constexpr std::int64_t least_steps = 50;  // between two looks at the energy

std::string percent(double share) { return number_text(100.0 * share, 3) + " %"; }

std::string mach_words(double speed, double mach, double limit) {
  return "the water reaches " + number_text(speed) + " m/s, Mach " + number_text(mach, 3) + " (limit " +
         number_text(limit) + ")";
}

std::string density_words(double error, double limit) {
  return "the density of some water is off by " + percent(error) + " (limit " + percent(limit) + ")";
}

Trouble trouble(Cause cause, const std::string& what, const std::string& remedy, std::int64_t step, double time) {
  Trouble t;
  t.cause = cause;
  t.what = what;
  t.remedy = remedy;
  t.step = step;
  t.time = time;
  return t;
}

}  // namespace

std::string moment_text(std::int64_t step, double time) {
  return "step " + std::to_string(step) + ", t = " + number_text(time, 6) + " s: ";
}

double EnergyWatch::rise(const Diagnostics& d) {
  if (lost_ >= 0 && d.step - step_ < least_steps) return rise_;
  const double potential = d.fluid_potential + d.grain_potential + d.body_potential + d.far_lake_potential;
  const double sum = potential + d.fluid_kinetic + d.fluid_elastic + d.grain_kinetic + d.grain_elastic +
                     d.body_kinetic + d.body_elastic + d.far_lake_kinetic;
  const std::int64_t lost = d.lost_fluid + d.lost_grains;
  if (lost_ < 0) {
    start_ = sum - potential;
    highest_potential_ = potential;
  }
  if (lost != lost_) {  // what left took its energy along: begin anew
    least_ = before_ = sum;
    highest_potential_ = potential + freed_;
  }
  least_ = std::min(least_, std::max(sum, before_));
  freed_ = std::max(freed_, highest_potential_ - potential);
  const double to_spend = start_ + freed_ + (d.fluid_mass + d.grain_mass) * spacing_energy_;
  rise_ = to_spend > 0.0 ? (std::min(sum, before_) - least_) / to_spend : 0.0;
  before_ = sum;
  lost_ = lost;
  step_ = d.step;
  return rise_;
}

std::string Guard::mach_text(const Diagnostics& d) {
  return moment_text(d.step, d.time) + mach_words(d.largest_speed, d.mach, mach_limit) +
         ", meant to stay below 0.1 or so: " + water_remedy;
}

std::string Guard::density_text(const Diagnostics& d) {
  return moment_text(d.step, d.time) + density_words(d.largest_density_error, density_limit) +
         ", meant: about 1 %: " + water_remedy;
}

std::string Guard::overlap_text(const Diagnostics& d) {
  return moment_text(d.step, d.time) + "grains overlap by " + percent(d.largest_overlap) +
         " of their diameter (limit " + percent(overlap_limit) + "), meant: below " + percent(overlap_on_impact) +
         " on impact, " + percent(overlap_at_rest) + " at rest: " + overlap_remedy;
}

std::string Guard::in_wall_text(const Diagnostics& d) {
  return moment_text(d.step, d.time) + "water lies " + number_text(d.deepest_in_wall, 3) +
         " particle spacings inside a wall (limit " + number_text(in_wall_limit) + "): " + wall_remedy;
}

std::string Guard::energy_text(const Diagnostics& d, double rise) {
  return moment_text(d.step, d.time) + "energy has risen by " + percent(rise) + " of what there was to spend (limit " +
         percent(energy_limit) + "), and nothing gave it: " + step_remedy;
}

std::string Guard::far_lake_text(const Diagnostics& d) {
  return moment_text(d.step, d.time) + "the far lake rises by " + percent(d.far_lake_highest) +
         " of its depth (limit " + percent(far_lake_warning) +
         "): such a wave would break, and columns do not: more of the lake has to be particles";
}

std::string Guard::lost_text(const Diagnostics& d) {
  return moment_text(d.step, d.time) + std::to_string(d.lost_fluid) + " fluid particles and " +
         std::to_string(d.lost_grains) +
         " grains have left the domain; log.ndjson keeps the count (a larger [domain] keeps the particles)";
}

std::optional<Trouble> Guard::after_step(const Simulation& simulation) const {
  const StepState s = simulation.step_state();
  const auto now = [&](Cause cause, const std::string& what, const std::string& remedy) {
    return trouble(cause, what, remedy, simulation.step_count(), simulation.time());
  };
  if (!(s.mach <= mach_limit))
    return now(Cause::mach, mach_words(s.mach * simulation.sound_speed(), s.mach, mach_limit), water_remedy);
  if (!(s.largest_density_error <= density_limit))
    return now(Cause::density, density_words(s.largest_density_error, density_limit), water_remedy);
  if (s.time_step < step_limit * s.acoustic_step) {
    const std::string bound = simulation.limited_by();
    if (bound == "force" || bound == "sound" || bound == "viscosity")
      return now(Cause::step_collapse,
                 "the time step has fallen to " + number_text(s.time_step, 3) + " s, less than " +
                     number_text(step_limit) + " of what sound allows, bound by " + bound,
                 step_remedy);
  }
  return std::nullopt;
}

std::optional<Trouble> Guard::past_a_limit(const Diagnostics& d, double rise) {
  const auto now = [&](Cause cause, const std::string& what, const std::string& remedy) {
    return trouble(cause, what, remedy, d.step, d.time);
  };
  if (!(d.mach <= mach_limit)) return now(Cause::mach, mach_words(d.largest_speed, d.mach, mach_limit), water_remedy);
  if (!(d.largest_density_error <= density_limit))
    return now(Cause::density, density_words(d.largest_density_error, density_limit), water_remedy);
  if (!(d.largest_overlap <= overlap_limit))
    return now(
        Cause::overlap,
        "grains overlap by " + percent(d.largest_overlap) + " of their diameter (limit " + percent(overlap_limit) + ")",
        overlap_remedy);
  if (!(rise <= energy_limit))
    return now(Cause::energy,
               "energy has risen by " + percent(rise) + " of what there was to spend (limit " + percent(energy_limit) +
                   "), and nothing gave it",
               step_remedy);
  if (!(d.deepest_in_wall <= in_wall_limit)) {
    Trouble t = now(Cause::in_wall,
                    "water lies " + number_text(d.deepest_in_wall, 3) + " particle spacings inside a wall (limit " +
                        number_text(in_wall_limit) + ")",
                    wall_remedy);
    t.id = d.deepest_in_wall_id;
    return t;
  }
  if (d.fluid_particles + d.grains + d.free_bodies == 0)
    return now(Cause::all_lost, "all particles have left the domain", "a larger [domain] keeps the particles");
  return std::nullopt;
}

Trouble Guard::broken(const Simulation& simulation, const std::string& message) {
  return trouble(Cause::not_finite, message, step_remedy, simulation.step_count(), simulation.time());
}

}  // namespace gdesp::tool
