// SPDX-License-Identifier: GPL-3.0-or-later
// A tool that does what its first argument says, so that a shell can look at it from outside.
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iostream>
#include <thread>

#include "cli/cli.hpp"

namespace {

using namespace gdesp;

int endless_records() {
  for (int i = 0; i < 10000000; ++i) cli::write_record({{"record", "frame"}, {"step", i}});
  return 0;
}

int endless_table() {
  for (int i = 0; i < 10000000; ++i) std::cout << i << '\n';
  return 0;
}

int wait_for_signal() {
  cli::install_signal_handlers();
  cli::info("waiting");
  for (int i = 0; i < 1000 && !cli::interrupted(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  cli::info("checkpoint written");
  return cli::interrupted() ? 130 : 0;
}

int wait_for_records() {
  cli::install_signal_handlers();
  int line = 0, count = 0;
  cli::info("waiting");
  while (cli::read_record(std::cin, line)) ++count;
  if (cli::interrupted()) return 130;
  cli::write_record({{"record", "done"}, {"count", count}});
  return 0;
}

int write_file_and_record() {
  std::ofstream file("file");
  file << "its own" << std::flush;
  cli::write_record({{"record", "frame"}});
  return 0;
}

int draw_bar() {
  cli::Progress progress("filling");
  for (int i = 0; i <= 8; ++i) {
    progress.update(i / 8.0, "t = 1.5 s");
    if (i == 4) cli::warning("in between");
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
  }
  progress.done();
  return 0;
}

int body(const std::vector<std::string>& arguments) {
  const std::string what = arguments.empty() ? "" : arguments[0];
  if (what == "usage") throw Error(ErrorKind::usage, "no such option");
  if (what == "input") throw Error(ErrorKind::input, "lake.toml:3: dp");
  if (what == "numerical") throw Error(ErrorKind::numerical, "step 12");
  if (what == "resource") throw Error(ErrorKind::resource, "no room");
  if (what == "memory") throw std::bad_alloc();
  if (what == "unexpected") throw std::runtime_error("odd");
  if (what == "records") return endless_records();
  if (what == "table") return endless_table();
  if (what == "signal") return wait_for_signal();
  if (what == "read") return wait_for_records();
  if (what == "file") return write_file_and_record();
  if (what == "bar") return draw_bar();
  std::cout << "done\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return gdesp::cli::run_tool("cli_probe", argc, argv, body); }
