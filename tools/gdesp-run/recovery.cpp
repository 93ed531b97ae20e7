// SPDX-License-Identifier: GPL-3.0-or-later
#include "recovery.hpp"

#include <algorithm>
#include <istream>
#include <new>
#include <ostream>
#include <streambuf>
#include <utility>

#include "cli/cli.hpp"
#include "exec/array.hpp"
#include "exec/profile.hpp"
#include "scene_summary.hpp"

namespace gdesp::tool {
namespace {

/// A stream into a vector, in large pieces.
class MemoryOutput : public std::streambuf {
 public:
  explicit MemoryOutput(std::vector<char>& bytes) : bytes_(bytes) {}

 protected:
  std::streamsize xsputn(const char* from, std::streamsize count) override {
    bytes_.insert(bytes_.end(), from, from + count);
    return count;
  }
  int_type overflow(int_type c) override {
    if (!traits_type::eq_int_type(c, traits_type::eof())) bytes_.push_back(traits_type::to_char_type(c));
    return traits_type::not_eof(c);
  }

 private:
  std::vector<char>& bytes_;
};

class MemoryInput : public std::streambuf {
 public:
  explicit MemoryInput(const std::vector<char>& bytes) {
    char* begin = const_cast<char*>(bytes.data());  // only read
    setg(begin, begin, begin + bytes.size());
  }
};

bool outran_its_sound(Trouble::Cause cause) {
  return cause == Trouble::Cause::mach || cause == Trouble::Cause::density;
}

}  // namespace

void Recovery::relax(Simulation& simulation) {
  if (tries_ > 0 && simulation.time() >= clear_after_) tries_ = 0;
  if (tries_ > 0 || step_factor_ == 1.0) return;
  step_factor_ = std::min(1.0, 2.0 * step_factor_);
  simulation.set_caution(step_factor_, simulation.sound_speed());
}

void Recovery::keep(Simulation& simulation, const Guard& guard) {
  if (memory_ <= 0.0) return;
  const exec::ProfileScope scope("guard::keep_good_state");
  GoodState state{{}, guard, simulation.step_count(), simulation.time()};
  if (kept_.size() == most_states) {
    state.bytes = std::move(kept_.front().bytes);
    kept_.pop_front();
    state.bytes.clear();
  }
  try {
    state.bytes.reserve(exec::allocated_bytes());  // more than a state takes: nothing is copied as it grows
    MemoryOutput buffer(state.bytes);
    std::ostream stream(&buffer);
    stream.exceptions(std::ios::badbit);  // what the vector throws comes through
    simulation.save(stream);
  } catch (const std::bad_alloc&) {
    kept_.clear();
    memory_ = 0.0;
    cli::warning("too little memory to keep good states: trouble will end the run instead of being gone back from");
    return;
  }
  const auto size = static_cast<double>(state.bytes.size());
  kept_.push_back(std::move(state));
  while (!kept_.empty() && size * static_cast<double>(kept_.size()) > memory_) kept_.pop_front();
  if (kept_.empty()) {
    memory_ = 0.0;
    cli::warning("a good state takes " + memory_text(size) +
                 ", more than may be used for it: trouble will end the run instead of being gone back from");
  }
}

void Recovery::take_over(const Watch& watch, std::deque<GoodState> good) {
  kept_ = std::move(good);
  tries_ = watch.tries;
  recoveries_ = watch.recoveries;
  step_factor_ = watch.step_factor;
  clear_after_ = watch.clear_after;
}

void Recovery::load(const GoodState& kept, Simulation& simulation) {
  MemoryInput buffer(kept.bytes);
  std::istream stream(&buffer);
  simulation.load(stream);
}

nlohmann::ordered_json Recovery::go_back(Simulation& simulation, Guard& guard, const Trouble& trouble) {
  ++tries_;
  ++recoveries_;
  if (tries_ > 1 && kept_.size() > 1) kept_.pop_back();  // the newest led here again: it may carry the seed already
  const GoodState& from = kept_.back();
  const double sound = simulation.sound_speed();
  load(from, simulation);
  guard = from.guard;
  step_factor_ *= 0.5;
  simulation.set_caution(
      step_factor_, outran_its_sound(trouble.cause) ? sound_factor * sound : std::max(sound, simulation.sound_speed()));
  clear_after_ = trouble.time + (trouble.time - from.time);
  return {{"t", from.time},
          {"step", from.step},
          {"event", "recovery"},
          {"recovery", recoveries_},
          {"trouble_t", trouble.time},
          {"trouble_step", trouble.step},
          {"cause", trouble.what},
          {"try", tries_},
          {"step_factor", step_factor_},
          {"sound_speed", simulation.sound_speed()}};
}

void Recovery::restore_newest(Simulation& simulation) {
  if (has_state()) load(kept_.back(), simulation);
}

std::string Recovery::tries_text(const Simulation& simulation) const {
  if (recoveries_ == 0) return has_state() ? "" : " (no good state was held to go back to)";
  const std::string first = kept_.empty() ? "" : " from t = " + number_text(kept_.front().time, 6) + " s on,";
  return "; " + std::to_string(tries_) + (tries_ == 1 ? " try" : " tries") + first + " with steps down to " +
         number_text(step_factor_, 3) + " of their size and a sound speed of up to " +
         number_text(simulation.sound_speed()) + " m/s did not come through" +
         (recoveries_ > tries_ ? " (" + std::to_string(recoveries_) + " recoveries in all)" : "");
}

}  // namespace gdesp::tool
