// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "scene_summary.hpp"
#include "target.hpp"

namespace gdesp::tool {

double RunUpFit::error(double dp) const { return limit > 0.0 ? (std::abs(slope) * dp + scatter) / limit : INFINITY; }

double RunUpFit::dp_for(double error) const {
  const double allowed = error * limit - scatter;
  if (!(allowed > 0.0)) return 0.0;
  return slope == 0.0 ? INFINITY : allowed / std::abs(slope);
}

RunUpFit fit_run_up(const std::vector<Pilot>& pilots) {
  const auto n = static_cast<double>(pilots.size());
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const Pilot& p : pilots) x += p.dp / n, y += p.run_up / n;
  for (const Pilot& p : pilots) xx += (p.dp - x) * (p.dp - x), xy += (p.dp - x) * (p.run_up - y);
  RunUpFit fit;
  fit.slope = xx > 0.0 ? xy / xx : 0.0;
  fit.limit = y - fit.slope * x;
  double squares = 0.0;
  for (const Pilot& p : pilots) squares += std::pow(p.run_up - fit.limit - fit.slope * p.dp, 2.0) / n;
  fit.scatter = std::sqrt(squares);
  return fit;
}

namespace {

bool is_finer(const Pilot& a, const Pilot& b) { return a.dp < b.dp; }
const Pilot& finest(const std::vector<Pilot>& pilots) {
  return *std::min_element(pilots.begin(), pilots.end(), is_finer);
}
const Pilot& coarsest(const std::vector<Pilot>& pilots) {
  return *std::max_element(pilots.begin(), pilots.end(), is_finer);
}

}  // namespace

double cost_ratio(const Pilot& pilot, double dp, int dimensions) {
  const double finer = pilot.dp / dp;
  return std::pow(finer, dimensions * (1.0 + pilot.growth)) * ((1.0 - pilot.wall_share) * finer + pilot.wall_share);
}

double predicted_seconds(const std::vector<Pilot>& pilots, double dp, int dimensions) {
  return finest(pilots).seconds * cost_ratio(finest(pilots), dp, dimensions);
}

double dp_for_seconds(const std::vector<Pilot>& pilots, double seconds, int dimensions) {
  double dp = finest(pilots).dp;
  for (int k = 0; k < 20; ++k)
    dp *= std::pow(predicted_seconds(pilots, dp, dimensions) / seconds, 1.0 / (dimensions + 1));
  return dp;
}

namespace {

double number_before(const std::string& text, const std::vector<std::pair<std::string, double>>& units,
                     const std::string& what) {
  std::size_t used = 0;
  double value = 0.0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) { used = 0; }
  const std::string unit = text.substr(used);
  for (const auto& [name, factor] : units)
    if (used > 0 && unit == name && value > 0.0 && std::isfinite(value)) return value * factor;
  throw Error(ErrorKind::usage, what);
}

}  // namespace

double parse_accuracy(const std::string& text) {
  const std::string what = "--accuracy " + text + ": a share of the run-up is needed, such as 5% or 0.05";
  const double value = number_before(text, {{"", 1.0}, {"%", 0.01}}, what);
  if (value >= 1.0) throw Error(ErrorKind::usage, what);
  return value;
}

double parse_duration(const std::string& text) {
  return number_before(text, {{"", 1.0}, {"s", 1.0}, {"min", 60.0}, {"m", 60.0}, {"h", 3600.0}},
                       "--budget " + text + ": a wall time is needed, such as 90s, 10min or 2h");
}

double common_length(const Scene& scene) {
  std::vector<double> lengths;
  std::optional<double> floor;
  for (const Wall& wall : scene.walls) {
    if (!wall.tank) continue;
    const Vec3d size = wall.tank->upper - wall.tank->lower;
    if (!floor) floor = wall.tank->lower.z;
    lengths.push_back(size.x);
    if (scene.dimensions == 3) lengths.push_back(size.y);
    if (std::find(wall.open.begin(), wall.open.end(), "top") == wall.open.end()) lengths.push_back(size.z);
  }
  if (!floor) return 0.0;
  if (scene.domain)
    for (int axis = 0; axis < 3; ++axis)
      if (is_periodic(scene, axis)) lengths.push_back(scene.domain->upper[axis] - scene.domain->lower[axis]);
  for (const FluidFill& fill : scene.fluid.fill) {
    if (fill.kind == "level") lengths.push_back(fill.level - *floor);
    if (fill.box) lengths.push_back(fill.box->upper.z - fill.box->lower.z);
  }
  long common = 0;
  for (const double length : lengths) {
    const double spacings = std::round(length / scene.dp);
    if (std::abs(length / scene.dp - spacings) > 0.02) return 0.0;
    common = std::gcd(common, static_cast<long>(spacings));
  }
  return static_cast<double>(common) * scene.dp;
}

double coarsest_dp(const Scene& scene) {
  double coarsest = INFINITY;
  if (!scene.domain) return coarsest;
  for (const Slide& slide : scene.slides) {
    if (slide.kind != "granular" || slide.diameter <= 0.0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      if (!is_periodic(scene, axis)) continue;
      const double period = scene.domain->upper[axis] - scene.domain->lower[axis];
      coarsest = std::min(coarsest, period / 6.0 * scene.dp / slide.diameter);
    }
  }
  return coarsest;
}

double finer_part(double unit, double dp) {
  return unit < 2.0 * dp || dp <= 0.0 ? dp : unit / std::ceil(unit / dp - 1.0e-6);
}

double coarser_part(double unit, double dp) { return unit < 2.0 * dp ? dp : unit / std::floor(unit / dp + 1.0e-6); }

Choice choose_dp(const std::vector<Pilot>& pilots, const Targets& targets, int dimensions, double unit) {
  const RunUpFit fit = fit_run_up(pilots);
  double spent = 0.0;
  for (const Pilot& p : pilots) spent += p.seconds;
  const double left = std::max(targets.budget - spent, 0.1 * targets.budget);
  const double affordable = targets.budget > 0.0 ? coarser_part(unit, dp_for_seconds(pilots, left, dimensions)) : 0.0;
  Choice choice;
  if (targets.accuracy > 0.0) {
    const double wanted = finer_part(unit, std::min(fit.dp_for(targets.accuracy), finest(pilots).dp));
    choice.accuracy_met = wanted > 0.0 && wanted >= affordable;
    if (choice.accuracy_met)
      choice = {wanted, 0.0, 0.0, true, "the accuracy asked for"};
    else if (targets.budget > 0.0)
      choice = {affordable, 0.0, 0.0, false, "all that the budget pays for; the accuracy asked for needs more"};
    else
      throw Error(ErrorKind::input,
                  "the run-up of the pilot runs scatters by " + number_text(100.0 * fit.scatter / fit.limit, 2) +
                      " % about a straight line in dp: no dp promises " + number_text(100.0 * targets.accuracy, 2) +
                      " %; a larger --accuracy, or --budget, is needed");
  } else {
    choice = {affordable, 0.0, 0.0, true, "all that the budget pays for"};
  }
  if (choice.dp > coarsest(pilots).dp) {
    choice.dp = coarsest(pilots).dp;
    choice.reason = "that of the coarsest pilot; the budget pays for less";
  }
  const double ratio = cost_ratio(finest(pilots), choice.dp, dimensions);
  choice.seconds = ratio * finest(pilots).seconds;
  choice.processor_seconds = ratio * finest(pilots).processor_seconds;
  choice.error = fit.error(choice.dp);
  return choice;
}

}  // namespace gdesp::tool
