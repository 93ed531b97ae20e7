// SPDX-License-Identifier: GPL-3.0-or-later
// A device that is emulated on the processor, so that device code can be run, and broken device code seen to break, where there is
// no GPU. It is strict where a GPU is lenient:
// - work given to a stream is done only when somebody waits for it, never before;
// - device memory cannot be touched by the host, nor past the end of an allocation, nor after it was freed;
// - new memory is not zero, and kernels are not given addresses of the host;
// - the threads of a block run one after the other in an order that changes at random, and meet only at barriers and warp
//   primitives; one that is missing there, or comes to another one, ends the program with a word;
// - blocks run in an order that changes at random.
// It says nothing about speed or about the rounding of a GPU's own instructions.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

namespace gdesp::emulated {

struct Index3 {
  unsigned x = 0, y = 0, z = 0;
};
/// Where the running thread stands in its launch.
struct ThreadPlace {
  Index3 thread, block, threads{1, 1, 1};
};
extern ThreadPlace place;
inline int lane() { return static_cast<int>(place.thread.x & 31u); }

/// Runs body() once for each thread of `blocks` blocks of `threads` (a multiple of 32, at most 1024).
void run_kernel(const std::string& name, unsigned blocks, unsigned threads, const std::function<void()>& body);

enum class Meeting { sync, exchange, vote };
/// Waits for all lanes of the mask to come here with the same mask; returns what each of the 32 lanes brought.
const unsigned* meet(Meeting kind, unsigned mask, unsigned brought);
/// Waits for all threads of the block.
void meet_block();
/// What a lane brought to a meeting; it must be one of the mask's.
unsigned of_lane(const unsigned* all, unsigned mask, int lane);

/// From the name of a launch as the compiler spells it: the kernel's body, or the kernel.
std::string kernel_name(const std::string& pretty_function);
/// Ends the program when one of the words of a kernel's argument is an address of the host.
void refuse_host_addresses(const std::string& kernel, const void* argument, std::size_t bytes);
template <class Argument>
void refuse_host_addresses(const std::string& kernel, Argument argument) {
  __builtin_clear_padding(&argument);  // else it holds what lay there before
  refuse_host_addresses(kernel, &argument, sizeof(argument));
}

/// Lets the device fail: the allocation after `allocations` more finds no memory; after `waits` more the device is lost, and every
/// call fails. Negative: never.
struct Faults {
  long allocations = -1, waits = -1;
};
[[gnu::visibility("default")]] void set_faults(const Faults& faults);
/// Allocations that were not freed.
[[gnu::visibility("default")]] std::size_t live_allocations();

/// Kernels and other work done so far, and how often; for a table.
[[gnu::visibility("default")]] std::vector<std::pair<std::string, long>> work_done();

}  // namespace gdesp::emulated
