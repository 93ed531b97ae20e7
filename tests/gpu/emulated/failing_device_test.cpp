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
  void TearDown() override { let_fail(-1, -1); }

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

TEST_F(FailingDevice, says_what_memory_it_lacks_wherever_that_happens) {
  { make_simulation(input_)->step(1.0e3); }  // scratch that is kept is there now
  const std::size_t before = allocations();
  int failed = 0;
  for (long allowed = 0; allowed < 1000; ++allowed) {
    let_fail(allowed, -1);
    const std::string said = failure(input_, 2);
    let_fail(-1, -1);
    ASSERT_EQ(allocations(), before) << "after " << allowed << " allocations";
    if (said.empty()) break;
    ASSERT_NE(said.find("GPU memory"), std::string::npos) << said;
    ++failed;
  }
  EXPECT_GT(failed, 50);
}

TEST_F(FailingDevice, is_lost_wherever_it_waits) {
  { make_simulation(input_)->step(1.0e3); }
  const std::size_t before = allocations();
  int failed = 0;
  for (long waits = 0; waits < 10000; waits += 7) {
    let_fail(-1, waits);
    const std::string said = failure(input_, 2);
    let_fail(-1, -1);
    ASSERT_EQ(allocations(), before) << "after " << waits << " waits";
    if (said.empty()) break;
    ASSERT_NE(said.find("GPU"), std::string::npos) << said;
    ++failed;
  }
  EXPECT_GT(failed, 10);
}

TEST_F(FailingDevice, goes_on_from_the_checkpoint_before) {
  const auto unbroken = make_simulation(input_);
  for (int k = 0; k < 4; ++k) unbroken->step(1.0e3);

  std::stringstream checkpoint;
  {
    const auto run = make_simulation(input_);
    for (int k = 0; k < 2; ++k) run->step(1.0e3);
    run->save(checkpoint);
    let_fail(-1, 3);
    EXPECT_THROW(
        {
          for (int k = 0; k < 2; ++k) run->step(1.0e3);
        },
        Error);
    std::stringstream late;
    EXPECT_THROW(run->save(late), Error);  // nothing of a lost device is taken for a state
  }
  let_fail(-1, -1);
  const auto resumed = make_simulation(input_);
  resumed->load(checkpoint);
  for (int k = 0; k < 2; ++k) resumed->step(1.0e3);
  const FluidTable a = unbroken->fluid(), b = resumed->fluid();
  ASSERT_EQ(a.position.size(), b.position.size());
  for (std::size_t i = 0; i < a.position.size(); ++i) ASSERT_EQ(a.position[i], b.position[i]);
}

}  // namespace
}  // namespace gdesp::emulated
