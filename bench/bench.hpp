// SPDX-License-Identifier: GPL-3.0-or-later
// Timing for benchmarks: best of several repeats, one JSON object a line.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>

namespace gdesp::bench {

/// Seconds of the fastest of `repeats` calls.
template <class Work>
double best_seconds(int repeats, const Work& work) {
  double best = 1e30;
  for (int k = 0; k < repeats; ++k) {
    const auto start = std::chrono::steady_clock::now();
    work();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

inline void print(const std::string& name, long particles, int threads, const std::string& device, double rate,
                  const std::string& unit, const std::string& extra = {}) {
  std::printf("{\"bench\":\"%s\",\"particles\":%ld,\"threads\":%d,\"device\":\"%s\",\"rate\":%.4g,\"unit\":\"%s\"%s}\n",
              name.c_str(), particles, threads, device.c_str(), rate, unit.c_str(), extra.c_str());
  std::fflush(stdout);
}

}  // namespace gdesp::bench
