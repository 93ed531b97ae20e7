// SPDX-License-Identifier: GPL-3.0-or-later
// Damaged variants of good inputs: bits, bytes, numbers, lengths, pieces of one another. The same for the same seed.
#pragma once

#include <string>
#include <vector>

#include "geometry/random.hpp"

namespace gdesp::fuzz {

class Mutator {
 public:
  explicit Mutator(std::vector<std::string> seeds);
  /// Variant number `index`: a function of it and of the seeds alone. `which` receives the seed it came from.
  std::string variant(std::uint64_t index, std::size_t& which) const;

 private:
  using Random = geometry::Random;
  void change(std::string& text, Random& random) const;
  std::vector<std::string> seeds_, words_;
};

}  // namespace gdesp::fuzz
