// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "core/error.hpp"
#include "exec/batch.hpp"
#include "exec/parallel.hpp"

namespace gdesp::exec {
namespace {

const OpenMP cpu;

struct Value {
  const float* from;
  float operator()(Index i) const { return from[i]; }
};
struct Add {
  float operator()(float a, float b) const { return a + b; }
};

TEST(Reduce, is_the_same_for_any_number_of_threads) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  std::vector<float> host(100'003);
  for (float& x : host) x = uniform(random);
  std::vector<float> sums;
  for (int threads : {1, 2, 3, 7}) {
    set_threads(threads);
    sums.push_back(reduce(cpu, "test", static_cast<Index>(host.size()), 0.0f, Value{host.data()}, Add{}));
  }
  for (float sum : sums) EXPECT_EQ(sum, sums.front());
  EXPECT_NEAR(sums.front(), std::accumulate(host.begin(), host.end(), 0.0), 0.05);
}

TEST(Reduce, of_nothing_is_the_start) { EXPECT_EQ(reduce(cpu, "test", 0, 5.0f, Value{nullptr}, Add{}), 5.0f); }

TEST(ExclusiveScan, agrees_with_partial_sum) {
  for (Index n : {0, 1, 17, 4097, 50'000}) {
    std::vector<Index> in(static_cast<std::size_t>(n)), out(in.size() + 1);
    for (std::size_t i = 0; i < in.size(); ++i) in[i] = static_cast<Index>(i * 7 % 5);
    const Index total = exclusive_scan(cpu, "test", in.data(), out.data(), n);
    Index expected = 0;
    for (std::size_t i = 0; i < in.size(); ++i) {
      ASSERT_EQ(out[i], expected);
      expected += in[i];
    }
    EXPECT_EQ(out.back(), expected);
    EXPECT_EQ(total, expected);
  }
}

TEST(SortPairs, is_a_stable_sort_of_the_given_bits) {
  std::mt19937_64 random(11);
  for (std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{1000}, std::size_t{70'001}}) {
    std::vector<std::uint64_t> key(n);
    std::vector<Index> value(n);
    for (std::size_t i = 0; i < n; ++i) {
      key[i] = random() & 0x7fff'ffffu;
      if (i % 3 == 0) key[i] = key[i / 2];
      value[i] = static_cast<Index>(i);
    }
    std::vector<std::uint64_t> keys = key, other_keys(n);
    std::vector<Index> values = value, other_values(n);
    SortedPairs pairs{keys.data(), values.data(), other_keys.data(), other_values.data()};
    sort_pairs(cpu, "test", pairs, static_cast<Index>(n), 31);
    std::stable_sort(value.begin(), value.end(), [&](Index a, Index b) {
      return key[static_cast<std::size_t>(a)] < key[static_cast<std::size_t>(b)];
    });
    EXPECT_EQ(std::vector<Index>(pairs.values, pairs.values + n), value);
    for (std::size_t k = 0; k < n; ++k) ASSERT_EQ(pairs.keys[k], key[static_cast<std::size_t>(value[k])]);
  }
}

TEST(Lanes, four_i_and_four_j_make_sixteen_pairs) {
  const float i[4] = {1, 2, 3, 4}, j[4] = {10, 20, 30, 40};
  float sum[4], largest[4];
  const Float16 product = HostLanes::load_i(i) * HostLanes::load_j(j);
  HostLanes::store_sum_i(sum, product);
  HostLanes::store_max_i(largest, product);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(sum[k], 100.0f * i[k]);
    EXPECT_EQ(largest[k], 40.0f * i[k]);
  }
  EXPECT_TRUE(HostLanes::any(product > Float16(159.0f)));
  EXPECT_FALSE(HostLanes::any(product > Float16(160.0f)));
}

TEST(Batch, does_what_it_is_given_once_and_passes_errors_on) {
  Batch<OpenMP> batch(cpu);
  int done = 0;
  for (int k = 0; k < 3; ++k) batch.give([&] { ++done; });
  EXPECT_EQ(done, 3);
  EXPECT_THROW(batch.give([] { throw Error(ErrorKind::numerical, "in the middle"); }), Error);
  batch.give([&] { ++done; });
  EXPECT_EQ(done, 4);
}

TEST(Array, counts_its_memory) {
  const std::size_t before = allocated_bytes();
  {
    Array<double, OpenMP> array;
    array.resize_discard(1000);
    EXPECT_GE(allocated_bytes(), before + 8000);
  }
  EXPECT_EQ(allocated_bytes(), before);
}

TEST(Lanes, roots_and_reciprocals_err_by_a_unit_in_the_last_place) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> exponent(-30.0, 30.0);
  constexpr double unit = 1.2e-7;
  for (int k = 0; k < 20'000; ++k) {
    const auto a = static_cast<float>(std::pow(10.0, exponent(random)));
    const double x = static_cast<double>(a);
    const Float16 wide(a);
    const Float8 row(a);
    ASSERT_NEAR(static_cast<double>(sqrt(wide).v[k % 16]) / std::sqrt(x), 1.0, unit) << a;
    ASSERT_NEAR(static_cast<double>(reciprocal(wide).v[k % 16]) * x, 1.0, unit) << a;
    ASSERT_NEAR(static_cast<double>(sqrt(row).v[k % 8]) / std::sqrt(x), 1.0, unit) << a;
    ASSERT_NEAR(static_cast<double>(inverse_sqrt(row).v[k % 8]) * std::sqrt(x), 1.0, unit) << a;
  }
  EXPECT_EQ(sqrt(Float16(0.0f)).v[3], 0.0f);
}

TEST(Lanes, choose_and_compare_lane_by_lane) {
  Float16 a(0.0f), b(7.5f);
  Float8 c(0.0f), d(3.5f);
  for (int k = 0; k < 16; ++k) a.v[k] = static_cast<float>(k);
  for (int k = 0; k < 8; ++k) c.v[k] = static_cast<float>(k);
  EXPECT_EQ(HostLanes::bits(a < b), 0x00ffu);
  EXPECT_EQ(HostLanes::bits(a > b), 0xff00u);
  EXPECT_TRUE(HostLanes::any(a > Float16(14.5f)));
  EXPECT_FALSE(HostLanes::any(a > Float16(15.5f)));
  EXPECT_TRUE(HostRowLanes::any(c < d));
  EXPECT_FALSE(HostRowLanes::any(c < Float8(-1.0f)));
  const Float16 low = select(a < b, a, b), least = min(a, b), most = max(a, b);
  const Float8 low_row = select(c < d, c, d);
  for (int k = 0; k < 16; ++k) {
    EXPECT_EQ(low.v[k], k < 8 ? static_cast<float>(k) : 7.5f);
    EXPECT_EQ(least.v[k], low.v[k]);
    EXPECT_EQ(most.v[k], k < 8 ? 7.5f : static_cast<float>(k));
  }
  for (int k = 0; k < 8; ++k) EXPECT_EQ(low_row.v[k], k < 4 ? static_cast<float>(k) : 3.5f);
}

}  // namespace
}  // namespace gdesp::exec
