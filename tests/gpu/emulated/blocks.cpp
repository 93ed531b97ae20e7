// SPDX-License-Identifier: GPL-3.0-or-later
// The threads of a block as stacks between which one thread of the processor goes back and forth.
#include <setjmp.h>
#include <sys/mman.h>
#include <ucontext.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <memory>
#include <numeric>

#include "device.hpp"
#include "trouble.hpp"

namespace gdesp::emulated {

ThreadPlace place;

namespace {

constexpr unsigned warp_size = 32;
constexpr std::size_t stack_bytes = std::size_t{512} << 10;

enum class Doing { idle, ready, meets, at_barrier };

struct Thread {
  Doing doing = Doing::idle;
  Meeting meeting = Meeting::sync;
  unsigned mask = 0, brought = 0;
  std::array<unsigned, warp_size> seen{};
  jmp_buf here{};
  ucontext_t start{};
  bool born = false;
};

class Block {
 public:
  static Block& instance() {
    static Block block;
    return block;
  }

  static std::uint64_t random_number() {
    static std::uint64_t state = 0x9e3779b97f4a7c15u;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return state;
  }

  void run(const std::string& kernel, const std::function<void()>& body, unsigned threads) {
    kernel_ = &kernel;
    body_ = &body;
    while (thread_.size() < threads) thread_.push_back(std::make_unique<Thread>());
    count_ = threads;
    order_.resize(threads);
    std::iota(order_.begin(), order_.end(), 0u);
    for (unsigned k = 0; k < threads; ++k) thread_[k]->doing = Doing::ready;
    unsigned left = threads;
    while (left > 0) {
      shuffle();
      bool moved = false;
      for (const unsigned k : order_) {
        if (thread_[k]->doing != Doing::ready) continue;
        go_on_with(k);
        moved = true;
        if (thread_[k]->doing == Doing::idle) --left;
      }
      const bool met = let_meet();
      if (!let_pass_barrier(left) && !met && !moved) stuck();
    }
  }

  const unsigned* meet(Meeting kind, unsigned mask, unsigned brought) {
    Thread& me = *thread_[running_];
    const unsigned lane = running_ % warp_size;
    if (!((mask >> lane) & 1u))
      trouble("lane " + std::to_string(lane) + " meets others and is not of the mask", *kernel_);
    me.doing = Doing::meets;
    me.meeting = kind;
    me.mask = mask;
    me.brought = brought;
    back_to_scheduler(me);
    return me.seen.data();
  }

  void meet_block() {
    thread_[running_]->doing = Doing::at_barrier;
    back_to_scheduler(*thread_[running_]);
  }

 private:
  static void live(unsigned number) { instance().lives_of(number); }

  [[noreturn]] void lives_of(unsigned number) {
    Thread& me = *thread_[number];
    while (true) {
      (*body_)();
      me.doing = Doing::idle;
      back_to_scheduler(me);
    }
  }

  void back_to_scheduler(Thread& from) {
    if (_setjmp(from.here) == 0) _longjmp(scheduler_, 1);
  }

  void go_on_with(unsigned number) {
    Thread& thread = *thread_[number];
    running_ = number;
    place.thread.x = number;
    if (_setjmp(scheduler_) != 0) return;
    if (thread.born) _longjmp(thread.here, 1);
    thread.born = true;
    getcontext(&thread.start);
    void* stack = mmap(nullptr, stack_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (stack == MAP_FAILED) trouble("no memory for the stack of a thread", *kernel_);
    thread.start.uc_stack.ss_sp = stack;
    thread.start.uc_stack.ss_size = stack_bytes;
    thread.start.uc_link = nullptr;
    makecontext(&thread.start, reinterpret_cast<void (*)()>(&Block::live), 1, number);
    setcontext(&thread.start);
  }

  // Lets go on all lanes whose whole mask has come to the same meeting.
  bool let_meet() {
    bool any = false;
    for (unsigned first = 0; first < count_; ++first) {
      if (thread_[first]->doing != Doing::meets || !all_came(first)) continue;
      std::array<unsigned, warp_size> seen{};
      const unsigned base = first / warp_size * warp_size, mask = thread_[first]->mask;
      for (unsigned lane = 0; lane < warp_size; ++lane) seen[lane] = thread_[base + lane]->brought;
      for (unsigned lane = 0; lane < warp_size; ++lane) {
        if (!((mask >> lane) & 1u)) continue;
        thread_[base + lane]->seen = seen;
        thread_[base + lane]->doing = Doing::ready;
      }
      any = true;
    }
    return any;
  }

  bool all_came(unsigned first) const {
    const unsigned base = first / warp_size * warp_size;
    const Thread& one = *thread_[first];
    for (unsigned lane = 0; lane < warp_size; ++lane) {
      if (!((one.mask >> lane) & 1u)) continue;
      const Thread& other = *thread_[base + lane];
      if (other.doing != Doing::meets || other.mask != one.mask || other.meeting != one.meeting) return false;
    }
    return true;
  }

  // `left`: threads that have not ended. As on a device, those that have do not hold up the others.
  bool let_pass_barrier(unsigned left) {
    const auto waits = [&](unsigned k) { return thread_[k]->doing == Doing::at_barrier; };
    if (left == 0 || std::count_if(order_.begin(), order_.end(), waits) != left) return false;
    for (const unsigned k : order_) {
      if (waits(k)) thread_[k]->doing = Doing::ready;
    }
    return true;
  }

  [[noreturn]] void stuck() const {
    std::string all;
    for (unsigned k = 0; k < count_; ++k) {
      if (k > 0 && k % warp_size == 0) all += ' ';
      const Thread& thread = *thread_[k];
      all += thread.doing == Doing::idle         ? '-'
             : thread.doing == Doing::at_barrier ? 'b'
                                                 : "sxv"[static_cast<int>(thread.meeting)];
    }
    trouble(
        "threads wait for each other at different places (s, x, v: at a sync of lanes, an exchange, a vote; b: at a "
        "barrier; -: ended): " +
            all,
        *kernel_);
  }

  void shuffle() {
    for (std::size_t k = order_.size() - 1; k > 0; --k) std::swap(order_[k], order_[random_number() % (k + 1)]);
  }

  std::vector<std::unique_ptr<Thread>> thread_;
  std::vector<unsigned> order_;
  jmp_buf scheduler_{};
  unsigned running_ = 0, count_ = 0;
  const std::string* kernel_ = nullptr;
  const std::function<void()>* body_ = nullptr;
};

std::map<std::string, long>& counts() {
  static std::map<std::string, long> table;
  return table;
}

}  // namespace

void run_kernel(const std::string& name, unsigned blocks, unsigned threads, const std::function<void()>& body) {
  if (threads % warp_size != 0 || threads > 1024) trouble("blocks of " + std::to_string(threads) + " threads", name);
  ++counts()[name];
  place.threads = {threads, 1, 1};
  const std::uint64_t turn = Block::random_number() % blocks;
  const bool backwards = (Block::random_number() & 1u) != 0;
  for (std::uint64_t k = 0; k < blocks; ++k) {
    const std::uint64_t block = (k + turn) % blocks;
    place.block.x = static_cast<unsigned>(backwards ? blocks - 1 - block : block);
    Block::instance().run(name, body, threads);
  }
}

const unsigned* meet(Meeting kind, unsigned mask, unsigned brought) {
  return Block::instance().meet(kind, mask, brought);
}

void meet_block() { Block::instance().meet_block(); }

unsigned of_lane(const unsigned* all, unsigned mask, int lane) {
  if (!((mask >> lane) & 1u))
    trouble("lane " + std::to_string(lane) + " is asked for what it has and is not of the mask", "");
  return all[lane];
}

std::vector<std::pair<std::string, long>> work_done() { return {counts().begin(), counts().end()}; }

}  // namespace gdesp::emulated
