// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.hpp"

namespace gdesp::analysis {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

// Finite points with x growing; equal x: the last counts.
Curve cleaned(const Curve& c, const char* whose) {
  Curve out;
  for (std::size_t k = 0; k < c.x.size(); ++k) {
    if (!std::isfinite(c.x[k]) || !std::isfinite(c.y[k])) continue;
    if (!out.x.empty() && c.x[k] < out.x.back()) {
      throw Error(ErrorKind::input, std::string(whose) + ": x falls from " + std::to_string(out.x.back()) + " to " +
                                        std::to_string(c.x[k]) +
                                        "; the rows must be in order (choose one series with --where)");
    }
    if (!out.x.empty() && c.x[k] == out.x.back()) {
      out.y.back() = c.y[k];
      continue;
    }
    out.x.push_back(c.x[k]);
    out.y.push_back(c.y[k]);
  }
  return out;
}

Comparison compare_shifted(const Curve& ours, const Curve& reference, const ComparisonOptions& options, double shift) {
  Comparison r;
  r.shift = shift;
  double sum = 0.0, square = 0.0, low = 1e300, high = -1e300;
  std::size_t banded = 0, inside = 0;
  for (std::size_t k = 0; k < reference.x.size(); ++k) {
    const double x = reference.x[k], y = reference.y[k];
    if (!std::isfinite(x) || !std::isfinite(y) || x < options.from || x > options.until) continue;
    const auto mine = interpolate(ours.x, ours.y, x - shift);
    if (!mine) continue;
    const double d = *mine - y;
    ++r.points;
    sum += d;
    square += d * d;
    low = std::min(low, y);
    high = std::max(high, y);
    if (r.points == 1 || std::abs(d) > std::abs(r.largest)) r.largest = d, r.largest_at = x;
    if (k < reference.low.size() && std::isfinite(reference.low[k]) && std::isfinite(reference.high[k])) {
      ++banded;
      inside += *mine >= reference.low[k] && *mine <= reference.high[k];
    }
  }
  if (r.points == 0) return r;
  const double n = static_cast<double>(r.points);
  r.bias = sum / n;
  r.rms = std::sqrt(square / n);
  r.range = high - low;
  if (banded > 0) r.inside = static_cast<double>(inside) / static_cast<double>(banded);
  return r;
}

}  // namespace

std::optional<double> interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) {
  if (x.empty() || !(at >= x.front() && at <= x.back())) return std::nullopt;
  const auto above = std::lower_bound(x.begin(), x.end(), at);
  const std::size_t k = static_cast<std::size_t>(above - x.begin());
  if (k == 0) return y[0];
  const double u = (at - x[k - 1]) / (x[k] - x[k - 1]);
  return y[k - 1] + u * (y[k] - y[k - 1]);
}

Comparison compare_curves(const Curve& ours, const Curve& reference, const ComparisonOptions& options) {
  const Curve mine = cleaned(ours, "our table");
  Comparison best = compare_shifted(mine, reference, options, 0.0);
  if (options.max_shift > 0.0) {
    const int steps = 200;
    const std::size_t least = best.points - best.points / 5;  // a shift must not win by dropping points
    for (int k = -steps; k <= steps; ++k) {
      const Comparison c = compare_shifted(mine, reference, options, options.max_shift * k / steps);
      if (c.points >= std::max<std::size_t>(least, 1) && (best.points == 0 || c.rms < best.rms)) best = c;
    }
  }
  if (best.points == 0) {
    throw Error(ErrorKind::input,
                "no point of the reference lies within our table's range" +
                    (mine.x.empty() ? std::string(", which is empty")
                                    : " " + std::to_string(mine.x.front()) + " .. " + std::to_string(mine.x.back())));
  }
  return best;
}

Convergence assess_convergence(std::vector<double> spacing, std::vector<double> value) {
  if (spacing.size() != value.size() || spacing.size() < 3) {
    throw Error(ErrorKind::input, "convergence needs at least three runs, there are " + std::to_string(spacing.size()));
  }
  std::vector<std::size_t> order(spacing.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return spacing[a] < spacing[b]; });
  const double h1 = spacing[order[0]], h2 = spacing[order[1]], h3 = spacing[order[2]];
  const double f1 = value[order[0]], f2 = value[order[1]], f3 = value[order[2]];
  if (!(h1 > 0.0 && h2 > h1 && h3 > h2) || !std::isfinite(f1 + f2 + f3)) {
    throw Error(ErrorKind::input, "convergence needs three different spacings above 0 and finite values");
  }
  const double r21 = h2 / h1, r32 = h3 / h2, e21 = f2 - f1, e32 = f3 - f2;
  Convergence c;
  c.order = c.extrapolated = c.error_bar = none;
  const double scale = std::max({std::abs(f1), std::abs(f2), std::abs(f3), 1e-300});
  if (std::abs(e32) < 1e-12 * scale || std::abs(e21) < 1e-12 * scale) {
    c.kind = ConvergenceKind::too_close;
    return c;
  }
  c.ratio = e21 / e32;
  if (c.ratio < 0.0) {
    c.kind = ConvergenceKind::oscillating;
    return c;
  }
  // Equation 3 without its fixed point, which need not settle for unequal ratios: f = f0 + C h^p demands
  // e32 / e21 = r21^p (r32^p - 1) / (r21^p - 1), whose right side grows with p from ln r32 / ln r21 at p = 0.
  const auto demanded = [&](double p) {
    return std::pow(r21, p) * std::expm1(p * std::log(r32)) / std::expm1(p * std::log(r21));
  };
  double low = 1e-3, high = 40.0;
  if (1.0 / c.ratio <= demanded(low)) {
    c.kind = ConvergenceKind::diverging;
    return c;
  }
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (demanded(middle) < 1.0 / c.ratio ? low : high) = middle;
  }
  const double p = 0.5 * (low + high);
  const double gain = std::pow(r21, p);
  c.order = p;
  c.extrapolated = (gain * f1 - f2) / (gain - 1.0);
  c.error_bar = 1.25 * std::abs(e21) / (gain - 1.0);
  return c;
}

std::string to_string(ConvergenceKind kind) {
  switch (kind) {
    case ConvergenceKind::monotone:
      return "monotone";
    case ConvergenceKind::oscillating:
      return "oscillating";
    case ConvergenceKind::diverging:
      return "diverging";
    case ConvergenceKind::too_close:
      return "too close";
  }
  return "";
}

std::vector<bool> pareto_front(const std::vector<double>& cost, const std::vector<double>& error) {
  std::vector<std::size_t> order(cost.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return cost[a] != cost[b] ? cost[a] < cost[b] : error[a] < error[b];
  });
  std::vector<bool> front(cost.size(), false);
  double best = std::numeric_limits<double>::infinity();
  for (const std::size_t k : order) {
    if (!std::isfinite(cost[k]) || !std::isfinite(error[k]) || error[k] >= best) continue;
    best = error[k];
    front[k] = true;
  }
  return front;
}

}  // namespace gdesp::analysis
