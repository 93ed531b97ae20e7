// SPDX-License-Identifier: GPL-3.0-or-later
// The state of what has archive() as bytes, and back.
#pragma once

#include <sstream>
#include <string>

#include "exec/state_archive.hpp"

namespace gdesp {

template <class System>
std::string state_of(System& system) {
  std::ostringstream out;
  exec::StateWriter writer(out);
  writer(system);
  return out.str();
}

/// Throws Error(input) when the bytes are no state of such a system.
template <class System>
void load_state(System& system, const std::string& bytes) {
  std::istringstream in(bytes);
  exec::StateReader reader(in);
  reader(system);
}

}  // namespace gdesp
