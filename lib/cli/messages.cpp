// SPDX-License-Identifier: GPL-3.0-or-later
// Messages for people, on stderr.
#include <sys/ioctl.h>
#include <unistd.h>

#include <atomic>
#include <mutex>

#include "cli/terminal.hpp"

namespace gdesp::cli {
namespace {

std::mutex stderr_mutex;
std::string status_line;  // what a progress bar has drawn; guarded by stderr_mutex
std::string name_of_tool = "gdesp";
std::atomic<Verbosity> chosen_verbosity{Verbosity::normal};
std::atomic<bool> chosen_json{false};

void put(const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t n = ::write(STDERR_FILENO, text.data() + done, text.size() - done);
    if (n < 0 && errno != EINTR) return;
    if (n > 0) done += static_cast<std::size_t>(n);
  }
}

void say(const char* level, const std::string& message) {
  if (chosen_json) {
    nlohmann::ordered_json line{{"level", level}, {"tool", name_of_tool}, {"message", message}};
    terminal::write_stderr(line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    return;
  }
  const std::string word =
      std::string(level) == "info" || std::string(level) == "detail" ? "" : level + std::string(": ");
  terminal::write_stderr(name_of_tool + ": " + word + message + "\n");
}

}  // namespace

void set_verbosity(Verbosity verbosity, bool json) {
  chosen_verbosity = verbosity;
  chosen_json = json;
}

void info(const std::string& message) {
  if (chosen_verbosity != Verbosity::quiet) say("info", message);
}
void detail(const std::string& message) {
  if (chosen_verbosity == Verbosity::verbose) say("detail", message);
}
void warning(const std::string& message) { say("warning", message); }
void error(const std::string& message) { say("error", message); }

namespace terminal {

void set_tool_name(const std::string& name) { name_of_tool = name; }
const std::string& tool_name() { return name_of_tool; }
Verbosity verbosity() { return chosen_verbosity; }
bool json_log() { return chosen_json; }
bool stderr_is_terminal() { return ::isatty(STDERR_FILENO) == 1; }

void write_stderr(const std::string& text) {
  const std::lock_guard<std::mutex> lock(stderr_mutex);
  put(status_line.empty() ? text : "\r\x1b[K" + text + status_line);
}

void draw_status_line(const std::string& line) {
  const std::lock_guard<std::mutex> lock(stderr_mutex);
  put("\r" + line + "\x1b[K");
  status_line = line;
}

int terminal_columns() {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 20) return 80;
  return size.ws_col;
}

}  // namespace terminal
}  // namespace gdesp::cli
