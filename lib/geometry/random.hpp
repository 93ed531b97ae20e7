// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers that are the same with every compiler and library: splitmix64 (Steele, Lea, Flood 2014,
// doi:10.1145/2660193.2660195).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace gdesp::geometry {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15ull + 0x1234567ull) {}
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }  ///< [0, 1)
  double signed_unit() { return 2.0 * unit() - 1.0; }                    ///< [-1, 1)
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(bits() % n); }
  /// Standard normal (Box and Muller 1958).
  double normal() {
    const double u = 1.0 - unit(), v = unit();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(6.283185307179586 * v);
  }

 private:
  std::uint64_t state_;
};

}  // namespace gdesp::geometry
