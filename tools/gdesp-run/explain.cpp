// SPDX-License-Identifier: GPL-3.0-or-later
#include "explain.hpp"

#include <chrono>
#include <cstdio>
#include <iostream>

#include "exec/array.hpp"
#include "session.hpp"

namespace gdesp::tool {
namespace {

constexpr int most_steps = 20;
constexpr double longest_trial = 20.0;  // s of wall time

struct Trial {
  int steps = 0;
  double seconds = 0.0, simulated = 0.0;
};

/// The first step is not counted: it touches the memory for the first time.
Trial take_steps(Simulation& simulation, double end) {
  simulation.step(end);
  const double first = simulation.time();
  const auto begin = std::chrono::steady_clock::now();
  Trial trial;
  while (trial.steps < most_steps && trial.seconds < longest_trial && simulation.time() < end && !cli::interrupted()) {
    simulation.step(end);
    ++trial.steps;
    trial.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  trial.simulated = simulation.time() - first;
  return trial;
}

}  // namespace

int explain(RunOptions options) {
  Session session = prepare(std::move(options));
  std::string text;
  for (const std::string& line : session.summary.lines) text += line + "\n";
  std::cout << text << std::flush;
  start(session);
  const Trial trial = take_steps(*session.simulation, session.times.end);
  if (cli::interrupted()) return 130;
  std::cout << "memory            " << memory_text(static_cast<double>(exec::peak_allocated_bytes()))
            << " taken by the solver\n";
  if (trial.steps > 0 && trial.simulated > 0.0) {
    const double steps = session.times.end / trial.simulated * trial.steps;
    const double seconds = steps * trial.seconds / trial.steps;
    std::cout << "trial             " << trial.steps << " steps of " << number_text(trial.simulated / trial.steps, 3)
              << " s (" << session.simulation->limited_by() << "), "
              << number_text(trial.seconds / trial.steps * 1e3, 3) << " ms each\n"
              << "expected          " << number_text(steps, 2) << " steps, " << duration_text(seconds) << "; score "
              << number_text(static_cast<double>(session.summary.moving_particles) * session.times.end / seconds, 3)
              << "\n";
  }
  return 0;
}

}  // namespace gdesp::tool
