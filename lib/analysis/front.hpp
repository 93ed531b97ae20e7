// SPDX-License-Identifier: GPL-3.0-or-later
// The leading edge, and the time at which something arrives.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/vec3.hpp"

namespace gdesp::analysis {

/// Leading edge along a unit direction n: the place x_f beyond which a stated fraction phi of the whole fill lies,
///   sum_i V_i clamp((s_i + w_i/2 - x_f) / w_i, 0, 1) = phi sum_i V_i,   s_i = r_i . n,
/// w_i the size of particle i (dp, or a grain's diameter). phi = 0 gives the tip: the outermost edge. With
/// phi > 0 a few runaways do not move the front, and the reading converges with dp. For Ritter's dam break
/// (A. Ritter 1892, Z. VDI 36, 947) the exact place is x = t (2 sqrt(g h0) - (27 g phi V / t)^(1/3)), the test.
/// `volume` and `size` empty: all equal to 1 and to `common_size`. nullopt without particles.
std::optional<double> leading_edge(std::span<const Vec3d> position, const Vec3d& direction, double phi,
                                   double common_size, std::span<const double> volume = {},
                                   std::span<const float> size = {});

/// Time of first departure: a series y(t) leaves its first value by more than `threshold`; linear between samples.
/// nullopt when it never does. Samples that are NaN are skipped.
std::optional<double> first_departure(std::span<const double> time, std::span<const double> value, double threshold);

}  // namespace gdesp::analysis
