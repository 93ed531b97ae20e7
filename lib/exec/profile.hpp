// SPDX-License-Identifier: GPL-3.0-or-later
// Wall time by the name of the parallel loop. Off by default and then costs one branch a loop.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace gdesp::exec {

struct ProfileRow {
  std::string name;
  double seconds = 0.0;
  long calls = 0;
};

void set_profiling(bool on);
bool profiling();
std::vector<ProfileRow> profile();
void reset_profile();
void add_to_profile(const char* name, double seconds);

/// Adds the life of the object to the row of its name.
class ProfileScope {
 public:
  explicit ProfileScope(const char* name) : name_(profiling() ? name : nullptr) {
    if (name_) start_ = std::chrono::steady_clock::now();
  }
  ~ProfileScope() {
    if (name_) {
      add_to_profile(name_, std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count());
    }
  }
  ProfileScope(const ProfileScope&) = delete;
  ProfileScope& operator=(const ProfileScope&) = delete;

 private:
  const char* name_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace gdesp::exec
