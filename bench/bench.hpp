// SPDX-License-Identifier: GPL-3.0-or-later
// What the benchmarks share: timing, command lines, one JSON object a line.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "exec/parallel.hpp"

namespace gdesp::bench {

/// Seconds of one call.
template <class Work>
double seconds_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Seconds of the fastest of `repeats` calls.
template <class Work>
double best_seconds(int repeats, const Work& work) {
  double best = 1e30;
  for (int k = 0; k < repeats; ++k) best = std::min(best, seconds_of(work));
  return best;
}

/// What is measured, of how many particles, on how many threads.
struct Subject {
  std::string name;
  long particles = 0;
  int threads = 1;
};

/// A number by name, for the JSON line.
struct Extra {
  std::string name;
  double value;
};

/// Prints {"bench":...,"particles":...,"threads":...,"device":"cpu","rate":...,"unit":...} and the extras.
inline void print(const Subject& subject, double rate, const std::string& unit, const std::vector<Extra>& extras = {}) {
  std::printf("{\"bench\":\"%s\",\"particles\":%ld,\"threads\":%d,\"device\":\"cpu\",\"rate\":%.4g,\"unit\":\"%s\"",
              subject.name.c_str(), subject.particles, subject.threads, rate, unit.c_str());
  for (const Extra& extra : extras) std::printf(",\"%s\":%.4g", extra.name.c_str(), extra.value);
  std::printf("}\n");
  std::fflush(stdout);
}

/// Bytes that all arrays of the solver hold, per particle.
inline double bytes_each(std::size_t before, long particles) {
  return static_cast<double>(exec::allocated_bytes() - before) / static_cast<double>(particles);
}

/// To the error stream: what was counted since start_profile().
inline void print_profile() {
  for (const exec::ProfileRow& row : exec::profile()) {
    std::fprintf(stderr, "%-28s %9.4f s %8ld calls\n", row.name.c_str(), row.seconds, row.calls);
  }
}

/// usage: PROGRAM SIZE[,SIZE...] THREADS[,THREADS...]: calls run(size, threads) for each.
template <class Run>
int for_each_case(int argc, char** argv, const char* sizes, const Run& run) {
  exec::wait_briefly(argv);
  const auto numbers = [](const std::string& list) {
    std::vector<long> all;
    for (std::size_t at = 0; at <= list.size();) {
      const std::size_t comma = std::min(list.find(',', at), list.size());
      all.push_back(std::atol(list.substr(at, comma - at).c_str()));
      at = comma + 1;
    }
    return all;
  };
  for (const long size : numbers(argc > 1 ? argv[1] : sizes)) {
    for (const long threads : numbers(argc > 2 ? argv[2] : "1,2")) {
      if (size <= 0 || threads <= 0) {
        std::fprintf(stderr, "usage: %s SIZE[,SIZE...] THREADS[,THREADS...], positive numbers\n", argv[0]);
        return 2;
      }
      run(size, exec::set_threads(static_cast<int>(threads)));
    }
  }
  print_profile();
  return 0;
}

/// Turns the profile on when GDESP_PROFILE is set; forgets what was counted so far.
inline void start_profile() {
  exec::reset_profile();
  exec::set_profiling(std::getenv("GDESP_PROFILE") != nullptr);
}

/// Numbers in [0, 1), always the same.
class Random {
 public:
  double operator()() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return static_cast<double>(state_ >> 11) / 9007199254740992.0;
  }

 private:
  unsigned long long state_ = 88172645463325252ull;
};

}  // namespace gdesp::bench
