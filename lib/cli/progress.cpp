// SPDX-License-Identifier: GPL-3.0-or-later
// The progress bar: percent, note, time left.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "cli/terminal.hpp"

namespace gdesp::cli {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double redraw_interval = 0.2;  // s

std::string duration_text(double seconds) {
  if (!std::isfinite(seconds) || seconds > 3.6e6) return "--:--";
  const long total = std::lround(seconds);
  char buffer[32];
  if (total >= 3600)
    std::snprintf(buffer, sizeof buffer, "%ld:%02ld:%02ld", total / 3600, total / 60 % 60, total % 60);
  else
    std::snprintf(buffer, sizeof buffer, "%02ld:%02ld", total / 60, total % 60);
  return buffer;
}

}  // namespace

struct Progress::State {
  std::string what;
  Clock::time_point start = Clock::now();
  Clock::time_point drawn = start - std::chrono::hours(1);
  bool terminal = false;
  bool ended = false;
  int tenths_said = 0;

  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start).count(); }

  std::string text(double fraction, const std::string& note) const {
    const double left = fraction > 0.0 ? elapsed() * (1.0 - fraction) / fraction : INFINITY;
    char percent[16];
    std::snprintf(percent, sizeof percent, "%3d %%", static_cast<int>(fraction * 100.0));
    return percent + (note.empty() ? "" : "  " + note) + "  ETA " + duration_text(left);
  }

  void draw(double fraction, const std::string& note) {
    const std::string tail = text(fraction, note);
    const std::size_t columns = static_cast<std::size_t>(terminal::terminal_columns()) - 1;
    const std::size_t taken = what.size() + tail.size() + 4;
    std::string line = what + " ";
    if (taken + 8 <= columns) {
      const std::size_t width = std::min<std::size_t>(30, columns - taken);
      const auto full = static_cast<std::size_t>(fraction * static_cast<double>(width));
      line += "[" + std::string(full, '=') + std::string(width - full, ' ') + "] ";
    }
    line += tail;
    if (line.size() > columns) line.resize(columns);
    terminal::draw_status_line(line);
  }

  void say(double fraction, const std::string& note) {
    if (!terminal::json_log())
      return terminal::write_stderr(terminal::tool_name() + ": " + what + " " + text(fraction, note) + "\n");
    const nlohmann::ordered_json line{{"level", "progress"}, {"tool", terminal::tool_name()},
                                      {"what", what},        {"fraction", fraction},
                                      {"note", note},        {"elapsed_s", elapsed()}};
    terminal::write_stderr(line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  }
};

Progress::Progress(std::string what) : state_(new State) {
  state_->what = std::move(what);
  state_->terminal = terminal::stderr_is_terminal() && !terminal::json_log();
  state_->ended = terminal::verbosity() == Verbosity::quiet;
}

Progress::~Progress() {
  if (!state_->ended && state_->terminal) terminal::draw_status_line("");
  delete state_;
}

void Progress::update(double fraction, const std::string& note) {
  State& s = *state_;
  if (s.ended) return;
  fraction = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  if (s.terminal) {
    const Clock::time_point now = Clock::now();
    if (std::chrono::duration<double>(now - s.drawn).count() < redraw_interval) return;
    s.drawn = now;
    s.draw(fraction, note);
    return;
  }
  const int tenths = static_cast<int>(fraction * 10.0);
  if (tenths <= s.tenths_said) return;
  s.tenths_said = tenths;
  s.say(fraction, note);
}

void Progress::done(const std::string& note) {
  State& s = *state_;
  if (s.ended) return;
  if (s.terminal) terminal::draw_status_line("");
  s.ended = true;
  info(s.what + ": done in " + duration_text(s.elapsed()) + (note.empty() ? "" : ", " + note));
}

}  // namespace gdesp::cli
