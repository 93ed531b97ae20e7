// SPDX-License-Identifier: GPL-3.0-or-later
// Says when the method leaves the range in which its results mean something. docs/stability.md gives the reasons for
// the limits.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "scene_summary.hpp"
#include "simulation/simulation.hpp"

namespace gdesp::tool {

/// What has gone wrong, for people: the particle is found afterwards (offender.hpp).
struct Trouble {
  enum class Cause { not_finite, mach, density, step_collapse, energy, overlap, in_wall, all_lost };
  Cause cause = Cause::not_finite;
  std::string what;    ///< with value and limit
  std::string remedy;  ///< what to change
  std::int64_t step = 0;
  double time = 0.0;               ///< s
  std::uint32_t id = 0xffffffffu;  ///< of the particle, where the simulation knows it
};

/// "step 12, t = 0.5 s: "
std::string moment_text(std::int64_t step, double time);

/// Energy that nothing gave. The sum over water and grains may fall (dissipation) but not rise again by more than a share
/// of what the run has had to spend: kinetic and elastic energy at the start, potential energy set free so far, and the
/// weight of all over one particle spacing. A low or a high counts when it is met twice, some 100 steps apart: energy that
/// walls hold while grains rebound from them is in no sum.
class EnergyWatch {
 public:
  EnergyWatch() = default;
  /// `spacing_energy`: g dp (m2/s2).
  explicit EnergyWatch(double spacing_energy) : spacing_energy_(spacing_energy) {}
  /// The rise above the lowest sum so far, over what there was to spend.
  double rise(const Diagnostics& d);

 private:
  double spacing_energy_ = 0.0, least_ = std::numeric_limits<double>::infinity(), start_ = 0.0,
         highest_potential_ = 0.0, freed_ = 0.0;
  double before_ = 0.0, rise_ = 0.0;
  std::int64_t lost_ = -1, step_ = 0;
};

struct GuardSetup {
  bool watches_energy = false;  ///< no body but far lakes does work, no period along gravity
  double spacing_energy = 0.0;  ///< m2/s2, g dp
};

class Guard {
 public:
  // Warned of once past the first, stopped past the second.
  static constexpr double mach_warning = 0.2, mach_limit = 1.0;
  static constexpr double density_warning = 0.1, density_limit = 0.5;                ///< of the reference density
  static constexpr double overlap_warning = overlap_on_impact, overlap_limit = 0.3;  ///< of a diameter
  static constexpr double in_wall_warning = 1.0, in_wall_limit = 2.0;                ///< of a particle spacing
  static constexpr double energy_warning = 0.05, energy_limit = 0.5;                 ///< of what there was to spend
  static constexpr double far_lake_warning = 0.6;                                    ///< of its depth
  static constexpr double step_limit = 1.0e-3;                                       ///< of the acoustic step

  Guard() = default;
  explicit Guard(const GuardSetup& setup) : setup_(setup), energy_(setup.spacing_energy) {}

  /// After every step; costs a few comparisons.
  std::optional<Trouble> after_step(const Simulation& simulation) const;
  /// With every set of diagnostics. `warn` is called with one line, once for each kind.
  template <class Warn>
  std::optional<Trouble> look(const Diagnostics& d, const Warn& warn) {
    const double rise = setup_.watches_energy ? energy_.rise(d) : 0.0;
    if (std::optional<Trouble> trouble = past_a_limit(d, rise)) return trouble;
    if (d.mach > mach_warning) tell(told_.mach, warn, mach_text(d));
    if (d.largest_density_error > density_warning) tell(told_.density, warn, density_text(d));
    if (d.largest_overlap > overlap_warning) tell(told_.overlap, warn, overlap_text(d));
    if (d.deepest_in_wall > in_wall_warning) tell(told_.in_wall, warn, in_wall_text(d));
    if (rise > energy_warning) tell(told_.energy, warn, energy_text(d, rise));
    if (d.far_lake_highest > far_lake_warning) tell(told_.far_lake, warn, far_lake_text(d));
    if (d.lost_fluid + d.lost_grains > 0) tell(told_.lost, warn, lost_text(d));
    return std::nullopt;
  }
  /// What a step has thrown, as trouble.
  static Trouble broken(const Simulation& simulation, const std::string& message);

 private:
  static std::optional<Trouble> past_a_limit(const Diagnostics& d, double rise);
  static std::string mach_text(const Diagnostics& d);
  static std::string density_text(const Diagnostics& d);
  static std::string overlap_text(const Diagnostics& d);
  static std::string in_wall_text(const Diagnostics& d);
  static std::string energy_text(const Diagnostics& d, double rise);
  static std::string far_lake_text(const Diagnostics& d);
  static std::string lost_text(const Diagnostics& d);
  template <class Warn>
  static void tell(bool& told, const Warn& warn, const std::string& text) {
    if (!told) warn(text);
    told = true;
  }
  struct Told {
    bool mach = false, density = false, overlap = false, in_wall = false, energy = false, far_lake = false,
         lost = false;
  };
  GuardSetup setup_;
  EnergyWatch energy_;
  Told told_;
};

}  // namespace gdesp::tool
