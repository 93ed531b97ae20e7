// SPDX-License-Identifier: GPL-3.0-or-later
// Memory, streams and graphs of the emulated device.
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <map>
#include <memory>
#include <utility>

#include "cuda_runtime.h"
#include "trouble.hpp"

namespace {

using gdesp::emulated::trouble;

struct Work {
  std::string kind;
  std::function<void()> run;
};

// All device memory lies in one stretch of addresses that is used once: what was freed is never given out again.
class Memory {
 public:
  static constexpr std::size_t stretch = std::size_t{1} << 36;

  Memory() {
    void* p = mmap(nullptr, stretch, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (p == MAP_FAILED) trouble("no addresses for device memory", "");
    begin_ = static_cast<char*>(p);
    page_ = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  }
  bool holds(const void* p) const { return p >= begin_ && p < begin_ + stretch; }

  // The end of the allocation, to 16 bytes, is the end of a page; the page behind it is nobody's.
  void* allocate(std::size_t bytes) {
    const std::size_t rounded = (std::max<std::size_t>(bytes, 1) + 15) / 16 * 16;
    const std::size_t pages = (rounded + page_ - 1) / page_ * page_;
    if (next_ + pages + page_ > stretch) return nullptr;
    char* first_page = begin_ + next_;
    next_ += pages + page_;
    if (mprotect(first_page, pages, PROT_READ | PROT_WRITE) != 0) return nullptr;
    char* data = first_page + pages - rounded;
    std::memset(data, 0xff, rounded);
    blocks_[data] = {first_page, pages, bytes};
    if (!open_) mprotect(first_page, pages, PROT_NONE);
    return data;
  }
  bool release(void* data) {
    const auto found = blocks_.find(static_cast<char*>(data));
    if (found == blocks_.end()) return false;
    mprotect(found->second.first_page, found->second.pages, PROT_NONE);
    madvise(found->second.first_page, found->second.pages, MADV_DONTNEED);
    blocks_.erase(found);
    return true;
  }
  /// Whether [data, data + bytes) lies in one allocation.
  bool within(const void* data, std::size_t bytes) const {
    auto found = blocks_.upper_bound(const_cast<char*>(static_cast<const char*>(data)));
    if (found == blocks_.begin()) return false;
    --found;
    return static_cast<const char*>(data) + bytes <= found->first + found->second.bytes;
  }
  void open(bool yes) {
    open_ = yes;
    for (const auto& [data, block] : blocks_)
      mprotect(block.first_page, block.pages, yes ? PROT_READ | PROT_WRITE : PROT_NONE);
  }
  bool is_open() const { return open_; }
  std::size_t blocks() const { return blocks_.size(); }

 private:
  struct Block {
    char* first_page;
    std::size_t pages, bytes;
  };
  char* begin_ = nullptr;
  std::size_t page_ = 0, next_ = 0;
  bool open_ = false;
  std::map<char*, Block> blocks_;
};

Memory& memory() {
  static Memory all;
  return all;
}
std::string at_work;  // what the device does now

void on_fault(int, siginfo_t* info, void*) {
  if (!memory().holds(info->si_addr)) {
    trouble("an address that is nobody's is touched", at_work);
  } else if (memory().is_open()) {
    trouble("device memory is touched beyond an allocation, or after it was freed", at_work);
  }
  trouble("the host touches device memory", "");
}

void watch_faults() {
  // On a stack of its own: a lane may have used up its.
  static std::array<char, 1 << 16> stack;
  stack_t own{};
  own.ss_sp = stack.data();
  own.ss_size = stack.size();
  sigaltstack(&own, nullptr);
  struct sigaction action {};
  action.sa_sigaction = on_fault;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK;
  sigaction(SIGSEGV, &action, nullptr);
}

// Work of a run has its place on the run's stream; on none it would wait for nothing.
void need(cudaStream_t stream, const char* call) {
  if (!stream) trouble("work is given to no stream", call);
}

gdesp::emulated::Faults faults;
bool lost = false;

cudaError_t last_error = cudaSuccess;
cudaError_t ended_with(cudaError_t code) {
  if (lost) code = cudaErrorLaunchFailure;
  if (code != cudaSuccess) last_error = code;
  return code;
}

}  // namespace

struct EmulatedGraph {
  std::vector<Work> work;
};
struct EmulatedGraphExec : EmulatedGraph {};
struct EmulatedStream {
  std::deque<Work> waiting;
  std::unique_ptr<EmulatedGraph> captured;  // while a batch is captured

  void finish() {
    if (lost) waiting.clear();
    if (waiting.empty()) return;
    memory().open(true);
    while (!waiting.empty()) {
      const Work work = std::move(waiting.front());
      waiting.pop_front();
      at_work = work.kind;
      work.run();
    }
    at_work.clear();
    memory().open(false);
  }
};

namespace {
std::vector<EmulatedStream*>& streams() {
  static std::vector<EmulatedStream*> all;
  return all;
}
}  // namespace

namespace gdesp::emulated {

void trouble(const std::string& what, const std::string& kernel) {
  std::fprintf(stderr, "emulated device: %s%s\n", what.c_str(), kernel.empty() ? "" : (" (in " + kernel + ")").c_str());
  std::_Exit(1);
}

void set_faults(const Faults& wanted) {
  faults = wanted;
  lost = false;
}

std::size_t live_allocations() { return memory().blocks(); }

std::string kernel_name(const std::string& pretty_function) {
  const std::string mark = "Parameters = {";
  std::size_t begin = pretty_function.find(mark);
  if (begin == std::string::npos) return pretty_function;
  begin += mark.size();
  std::size_t end = begin;
  for (int depth = 0; end < pretty_function.size(); ++end) {
    const char c = pretty_function[end];
    if (depth == 0 && (c == ',' || c == '}')) break;
    if (c == '<' || c == '(' || c == '{') ++depth;
    if (c == '>' || c == ')' || c == '}') --depth;
  }
  return pretty_function.substr(begin, end - begin);
}

void refuse_host_addresses(const std::string& kernel, const void* argument, std::size_t bytes) {
  std::vector<std::pair<std::uintptr_t, std::uintptr_t>> mapped;  // what the host can touch
  for (std::size_t at = 0; at + sizeof(std::uintptr_t) <= bytes; at += sizeof(std::uintptr_t)) {
    std::uintptr_t word;
    std::memcpy(&word, static_cast<const char*>(argument) + at, sizeof(word));
    // A user's addresses, seen as a double, are subnormal; other numbers of an argument hardly look like one.
    if (word >> 47 != 0 || word >> 32 == 0 || memory().holds(reinterpret_cast<const void*>(word))) continue;
    if (mapped.empty()) {
      std::ifstream maps("/proc/self/maps");
      for (std::string line; std::getline(maps, line);) {
        std::uintptr_t first = 0, last = 0;
        if (std::sscanf(line.c_str(), "%lx-%lx", &first, &last) == 2) mapped.emplace_back(first, last);
      }
    }
    for (const auto& [first, last] : mapped) {
      if (word >= first && word < last)
        trouble("a kernel is given an address of the host, at byte " + std::to_string(at), kernel);
    }
  }
}

}  // namespace gdesp::emulated

const char* cudaGetErrorString(cudaError_t code) {
  switch (code) {
    case cudaSuccess:
      return "no error";
    case cudaErrorMemoryAllocation:
      return "out of memory";
    case cudaErrorLaunchFailure:
      return "unspecified launch failure";
    case cudaErrorStreamCaptureUnsupported:
      return "operation not permitted when stream is capturing";
    case cudaErrorGraphExecUpdateFailure:
      return "the graph update was not performed";
  }
  return "unknown error";
}
cudaError_t cudaGetLastError() { return std::exchange(last_error, cudaSuccess); }

cudaError_t cudaGetDeviceCount(int* count) {
  *count = 1;
  return cudaSuccess;
}
cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int) {
  *properties = {"emulated on the processor", std::size_t{8} << 30, 9, 0};
  return cudaSuccess;
}
cudaError_t cudaSetDevice(int) {
  watch_faults();
  return cudaSuccess;
}

cudaError_t cudaMalloc(void** data, std::size_t bytes) {
  const bool fails = faults.allocations == 0;
  if (faults.allocations > 0) --faults.allocations;
  *data = fails || lost ? nullptr : memory().allocate(bytes);
  return ended_with(*data ? cudaSuccess : cudaErrorMemoryAllocation);
}
// As on a device, work that was given before is done first.
cudaError_t cudaFree(void* data) {
  for (EmulatedStream* stream : streams()) stream->finish();
  if (data && !memory().release(data)) trouble("memory is freed that was not allocated", "");
  return ended_with(cudaSuccess);
}
cudaError_t cudaMemGetInfo(std::size_t* free_bytes, std::size_t* total_bytes) {
  *free_bytes = *total_bytes = std::size_t{8} << 30;
  return cudaSuccess;
}

cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned) {
  *stream = streams().emplace_back(new EmulatedStream);
  return cudaSuccess;
}
cudaError_t cudaStreamSynchronize(cudaStream_t stream) {
  need(stream, "cudaStreamSynchronize");
  if (stream->captured) return ended_with(cudaErrorStreamCaptureUnsupported);
  lost = lost || faults.waits == 0;
  if (faults.waits > 0) --faults.waits;
  stream->finish();
  return ended_with(cudaSuccess);
}
cudaError_t emulated_give(cudaStream_t stream, const std::string& kind, std::function<void()> work) {
  need(stream, kind.c_str());
  if (stream->captured) {
    stream->captured->work.push_back({kind, std::move(work)});
  } else {
    stream->waiting.push_back({kind, std::move(work)});
  }
  return ended_with(cudaSuccess);
}
cudaError_t cudaMemsetAsync(void* data, int value, std::size_t bytes, cudaStream_t stream) {
  if (bytes > 0 && !memory().within(data, bytes)) trouble("memory is filled beyond an allocation", "cudaMemsetAsync");
  return emulated_give(stream, "cudaMemsetAsync", [=] { std::memset(data, value, bytes); });
}
cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind, cudaStream_t stream) {
  need(stream, "cudaMemcpyAsync");
  if (stream->captured) return ended_with(cudaErrorStreamCaptureUnsupported);
  const bool reads = kind == cudaMemcpyDeviceToHost;
  if (!memory().within(reads ? from : to, bytes) || memory().holds(reads ? to : from)) {
    trouble("a copy beyond an allocation, or in the other direction", "cudaMemcpyAsync");
  }
  return emulated_give(stream, "cudaMemcpyAsync", [=] { std::memcpy(to, from, bytes); });
}

cudaError_t cudaStreamBeginCapture(cudaStream_t stream, cudaStreamCaptureMode) {
  stream->captured = std::make_unique<EmulatedGraph>();
  return ended_with(cudaSuccess);
}
cudaError_t cudaStreamEndCapture(cudaStream_t stream, cudaGraph_t* graph) {
  *graph = stream->captured.release();
  return ended_with(cudaSuccess);
}
cudaError_t cudaGraphInstantiate(cudaGraphExec_t* made, cudaGraph_t graph, unsigned long long) {
  *made = new EmulatedGraphExec{*graph};
  return cudaSuccess;
}
cudaError_t cudaGraphExecUpdate(cudaGraphExec_t made, cudaGraph_t graph, cudaGraphExecUpdateResultInfo* result) {
  const bool alike = std::equal(made->work.begin(), made->work.end(), graph->work.begin(), graph->work.end(),
                                [](const Work& a, const Work& b) { return a.kind == b.kind; });
  result->result = alike ? 0 : 1;
  if (!alike) return ended_with(cudaErrorGraphExecUpdateFailure);
  made->work = graph->work;
  return cudaSuccess;
}
cudaError_t cudaGraphLaunch(cudaGraphExec_t made, cudaStream_t stream) {
  for (const Work& work : made->work) stream->waiting.push_back(work);
  return ended_with(cudaSuccess);
}
cudaError_t cudaGraphDestroy(cudaGraph_t graph) {
  delete graph;
  return cudaSuccess;
}
cudaError_t cudaGraphExecDestroy(cudaGraphExec_t made) {
  delete made;
  return cudaSuccess;
}
