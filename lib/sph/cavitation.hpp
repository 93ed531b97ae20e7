// SPDX-License-Identifier: GPL-3.0-or-later
// @eq sph.cavitation
//   P = max(P, 0); P: pressure [Pa]. Water that is pulled apart opens instead of holding together, and opened water takes
//   no more room than water at rest; its density is followed on the way (down to a tenth), so that it closes again where
//   it opened. Without it SPH water in tension clumps (tensile instability) and sprays. (Tried: floors at 0.99 and 0.8
//   rho0 pump energy into every opening and closing, two to four times the speeds in the slide of Alpe Gera.) `paper`
//   does without. Source: Monaghan (1994), J. Comput. Phys. 110, 399, doi:10.1006/jcph.1994.1034.
#pragma once

#include "core/host_device.hpp"
#include "core/real.hpp"

namespace gdesp::sph {

/// A = P/(rho0 c^2) that water holds.
GDESP_HD inline float cavitated_pressure(float A, bool cavitates) { return cavitates ? real::max(A, 0.0f) : A; }

/// Superficial D of water that has opened: not below the least that is followed.
GDESP_HD inline float cavitated_floor(float D, bool cavitates) { return cavitates ? real::max(D, -0.9f) : D; }

/// Superficial density over rho0 that its volume is reckoned with; `at_rest`: porosity (1 without grains).
GDESP_HD inline float cavitated_density(float ratio, float at_rest, bool cavitates) {
  return cavitates ? real::max(ratio, at_rest) : ratio;
}

}  // namespace gdesp::sph
