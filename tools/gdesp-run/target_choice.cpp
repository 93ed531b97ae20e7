// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

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

double predicted_seconds(const std::vector<Pilot>& pilots, double dp, int dimensions) {
  const auto finest =
      std::min_element(pilots.begin(), pilots.end(), [](const Pilot& a, const Pilot& b) { return a.dp < b.dp; });
  return finest->seconds * std::pow(finest->dp / dp, dimensions + 1);
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

Choice choose_dp(const std::vector<Pilot>& pilots, const Targets& targets, int dimensions) {
  const RunUpFit fit = fit_run_up(pilots);
  const Pilot finest =
      *std::min_element(pilots.begin(), pilots.end(), [](const Pilot& a, const Pilot& b) { return a.dp < b.dp; });
  double spent = 0.0;
  for (const Pilot& p : pilots) spent += p.seconds;
  const double left = std::max(targets.budget - spent, 0.1 * targets.budget);
  const double affordable =
      targets.budget > 0.0 ? finest.dp * std::pow(finest.seconds / left, 1.0 / (dimensions + 1)) : 0.0;
  Choice choice;
  if (targets.accuracy > 0.0) {
    const double wanted = std::min(fit.dp_for(targets.accuracy), finest.dp);
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
  choice.seconds = predicted_seconds(pilots, choice.dp, dimensions);
  choice.error = fit.error(choice.dp);
  return choice;
}

}  // namespace gdesp::tool
