// SPDX-License-Identifier: GPL-3.0-or-later
// The complete state as bytes: everything by slot, the lists included, so that a loaded simulation sums in the same
// order as the saved one.
#include <algorithm>
#include <iterator>
#include <string>

#include "exec/state_archive.hpp"
#include "simulation/coupled_simulation.hpp"

namespace gdesp {
namespace {

// What may bind a step; limited_by_ points at one of them.
const char* const bounds[] = {"sound", "force", "viscosity", "fixed", "output", "grains", "other"};

std::int32_t number_of_bound(const std::string& name) {
  const auto found = std::find(std::begin(bounds), std::end(bounds) - 1, name);
  return static_cast<std::int32_t>(found - std::begin(bounds));
}

}  // namespace

template <class Exec>
template <class Archive>
void CoupledSimulation<Exec>::archive(Archive& a) {
  std::int32_t bound = number_of_bound(limited_by_);
  a.mark("time");
  a(time_, last_dt_, density_lag_, step_factor_, acoustic_step_, step_, rebuilds_, extremes_, body_states_, bound);
  a(rigid_time_, loads_, last_loads_);
  if (rigid_) a(*rigid_);
  for (LakeBehind& behind : far_lakes_) a(behind.lake);
  if constexpr (std::is_same_v<Archive, exec::StateReader>) {
    limited_by_ = bounds[static_cast<std::size_t>(bound) % std::size(bounds)];
  }
  a.mark("fluid");
  a(fluid_);
  input_.fluid_parameters.sound_speed = fluid_.parameters().sound_speed;
  a.mark("coupling");
  a(coupling_moved_, coupling_skin_, grain_dt_, grain_speed_, coupled_rebuild_, water_reset_);
  if (coupling_) a(*coupling_);
  if (grains_) a(*grains_);
  a.mark("end");
}

template <class Exec>
void CoupledSimulation<Exec>::save(std::ostream& out) {
  exec::StateWriter writer(out);
  archive(writer);
}

template <class Exec>
void CoupledSimulation<Exec>::load(std::istream& in) {
  exec::StateReader reader(in);
  archive(reader);
}

template void CoupledSimulation<exec::CompiledBackend>::save(std::ostream&);
template void CoupledSimulation<exec::CompiledBackend>::load(std::istream&);

}  // namespace gdesp
