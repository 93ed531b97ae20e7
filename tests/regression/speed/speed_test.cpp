// SPDX-License-Identifier: GPL-3.0-or-later
// Speed as a ratio of two code paths that run in turn, so that the load of the machine touches both: compilers have
// silently made loops of lanes seven times slower (a failed store forwarding) and seventeen times (no vectors at all).
#include <gtest/gtest.h>

#include "bench/bench.hpp"
#include "bench/hand_written_pass.hpp"
#include "dem/contact_force.hpp"

namespace gdesp {
namespace {

#if defined(__AVX512F__)
constexpr double least_gain = 4.0;  // of sixteen lanes; 7.5 measured
#elif defined(__AVX2__)
constexpr double least_gain = 2.5;
#endif

sph::FluidSystem<exec::OpenMP> block_of_water(int n) {
  const double dp = 0.01;
  FluidTable table;
  bench::Random random;
  const auto jitter = [&] { return 0.3 * dp * (random() - 0.5); };
  for (int i = 0; i < n * n * n; ++i) {
    const auto at = [&](int k) { return (k + 0.5) * dp + jitter(); };
    table.position.push_back({at(i % n), at(i / n % n), at(i / (n * n))});
    table.velocity.push_back(
        {static_cast<float>(jitter()), static_cast<float>(jitter()), static_cast<float>(jitter())});
    table.density.push_back(1000.0f);
  }
  const bool periodic[3] = {false, false, false};
  sph::FluidParameters parameters;
  parameters.dp = dp;
  parameters.h = 1.3 * dp;
  parameters.sound_speed = 40.0;
  parameters.skin = 0.1 * parameters.h;
  return {{},
          make_domain({-0.1, -0.1, -0.1}, {n * dp + 0.1, n * dp + 0.1, n * dp + 0.1}, dp, periodic, 3),
          parameters,
          table,
          {}};
}

TEST(Speed, fluid_pass_is_several_times_faster_than_pair_by_pair) {
#if defined(__AVX2__)
  exec::set_threads(1);
  auto fluid = block_of_water(22);
  const exec::Index clusters = fluid.set().clusters();
  std::vector<float> rate(16 * static_cast<std::size_t>(clusters));
  const bench::ScalarPass scalar{bench::plain_pass(fluid, rate.data())};
  double lanes = 1e30, one = 1e30;
  for (int k = 0; k < 12; ++k) {
    lanes = std::min(lanes, bench::seconds_of([&] { fluid.combined_pass(); }));
    one = std::min(one, bench::seconds_of([&] { bench::run_plain(scalar, clusters); }));
  }
  EXPECT_LT(bench::largest_difference(fluid.rates(), rate.data(), clusters), 1.0e-5);
  EXPECT_GT(one / lanes, least_gain) << "library " << lanes << " s, scalar loop " << one << " s";
#else
  GTEST_SKIP() << "built without AVX2: lanes are not expected to win much";
#endif
}

TEST(Speed, fluid_pass_is_as_fast_as_one_by_intrinsics) {
#if defined(__AVX512F__)
  exec::set_threads(1);
  auto fluid = block_of_water(22);
  const exec::Index clusters = fluid.set().clusters();
  std::vector<float> rate(16 * static_cast<std::size_t>(clusters));
  const bench::HandWrittenPass by_hand{bench::plain_pass(fluid, rate.data())};
  double library = 1e30, loop = 1e30;
  for (int k = 0; k < 40; ++k) {
    library = std::min(library, bench::seconds_of([&] { fluid.combined_pass(); }));
    loop = std::min(loop, bench::seconds_of([&] { bench::run_plain(by_hand, clusters); }));
  }
  EXPECT_LT(bench::largest_difference(fluid.rates(), rate.data(), clusters), 1.0e-5);
  EXPECT_LT(library / loop, 1.25) << "library " << library << " s, loop " << loop << " s";
#else
  GTEST_SKIP() << "the loop by intrinsics is for AVX-512, and this build has none";
#endif
}

// Forces of n contacts by the law, lane type R at a time; the sum keeps the compiler from leaving them out.
template <class R, class Load>
float sum_of_forces(const std::vector<float>& overlap, int lanes, const Load& load) {
  dem::ContactLaws<dem::HertzMindlin> laws{dem::make_hertz_mindlin(1.0e7, 1.0e6, 0.5), 0.5f, 0.0f, 0.0f};
  const dem::HalfSteps half{1.0e-5f, 1.0e-5f};
  R total(0.0f);
  for (std::size_t k = 0; k < overlap.size(); k += static_cast<std::size_t>(lanes)) {
    const R depth = load(&overlap[k]);
    dem::ContactGeometry<R> g{{R(0.0f), R(0.0f), R(1.0f)}, depth, R(0.005f), R(1.0e-3f), {depth, R(0.1f), R(-0.1f)}};
    Vec3<R> history{R(0.01f), depth, R(0.0f)};
    const dem::ContactForce<R> c = dem::contact_force(laws, g, half, history);
    total = total + (c.force.x + c.force.y + c.force.z + history.x);
  }
  if constexpr (std::is_same_v<R, float>)
    return total;
  else
    return exec::HostRowLanes::sum(total);
}

__attribute__((noinline, optimize("no-tree-vectorize", "no-tree-slp-vectorize"))) float one_by_one(
    const std::vector<float>& overlap) {
  return sum_of_forces<float>(overlap, 1, [](const float* p) { return *p; });
}

TEST(Speed, eight_contacts_at_once_are_faster_than_one_by_one) {
#if defined(__AVX2__)
  std::vector<float> overlap(8192);
  bench::Random random;
  for (float& d : overlap) d = static_cast<float>(1.0e-6 + 1.0e-5 * random());
  double lanes = 1e30, one = 1e30;
  float a = 0.0f, b = 0.0f;
  for (int k = 0; k < 60; ++k) {
    lanes = std::min(lanes, bench::seconds_of([&] {
                       a = sum_of_forces<exec::Float8>(overlap, 8,
                                                       [](const float* p) { return exec::HostRowLanes::load(p); });
                     }));
    one = std::min(one, bench::seconds_of([&] { b = one_by_one(overlap); }));
  }
  EXPECT_NEAR(a, b, 1.0e-3f * std::abs(b));
  EXPECT_GT(one / lanes, 2.5) << "lanes " << lanes << " s, scalars " << one << " s";
#else
  GTEST_SKIP() << "built without AVX2: lanes are not expected to win much";
#endif
}

}  // namespace
}  // namespace gdesp
