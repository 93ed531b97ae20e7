// SPDX-License-Identifier: GPL-3.0-or-later
// A command of surge-analyze: one file each.
#pragma once

#include <string>
#include <vector>

namespace gdesp::tool {

struct Command {
  const char* name;
  const char* summary;                                    ///< one line for the list
  int (*run)(const std::vector<std::string>& arguments);  ///< after the command's name; returns the exit code
};

int run_runup(const std::vector<std::string>& arguments);
int run_front(const std::vector<std::string>& arguments);
int run_profile(const std::vector<std::string>& arguments);
int run_gauge(const std::vector<std::string>& arguments);
int run_slide(const std::vector<std::string>& arguments);
int run_energy(const std::vector<std::string>& arguments);
int run_surface(const std::vector<std::string>& arguments);
int run_map(const std::vector<std::string>& arguments);
int run_compare(const std::vector<std::string>& arguments);
int run_converge(const std::vector<std::string>& arguments);
int run_tradeoff(const std::vector<std::string>& arguments);
int run_report(const std::vector<std::string>& arguments);
int run_plot(const std::vector<std::string>& arguments);
int run_render(const std::vector<std::string>& arguments);

/// All commands, in the order of the help.
const std::vector<Command>& commands();

}  // namespace gdesp::tool
