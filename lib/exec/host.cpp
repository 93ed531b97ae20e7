// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <new>

#include "core/error.hpp"
#include "exec/parallel.hpp"

namespace gdesp::exec {
namespace {

std::atomic<std::size_t> bytes_now{0};
std::atomic<std::size_t> bytes_peak{0};
bool profiling_on = false;
std::map<std::string, ProfileRow>& rows() {
  static std::map<std::string, ProfileRow> instance;
  return instance;
}

template <class Body>
void for_blocks(std::size_t bytes, const Body& body) {
  constexpr std::size_t block = std::size_t{1} << 20;
  const long blocks = static_cast<long>((bytes + block - 1) / block);
#pragma omp parallel for schedule(static) if (blocks > 4)
  for (long b = 0; b < blocks; ++b) {
    const std::size_t begin = static_cast<std::size_t>(b) * block;
    body(begin, std::min(block, bytes - begin));
  }
}

}  // namespace

std::size_t allocated_bytes() { return bytes_now; }
std::size_t peak_allocated_bytes() { return bytes_peak; }

namespace detail {

void note_allocation(std::size_t bytes) {
  const std::size_t now = bytes_now += bytes;
  std::size_t peak = bytes_peak;
  while (now > peak && !bytes_peak.compare_exchange_weak(peak, now)) {}
}
void note_release(std::size_t bytes) { bytes_now -= bytes; }

void* allocate(const OpenMP&, std::size_t bytes) {
  if (bytes == 0) return nullptr;
  const std::size_t huge_page = std::size_t{1} << 21;
  const std::size_t alignment = bytes >= huge_page ? huge_page : 64;
  void* p = nullptr;
  if (posix_memalign(&p, alignment, bytes) != 0) throw std::bad_alloc();
#if defined(MADV_HUGEPAGE)
  if (bytes >= huge_page) madvise(p, bytes, MADV_HUGEPAGE);
#endif
  fill_bytes(OpenMP{}, p, 0, bytes);
  note_allocation(bytes);
  return p;
}
void release(const OpenMP&, void* p, std::size_t bytes) {
  if (!p) return;
  std::free(p);
  note_release(bytes);
}
void copy_to_host(const OpenMP&, void* to, const void* from, std::size_t bytes) {
  for_blocks(bytes, [=](std::size_t begin, std::size_t size) {
    std::memcpy(static_cast<char*>(to) + begin, static_cast<const char*>(from) + begin, size);
  });
}
void copy_from_host(const OpenMP& exec, void* to, const void* from, std::size_t bytes) {
  copy_to_host(exec, to, from, bytes);
}
void fill_bytes(const OpenMP&, void* p, int value, std::size_t bytes) {
  for_blocks(bytes,
             [=](std::size_t begin, std::size_t size) { std::memset(static_cast<char*>(p) + begin, value, size); });
}

}  // namespace detail

constexpr int most_threads = 1024;  // far more than that, and the OpenMP runtime ends the program without a word

int set_threads(int threads) {
  static const int given = omp_get_max_threads();  // before anybody sets it: OMP_NUM_THREADS, else all cores
  if (threads <= 0) threads = given;
  if (threads > most_threads) {
    throw Error(ErrorKind::usage, std::to_string(threads) + " threads (--threads, OMP_NUM_THREADS): at most " +
                                      std::to_string(most_threads));
  }
  omp_set_num_threads(threads);
  return threads;
}

void wait_briefly(char** argv) {
  if (std::getenv("GOMP_SPINCOUNT") || std::getenv("OMP_WAIT_POLICY")) return;
  if (::setenv("GOMP_SPINCOUNT", "10000", 1) == 0) ::execv("/proc/self/exe", argv);
}

void set_profiling(bool on) { profiling_on = on; }
bool profiling() { return profiling_on; }
void reset_profile() { rows().clear(); }
void add_to_profile(const char* name, double seconds) {
  ProfileRow& row = rows()[name];
  row.name = name;
  row.seconds += seconds;
  row.calls += 1;
}
std::vector<ProfileRow> profile() {
  std::vector<ProfileRow> result;
  for (const auto& entry : rows()) result.push_back(entry.second);
  std::sort(result.begin(), result.end(),
            [](const ProfileRow& a, const ProfileRow& b) { return a.seconds > b.seconds; });
  return result;
}

namespace {

// One stable counting pass of a least-significant-digit radix sort.
struct RadixPass {
  static constexpr int digit_bits = 11;
  static constexpr std::size_t buckets = std::size_t{1} << digit_bits;

  const std::uint64_t* keys_in;
  const Index* values_in;
  std::uint64_t* keys_out;
  Index* values_out;
  Index count;
  int shift;

  std::size_t digit(std::uint64_t key) const { return (key >> shift) & (buckets - 1); }

  void run(std::vector<Index>& offsets) const {
    const int threads = count > detail::small_loop ? omp_get_max_threads() : 1;
    offsets.assign(buckets * static_cast<std::size_t>(threads), 0);
#pragma omp parallel num_threads(threads)
    {
      const int me = omp_get_thread_num();
      Index* mine = offsets.data() + buckets * static_cast<std::size_t>(me);
      const Index begin = static_cast<Index>(static_cast<long>(count) * me / threads);
      const Index end = static_cast<Index>(static_cast<long>(count) * (me + 1) / threads);
      for (Index i = begin; i < end; ++i) ++mine[digit(keys_in[i])];
#pragma omp barrier
#pragma omp single
      {
        Index running = 0;
        for (std::size_t b = 0; b < buckets; ++b) {
          for (int t = 0; t < threads; ++t) {
            Index& slot = offsets[buckets * static_cast<std::size_t>(t) + b];
            const Index n = slot;
            slot = running;
            running += n;
          }
        }
      }
      for (Index i = begin; i < end; ++i) {
        const Index to = mine[digit(keys_in[i])]++;
        keys_out[to] = keys_in[i];
        values_out[to] = values_in[i];
      }
    }
  }
};

}  // namespace

void sort_pairs(const OpenMP&, const char* name, SortedPairs& pairs, Index count, int bits) {
  const ProfileScope scope(name);
  std::vector<Index> offsets;
  for (int shift = 0; shift < bits; shift += RadixPass::digit_bits) {
    RadixPass{pairs.keys, pairs.values, pairs.other_keys, pairs.other_values, count, shift}.run(offsets);
    std::swap(pairs.keys, pairs.other_keys);
    std::swap(pairs.values, pairs.other_values);
  }
}

#if !defined(GDESP_HAVE_CUDA)
bool cuda_built() { return false; }
std::vector<DeviceInfo> cuda_devices() { return {}; }
Cuda take_cuda_device(int) {
  throw Error(ErrorKind::resource, "this build has no CUDA back end (nvcc was not found when it was configured)");
}
#endif

}  // namespace gdesp::exec
