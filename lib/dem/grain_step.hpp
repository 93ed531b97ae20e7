// SPDX-License-Identifier: GPL-3.0-or-later
// One sub-step of all grains in one pass: contact forces from the records of time n, then the grain's own motion to
// the records of time n + 1. A grain reads its neighbours and writes only itself.
#pragma once

#include "dem/contact_force.hpp"
#include "dem/contact_rows.hpp"

namespace gdesp::dem {

/// What a sub-step reads and writes.
struct GrainStepView {
  ContactRowsView contacts;
  PositionUnit unit;
  GrainPlaces grains;  ///< slots + 1 records
  GrainRecord* next;
  Vec3f* velocity;         ///< m/s, at half steps
  Vec3f* spin;             ///< rad/s, at half steps
  const WallForce* walls;  ///< by GrainRecord::wall
  FluidOnGrains fluid;
  Vec3f gravity;                ///< m/s2
  float inertia_factor = 0.4f;  ///< I / (m R^2)
  bool plane = false;           ///< two dimensions: discs move along x and z and turn about y only
  HalfSteps half;               ///< s
};

/// What a sub-step tells: value[0] largest squared displacement since the rebuild (m2), [1] largest squared speed
/// (m2/s2), [2] largest overlap / diameter, [3] 1 when a velocity is not a number.
enum StepMeasure { measure_displacement2 = 0, measure_speed2 = 1, measure_overlap = 2, measure_broken = 3 };

/// Runs one sub-step with the law, unless the gate is closed; `measure` gets one Largest.
template <class Exec, class Law>
void run_grain_step(const Exec& exec, const ContactLaws<Law>& laws, const GrainStepView& view, Index slots,
                    const exec::Gate& gate, exec::Largest* measure);

}  // namespace gdesp::dem
