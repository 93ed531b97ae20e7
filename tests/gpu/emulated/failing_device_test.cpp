// SPDX-License-Identifier: GPL-3.0-or-later
// A card without memory, and a card that is lost in mid-run: the run ends with a message of kind resource (exit code 5 of the
// programs), nothing stays allocated, and the newest checkpoint goes on.
#include <gtest/gtest.h>

#include <sstream>

#include "../parity/parity_scenes.hpp"
#include "core/error.hpp"
#include "emulated_simulation.hpp"

namespace gdesp::emulated {
namespace {

SimulationInput grains_in_water() {
  for (const parity::Scene& scene : parity::scenes(true)) {
    if (scene.name == "grains in water") return scene.input;
  }
  throw std::logic_error("no such scene");
}

class FailingDevice : public testing::Test {
 protected:
  void TearDown() override { set_faults({}); }

  const SimulationInput input_ = grains_in_water();
};

/// What a run of `steps` steps says as it fails; empty: nothing.
std::string failure(const SimulationInput& input, int steps) {
  try {
    const auto run = make_simulation(input);
    for (int k = 0; k < steps; ++k) run->step(1.0e3);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::resource);
    return error.what();
  }
  return "";
}

/// Lets runs fail ever later, by `step` more of what `faults` counts, until one comes through; how many failed. Each says `word`
/// and leaves nothing allocated.
int failures(const SimulationInput& input, long Faults::*count, long step, const char* word) {
  { make_simulation(input)->step(1.0e3); }  // scratch that is kept is there now
  const std::size_t before = live_allocations();
  for (int failed = 0;; ++failed) {
    Faults faults;
    faults.*count = step * failed;
    set_faults(faults);
    const std::string said = failure(input, 2);
    set_faults({});
    EXPECT_EQ(live_allocations(), before) << "after " << faults.*count;
    if (said.empty() || testing::Test::HasFailure()) return failed;
    EXPECT_NE(said.find(word), std::string::npos) << said;
  }
}

TEST_F(FailingDevice, says_what_memory_it_lacks_wherever_that_happens) {
  EXPECT_GT(failures(input_, &Faults::allocations, 1, "GPU memory"), 50);
}

TEST_F(FailingDevice, is_lost_wherever_it_waits) { EXPECT_GT(failures(input_, &Faults::waits, 7, "GPU"), 10); }

TEST_F(FailingDevice, goes_on_from_the_checkpoint_before) {
  const auto unbroken = make_simulation(input_);
  for (int k = 0; k < 4; ++k) unbroken->step(1.0e3);

  std::stringstream checkpoint;
  {
    const auto run = make_simulation(input_);
    for (int k = 0; k < 2; ++k) run->step(1.0e3);
    run->save(checkpoint);
    set_faults({-1, 3});
    EXPECT_THROW(
        {
          for (int k = 0; k < 2; ++k) run->step(1.0e3);
        },
        Error);
    std::stringstream late;
    EXPECT_THROW(run->save(late), Error);  // nothing of a lost device is taken for a state
  }
  set_faults({});
  const auto resumed = make_simulation(input_);
  resumed->load(checkpoint);
  for (int k = 0; k < 2; ++k) resumed->step(1.0e3);
  const FluidTable a = unbroken->fluid(), b = resumed->fluid();
  ASSERT_EQ(a.position.size(), b.position.size());
  for (std::size_t i = 0; i < a.position.size(); ++i) ASSERT_EQ(a.position[i], b.position[i]);
}

}  // namespace
}  // namespace gdesp::emulated
