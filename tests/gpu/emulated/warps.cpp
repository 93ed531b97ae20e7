// SPDX-License-Identifier: GPL-3.0-or-later
// The lanes of a warp as 32 stacks between which one thread of the processor goes back and forth.
#include <setjmp.h>
#include <sys/mman.h>
#include <ucontext.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numeric>

#include "device.hpp"
#include "trouble.hpp"

// Jumps from stack to stack are meant; the checked longjmp would take them for mistakes.
#undef _FORTIFY_SOURCE

namespace gdesp::emulated {

ThreadPlace place;

namespace {

constexpr int warp_size = 32;
constexpr std::size_t stack_bytes = std::size_t{512} << 10;

enum class Doing { idle, ready, waits };

struct Lane {
  Doing doing = Doing::idle;
  Meeting meeting = Meeting::sync;
  unsigned mask = 0, brought = 0;
  std::array<unsigned, warp_size> seen{};
  jmp_buf here{};
  ucontext_t start{};
  bool born = false;
};

class Warp {
 public:
  void run(const std::string& kernel, const std::function<void()>& body, unsigned first_thread) {
    kernel_ = &kernel;
    body_ = &body;
    for (Lane& lane : lanes_) lane.doing = Doing::ready;
    int left = warp_size;
    while (left > 0) {
      shuffle();
      bool moved = false;
      for (const int k : order_) {
        if (lanes_[static_cast<std::size_t>(k)].doing != Doing::ready) continue;
        go_on_with(k, first_thread);
        moved = true;
        if (lanes_[static_cast<std::size_t>(k)].doing == Doing::idle) --left;
      }
      if (!let_meet() && !moved) stuck();
    }
  }

  const unsigned* wait(Meeting kind, unsigned mask, unsigned brought) {
    Lane& lane = lanes_[static_cast<std::size_t>(running_)];
    if (!((mask >> running_) & 1u))
      trouble("lane " + std::to_string(running_) + " meets others and is not of the mask", *kernel_);
    lane.doing = Doing::waits;
    lane.meeting = kind;
    lane.mask = mask;
    lane.brought = brought;
    back_to_scheduler(lane);
    return lane.seen.data();
  }

 private:
  static void live(unsigned number) { instance().lanes_of_life(static_cast<int>(number)); }

  [[noreturn]] void lanes_of_life(int number) {
    Lane& lane = lanes_[static_cast<std::size_t>(number)];
    while (true) {
      (*body_)();
      lane.doing = Doing::idle;
      back_to_scheduler(lane);
    }
  }

  void back_to_scheduler(Lane& lane) {
    if (_setjmp(lane.here) == 0) _longjmp(scheduler_, 1);
  }

  void go_on_with(int number, unsigned first_thread) {
    Lane& lane = lanes_[static_cast<std::size_t>(number)];
    running_ = number;
    place.thread.x = first_thread + static_cast<unsigned>(number);
    if (_setjmp(scheduler_) != 0) return;
    if (lane.born) _longjmp(lane.here, 1);
    lane.born = true;
    getcontext(&lane.start);
    void* stack = mmap(nullptr, stack_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (stack == MAP_FAILED) trouble("no memory for the stack of a lane", *kernel_);
    lane.start.uc_stack.ss_sp = stack;
    lane.start.uc_stack.ss_size = stack_bytes;
    lane.start.uc_link = nullptr;
    makecontext(&lane.start, reinterpret_cast<void (*)()>(&Warp::live), 1, static_cast<unsigned>(number));
    setcontext(&lane.start);
  }

  // Lets go on all lanes whose whole mask has come to the same meeting.
  bool let_meet() {
    bool any = false;
    for (Lane& first : lanes_) {
      if (first.doing != Doing::waits || !all_came(first)) continue;
      std::array<unsigned, warp_size> seen{};
      for (int k = 0; k < warp_size; ++k)
        seen[static_cast<std::size_t>(k)] = lanes_[static_cast<std::size_t>(k)].brought;
      const unsigned mask = first.mask;
      for (int k = 0; k < warp_size; ++k) {
        if (!((mask >> k) & 1u)) continue;
        lanes_[static_cast<std::size_t>(k)].seen = seen;
        lanes_[static_cast<std::size_t>(k)].doing = Doing::ready;
      }
      any = true;
    }
    return any;
  }

  bool all_came(const Lane& first) const {
    for (int k = 0; k < warp_size; ++k) {
      if (!((first.mask >> k) & 1u)) continue;
      const Lane& lane = lanes_[static_cast<std::size_t>(k)];
      if (lane.doing != Doing::waits || lane.mask != first.mask || lane.meeting != first.meeting) return false;
    }
    return true;
  }

  [[noreturn]] void stuck() const {
    std::string lanes;
    for (const Lane& lane : lanes_) {
      lanes += lane.doing == Doing::idle ? '-' : "sxv"[static_cast<int>(lane.meeting)];
    }
    trouble(
        "lanes of a warp wait for each other at different places (s, x, v: at a sync, an exchange, a vote; -: "
        "ended): " +
            lanes,
        *kernel_);
  }

  void shuffle() {
    for (std::size_t k = order_.size() - 1; k > 0; --k) std::swap(order_[k], order_[random_number() % (k + 1)]);
  }

 public:
  static Warp& instance() {
    static Warp warp;
    return warp;
  }
  static std::uint64_t random_number() {
    static std::uint64_t state = 0x9e3779b97f4a7c15u;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return state;
  }

 private:
  Warp() { std::iota(order_.begin(), order_.end(), 0); }

  std::array<Lane, warp_size> lanes_;
  std::array<int, warp_size> order_{};
  jmp_buf scheduler_{};
  int running_ = 0;
  const std::string* kernel_ = nullptr;
  const std::function<void()>* body_ = nullptr;
};

std::map<std::string, long>& counts() {
  static std::map<std::string, long> table;
  return table;
}

}  // namespace

void run_kernel(const std::string& name, unsigned blocks, unsigned threads, const std::function<void()>& body) {
  if (threads % warp_size != 0) trouble("blocks of " + std::to_string(threads) + " threads", name);
  ++counts()[name];
  place.threads = {threads, 1, 1};
  const std::uint64_t turn = Warp::random_number() % blocks;
  const bool backwards = (Warp::random_number() & 1u) != 0;
  for (std::uint64_t k = 0; k < blocks; ++k) {
    const std::uint64_t block = (k + turn) % blocks;
    place.block.x = static_cast<unsigned>(backwards ? blocks - 1 - block : block);
    for (unsigned first = 0; first < threads; first += warp_size) Warp::instance().run(name, body, first);
  }
}

const unsigned* meet(Meeting kind, unsigned mask, unsigned brought) {
  return Warp::instance().wait(kind, mask, brought);
}

unsigned of_lane(const unsigned* all, unsigned mask, int lane) {
  if (!((mask >> lane) & 1u))
    trouble("lane " + std::to_string(lane) + " is asked for what it has and is not of the mask", "");
  return all[lane];
}

std::vector<std::pair<std::string, long>> work_done() { return {counts().begin(), counts().end()}; }

}  // namespace gdesp::emulated
