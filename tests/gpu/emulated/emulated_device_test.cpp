// SPDX-License-Identifier: GPL-3.0-or-later
// The emulated device computes what a device computes, and refuses what would go wrong on one. This file is compiled as device
// code (prelude.hpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "device.hpp"
#include "exec/array.hpp"
#include "exec/batch.hpp"
#include "exec/parallel.hpp"

namespace gdesp::exec {
namespace {

const Cuda& device() {
  static const Cuda taken = take_cuda_device(0);
  return taken;
}
template <class T>
Array<T, Cuda> array(const std::vector<T>& values) {
  Array<T, Cuda> made(device());
  made.assign(values);
  return made;
}

struct Square {
  const int* in;
  int* out;
  void operator()(Index i) const { out[i] = in[i] * in[i]; }
};
struct Value {
  const int* in;
  int operator()(Index i) const { return in[i]; }
};
struct Sum {
  int operator()(int a, int b) const { return a + b; }
};

TEST(EmulatedDevice, loops_sums_and_sorts) {
  const int count = 1000;
  std::vector<int> numbers(count);
  for (int i = 0; i < count; ++i) numbers[static_cast<std::size_t>(i)] = (i * 7) % 100;
  const Array<int, Cuda> in = array(numbers);
  Array<int, Cuda> out = array(std::vector<int>(count + 1));
  parallel_for(device(), "square", count, Square{in.data(), out.data()});
  EXPECT_EQ(out.to_host()[3], 21 * 21);
  EXPECT_EQ(reduce(device(), "sum", count, 5, Value{in.data()}, Sum{}), 5 + 10 * 4950);
  EXPECT_EQ(exclusive_scan(device(), "scan", in.data(), out.data(), count), 10 * 4950);
  EXPECT_EQ(out.to_host()[2], 7);

  std::vector<std::uint64_t> keys(numbers.begin(), numbers.end());
  std::vector<Index> values(count);
  for (Index i = 0; i < count; ++i) values[static_cast<std::size_t>(i)] = i;
  Array<std::uint64_t, Cuda> keys_in = array(keys), keys_out = array(keys);
  Array<Index, Cuda> values_in = array(values), values_out = array(values);
  SortedPairs pairs{keys_in.data(), values_in.data(), keys_out.data(), values_out.data()};
  sort_pairs(device(), "sort", pairs, count, 7);
  const std::vector<Index> order = (pairs.values == values_out.data() ? values_out : values_in).to_host();
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end(), [&](Index a, Index b) {
    const auto at = [&](Index i) { return numbers[static_cast<std::size_t>(i)]; };
    return at(a) != at(b) ? at(a) < at(b) : a < b;
  }));
}

// out: sum over j of (4 i + j), one for each i, and how many lanes had an odd number.
struct SumLanes {
  float* out;
  unsigned* odd;
  template <class Lanes>
  void operator()(Index c, const Lanes& lanes) const {
    lanes.store_sum_i(out + 4 * c, static_cast<float>(lanes.lane + c));
    const unsigned bits = lanes.bits((lanes.lane & 1) == 1);
    if (lanes.leader()) odd[c] = bits;
  }
};
TEST(EmulatedDevice, lanes_meet) {
  Array<float, Cuda> sums = array(std::vector<float>(12));
  Array<unsigned, Cuda> odd = array(std::vector<unsigned>(3));
  pair_pass(device(), "lanes", 3, SumLanes{sums.data(), odd.data()});
  EXPECT_EQ(sums.to_host(), (std::vector<float>{6, 22, 38, 54, 10, 26, 42, 58, 14, 30, 46, 62}));
  EXPECT_EQ(odd.to_host(), (std::vector<unsigned>{0xaaaa, 0xaaaa, 0xaaaa}));
}

struct Ramp {
  Index rows;
  template <class Lanes>
  Largest operator()(Index r, const Lanes&) const {
    const auto up = static_cast<float>(r), down = static_cast<float>(rows - r);
    return {{up, down, r == 37 ? 5.0f : 0.0f, 0.0f}};
  }
};
TEST(EmulatedDevice, largest_of_many_blocks_and_what_a_closed_gate_hands_on) {
  const Index rows = 1000;
  Array<Largest, Cuda> largest = array(std::vector<Largest>(2));
  row_pass(device(), "ramp", rows, Ramp{rows}, Gate{}, largest.data());
  row_pass(device(), "ramp", rows, Ramp{rows}, Gate{largest.data(), 500.0f}, largest.data() + 1);
  for (const Largest& found : largest.to_host()) {
    EXPECT_EQ(found.value[0], 999.0f);
    EXPECT_EQ(found.value[1], 1000.0f);
    EXPECT_EQ(found.value[2], 5.0f);
    EXPECT_EQ(found.value[3], 0.0f);
  }
  row_pass(device(), "ramp", 10, Ramp{10}, Gate{largest.data(), 2000.0f}, largest.data() + 1);
  EXPECT_EQ(largest.to_host()[1].value[0], 9.0f);
}

TEST(EmulatedDevice, work_is_done_when_it_is_waited_for) {
  Array<int, Cuda> out = array(std::vector<int>(10));
  const auto launches = [] {
    long all = 0;
    for (const auto& row : emulated::work_done()) all += row.second;
    return all;
  };
  const long before = launches();
  parallel_for(device(), "square", 10, Square{out.data(), out.data()});
  EXPECT_EQ(launches(), before);
  synchronize(device());
  EXPECT_EQ(launches(), before + 1);
}

// The leader writes what the others read, with or without waiting for it.
template <bool Waits>
struct Tell {
  int* told;
  int* heard;
  template <class Lanes>
  void operator()(Index c, const Lanes& lanes) const {
    if (lanes.leader()) told[c] = 1;
    if (Waits) lanes.share_memory();
    if (lanes.lane == 9) heard[c] = told[c];
  }
};
template <bool Waits>
std::set<int> heard() {
  const std::size_t count = 200;
  Array<int, Cuda> told = array(std::vector<int>(count)), heard = array(std::vector<int>(count));
  pair_pass(device(), "tell", static_cast<Index>(count), Tell<Waits>{told.data(), heard.data()});
  const std::vector<int> all = heard.to_host();
  return {all.begin(), all.end()};
}
TEST(EmulatedDevice, lanes_that_do_not_wait_are_seen_to_differ) {
  EXPECT_EQ(heard<true>(), (std::set<int>{1}));
  EXPECT_EQ(heard<false>(), (std::set<int>{0, 1}));
}

TEST(EmulatedDevice, batches_are_captured_and_taken_again) {
  Array<int, Cuda> numbers = array(std::vector<int>{2, 3});
  Batch<Cuda> batch(device());
  for (int turn = 0; turn < 2; ++turn) {
    batch.give([&] {
      for (int k = 0; k < 2; ++k) parallel_for(device(), "square", 2, Square{numbers.data(), numbers.data()});
    });
  }
  EXPECT_EQ(numbers.to_host(), (std::vector<int>{65536, 43046721}));
  EXPECT_THROW(batch.give([&] { numbers.to_host(); }), Error);
}

void expect_end(const std::function<void()>& trouble, const char* word) {
  EXPECT_EXIT(
      {
        trouble();
        synchronize(device());
      },
      testing::ExitedWithCode(1), word);
}

struct HalfMeet {
  template <class Lanes>
  void operator()(Index, const Lanes& lanes) const {
    if (lanes.lane < 8) lanes.share_memory();
  }
};
TEST(EmulatedDevice, refuses_lanes_that_do_not_all_come) {
  expect_end([] { pair_pass(device(), "half", 1, HalfMeet{}); }, "wait for each other at different places");
}
struct HalfBarrier {
  void operator()(Index i) const {
    if (i < 64) __syncthreads();
    if (i == 64) __syncwarp(1u << 1);
  }
};
TEST(EmulatedDevice, refuses_threads_that_do_not_all_come) {
  expect_end([] { parallel_for(device(), "half", 128, HalfBarrier{}); }, "is not of the mask");
}
TEST(EmulatedDevice, refuses_device_memory_on_the_host) {
  const Array<int, Cuda> numbers = array(std::vector<int>{1});
  expect_end([&] { (void)*static_cast<const volatile int*>(numbers.data()); }, "the host touches device memory");
}
TEST(EmulatedDevice, refuses_host_memory_on_the_device) {
  std::vector<int> host(10);
  Array<int, Cuda> out = array(host);
  expect_end(
      [&] {
        parallel_for(device(), "square", 10, Square{host.data(), out.data()});
      },
      "a kernel is given an address of the host, at byte 0");
}
TEST(EmulatedDevice, refuses_the_end_of_an_array_and_what_was_freed) {
  Array<int, Cuda> out = array(std::vector<int>(8));
  expect_end([&] { parallel_for(device(), "square", 9, Square{out.data(), out.data()}); }, "beyond an allocation");
  expect_end(
      [&] {
        int* gone = out.data();
        out.free();
        parallel_for(device(), "square", 8, Square{gone, gone});
      },
      "after it was freed");
}
TEST(EmulatedDevice, refuses_work_on_no_stream) {
  Array<int, Cuda> out = array(std::vector<int>(8));
  expect_end([&] { parallel_for(Cuda{}, "square", 8, Square{out.data(), out.data()}); }, "no stream");
}

}  // namespace
}  // namespace gdesp::exec
