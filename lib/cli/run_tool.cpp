// SPDX-License-Identifier: GPL-3.0-or-later
// From main() to exit code.
#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <new>

#include "cli/terminal.hpp"

namespace gdesp::cli {
namespace {

volatile std::sig_atomic_t signals_seen = 0;

timespec first_signal{};

/// A second signal, more than a second after the first, ends the process at once; sooner it is taken for the same
/// request (timeout(1) and terminals deliver one request twice).
extern "C" void note_signal(int) {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  if (signals_seen == 0)
    first_signal = now;
  else if (now.tv_sec > first_signal.tv_sec + 1)
    ::_exit(130);
  signals_seen = 1;
}

/// A standard stream that was closed by the caller ("2>&-") would give its number to the first file that is opened, and records
/// or messages would go into that file. It leads to where every use fails instead.
void occupy_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) != -1) continue;
    if (::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) != stream) std::perror("/dev/null");
  }
}

int run_body(int argc, char** argv, const std::function<int(const std::vector<std::string>&)>& body) {
  const std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
  try {
    const int code = body(arguments);
    terminal::finish_stdout();
    return code;
  } catch (const Error& failure) {
    error(failure.what());
    return failure.exit_code();
  } catch (const std::bad_alloc&) { error("out of memory"); } catch (const std::filesystem::filesystem_error& failure) {
    error(failure.what());
  } catch (const std::exception& failure) { error(std::string("unexpected: ") + failure.what()); }
  return static_cast<int>(ErrorKind::resource);
}

}  // namespace

int run_tool(const char* name, int argc, char** argv, const std::function<int(const std::vector<std::string>&)>& body) {
  occupy_standard_streams();
  terminal::set_tool_name(name);
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return run_body(argc, argv, body);
  } catch (const terminal::ClosedPipe&) { return 0; }
}

void install_signal_handlers() {
  struct sigaction action {};
  action.sa_handler = note_signal;  // no SA_RESTART: a read that waits for records ends
  sigemptyset(&action.sa_mask);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  struct sigaction before {};  // a terminal that closes asks the same, unless nohup(1) has told it not to
  if (::sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) ::sigaction(SIGHUP, &action, nullptr);
}

bool interrupted() { return signals_seen > 0; }

}  // namespace gdesp::cli
