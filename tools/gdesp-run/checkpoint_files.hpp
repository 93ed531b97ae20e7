// SPDX-License-Identifier: GPL-3.0-or-later
// Checkpoints in RUN/checkpoints: step_000001234.state, each written aside and renamed, the newest two kept. A file is
// a header, the state of the simulation, what the guard knows, and a trailer with size and checksum, by which a torn or damaged one is known.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "recovery.hpp"
#include "simulation/simulation.hpp"

namespace gdesp::tool {

struct Checkpoint {
  std::string path;
  std::int64_t step = 0;
  double time = 0.0;          ///< s
  double wall_seconds = 0.0;  ///< s, spent up to here
  Watch watch;
  std::deque<GoodState> good;  ///< of the run when it wrote the checkpoint; none when they are too large for it
};

class CheckpointFiles {
 public:
  /// `fingerprint` names the case and its parameters: states of another one are refused.
  CheckpointFiles(const std::string& run_folder, std::uint64_t fingerprint);

  /// Good states go into a checkpoint while they take no more than this together, bytes.
  static constexpr std::size_t largest_good_states = std::size_t{512} << 20;

  /// Writes the state now, with what the guard knows, and removes all but the newest two. Throws Error(resource).
  Checkpoint write(Simulation& simulation, const Guard& guard, const Recovery& recovery, double wall_seconds);

  /// Loads the newest sound checkpoint into `simulation`; warns of damaged ones and takes the one before. nullopt when
  /// there is none. Throws Error(input) when the newest sound one belongs to another case or other parameters.
  std::optional<Checkpoint> load_newest(Simulation& simulation);

 private:
  std::string folder_;
  std::uint64_t fingerprint_;
};

/// Fast 64-bit checksum against torn files and flipped bits (not against intent). Feed whole multiples of 8 bytes,
/// except at the end.
class Checksum {
 public:
  void add(const char* bytes, std::size_t count);
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0x243f6a8885a308d3ull;
};

}  // namespace gdesp::tool
