// SPDX-License-Identifier: GPL-3.0-or-later
// A curve against a reference; runs of several resolutions against each other; error against cost.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace gdesp::analysis {

/// y(x), by points; low and high where the source gives a band.
struct Curve {
  std::vector<double> x, y, low, high;
};

struct ComparisonOptions {
  double max_shift = 0.0;  ///< one constant shift of our x within +- this is allowed (a release that takes time)
  double from = -1e300, until = 1e300;  ///< of the reference's x
};

struct Comparison {
  std::size_t points = 0;        ///< of the reference that lie within our range
  double rms = 0.0, bias = 0.0;  ///< of ours - reference, in the reference's unit
  double largest = 0.0;          ///< difference largest in magnitude, with its sign
  double largest_at = 0.0;       ///< x
  double range = 0.0;            ///< largest - smallest value of the reference's points used
  std::optional<double> inside;  ///< share of the points inside the reference's band
  double shift = 0.0;            ///< of our x that was applied
};

/// Ours is interpolated linearly at the reference's points. Throws Error(input) when no point overlaps or x does not grow.
Comparison compare_curves(const Curve& ours, const Curve& reference, const ComparisonOptions& options = {});

/// Value at x, linear; nullopt outside the range.
std::optional<double> interpolate(const std::vector<double>& x, const std::vector<double>& y, double at);

enum class ConvergenceKind { monotone, oscillating, diverging, too_close };

/// Three grids: the procedure of the ASME Journal of Fluids Engineering (Celik et al. 2008, J. Fluids Eng. 130, 078001,
/// doi 10.1115/1.2960953): observed order p from e21 = f2 - f1, e32 = f3 - f2 and the ratios r21, r32 (eqs 3a-3c, solved
/// by bisection), extrapolated value f_ext = (r21^p f1 - f2) / (r21^p - 1) (eq 4), GCI = 1.25 |e21| / (r21^p - 1) (eq 7, absolute).
/// Only for monotone convergence, differences of one sign that shrink faster than the spacing's logarithm: otherwise the kind says why there is no order and no error bar.
struct Convergence {
  ConvergenceKind kind = ConvergenceKind::monotone;
  double order = 0.0, extrapolated = 0.0, error_bar = 0.0;  ///< value's unit; NaN unless monotone
  double ratio = 0.0;                                       ///< e21 / e32
};

/// `spacing` and `value` of at least three runs, any order, spacings distinct; the three finest are used.
/// Throws Error(input) otherwise.
Convergence assess_convergence(std::vector<double> spacing, std::vector<double> value);
std::string to_string(ConvergenceKind kind);

/// Which points no other point beats in both cost and error (ties: the first). Same length as the input.
std::vector<bool> pareto_front(const std::vector<double>& cost, const std::vector<double>& error);

}  // namespace gdesp::analysis
