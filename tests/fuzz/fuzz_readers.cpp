// SPDX-License-Identifier: GPL-3.0-or-later
// Feeds damaged inputs to every reader and counts how they end: read, refused with a message, or a finding (a crash, a hang,
// memory out of proportion, an exception that is no gdesp::Error, a refusal without a word). Works with any compiler; findings
// show best in the preset cpu-asan. The inputs are a function of --first and --inputs alone, so each can be made again.
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <new>

#include "cli/cli.hpp"
#include "core/error.hpp"
#include "mutator.hpp"
#include "target.hpp"

#if defined(__SANITIZE_ADDRESS__)
extern "C" const char* __asan_default_options() {
  return "max_allocation_size_mb=3000:detect_leaks=0:allocator_may_return_null=0";
}
#endif

namespace gdesp::fuzz {
namespace {

namespace fs = std::filesystem;
constexpr unsigned longest_seconds = 60;  // of one input

struct Options {
  std::string corpus, keep = "fuzz-findings", only;
  std::uint64_t inputs = 1000, first = 0;
  double seconds = 1e9;
};

/// Counts that survive the worker.
struct Tally {
  std::uint64_t next = 0, read = 0, refused = 0, contained = 0, findings = 0;
};

struct Seeds {
  std::vector<std::string> name, bytes;
};

Seeds seeds_of(const Target& target, const std::string& corpus, const std::string& scratch) {
  std::map<std::string, std::string> sorted;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(fs::path(corpus) / target.name, none)) {
    std::ifstream in(entry.path(), std::ios::binary);
    sorted[entry.path().filename().string()] = {std::istreambuf_iterator<char>(in), {}};
  }
  if (target.seeds)
    for (auto& [name, bytes] : target.seeds(scratch)) sorted[name] = std::move(bytes);
  Seeds out;
  for (auto& [name, bytes] : sorted) out.name.push_back(name), out.bytes.push_back(std::move(bytes));
  return out;
}

void write_file(const std::string& path, const std::string& bytes) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file || std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size()) std::perror(path.c_str());
  if (file) std::fclose(file);
}

/// Reads one input; "" or what was wrong with how it ended.
std::string try_one(const Target& target, const std::string& bytes, const std::string& path, Tally& tally) {
  try {
    target.read(bytes, path);
    ++tally.read;
    return "";
  } catch (const Error& e) {
    const std::string message = e.what();
    if (message.size() < 5) return "an error without a message";
    ++tally.refused;
    if (message.find("crashed (signal") != std::string::npos) ++tally.contained;
    return "";
  } catch (const std::bad_alloc&) { return "memory out of proportion"; } catch (const std::exception& e) {
    return std::string("an exception that is no gdesp::Error: ") + e.what();
  }
}

std::string name_of(const Target& target, std::uint64_t index, const std::string& seed) {
  return std::string(target.name) + "-" + std::to_string(index) + "-" + seed;
}

/// Works through the inputs from tally.next on; ends early at the time limit.
void work(const Target& target, const Seeds& seeds, const Options& o, const std::string& scratch, Tally& tally,
          double deadline) {
  const Mutator mutator(seeds.bytes);
  const auto start = std::chrono::steady_clock::now();
  while (tally.next < o.inputs) {
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > deadline) return;
    std::size_t which = 0;
    const std::uint64_t index = o.first + tally.next++;
    const std::string bytes = mutator.variant(index, which), path = scratch + "/" + seeds.name[which];
    write_file(target.needs_file ? path : scratch + "/input", bytes);
    ::alarm(longest_seconds);
    const std::string wrong = try_one(target, bytes, path, tally);
    ::alarm(0);
    if (wrong.empty()) continue;
    ++tally.findings;
    fs::create_directories(o.keep);
    write_file(o.keep + "/" + name_of(target, index, seeds.name[which]), bytes);
    std::fprintf(stderr, "%s: %s\n", name_of(target, index, seeds.name[which]).c_str(), wrong.c_str());
  }
}

void confine() {
#if !defined(__SANITIZE_ADDRESS__)
  const rlimit memory{std::size_t{6} << 30, std::size_t{6} << 30};
  ::setrlimit(RLIMIT_AS, &memory);
#endif
  const rlimit core{0, 0}, file{std::size_t{1} << 30, std::size_t{1} << 30};
  ::setrlimit(RLIMIT_CORE, &core);
  ::setrlimit(RLIMIT_FSIZE, &file);
}

/// A worker that dies leaves its last input behind as a finding, and another takes over after it.
Tally run_target(const Target& target, const Options& o, const std::string& scratch, double seconds) {
  const Seeds seeds = seeds_of(target, o.corpus, scratch);
  if (seeds.name.empty()) throw std::runtime_error(o.corpus + "/" + target.name + ": no seeds");
  void* shared = ::mmap(nullptr, sizeof(Tally), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  Tally& tally = *new (shared) Tally;
  const auto start = std::chrono::steady_clock::now();
  const auto left = [&] {
    return seconds - std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  while (tally.next < o.inputs && left() > 0.0) {
    std::fflush(nullptr);
    const pid_t worker = ::fork();
    if (worker == 0) {
      confine();
      work(target, seeds, o, scratch, tally, left());
      std::fflush(nullptr);
      ::_exit(0);
    }
    int status = 0;
    ::waitpid(worker, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) continue;
    ++tally.findings;
    const std::uint64_t index = o.first + tally.next - 1;
    const std::string seed = seeds.name[index % seeds.name.size()], kept = o.keep + "/" + name_of(target, index, seed);
    fs::create_directories(o.keep);
    std::error_code failed;
    fs::copy_file(scratch + "/" + (target.needs_file ? seed : "input"), kept, fs::copy_options::overwrite_existing,
                  failed);
    std::fprintf(stderr, "%s: the reader died (%s %d)\n", kept.c_str(), WIFSIGNALED(status) ? "signal" : "exit",
                 WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
  }
  const Tally out = tally;
  ::munmap(shared, sizeof(Tally));
  return out;
}

/// A folder of its own in the place for temporary files, gone at the end.
struct Scratch {
  std::string path = (fs::temp_directory_path() / ("gdesp-fuzz-" + std::to_string(::getpid()))).string();
  Scratch() { fs::create_directories(path); }
  ~Scratch() {
    std::error_code none;
    fs::remove_all(path, none);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
};

/// Reads one kept input again, without a child process: for the debugger.
int replay(const std::string& file, const std::string& only) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}}, name = fs::path(file).filename().string();
  for (const auto& target : targets()) {
    if (only != target.name) continue;
    const Scratch scratch;
    if (target.seeds) target.seeds(scratch.path);
    const std::string path =
        scratch.path + "/" + name.substr(name.rfind('-') + 1);  // the seed's own name, see name_of()
    write_file(path, bytes);
    Tally tally;
    const std::string wrong = try_one(target, bytes, path, tally);
    std::printf("%s: %s\n", file.c_str(), !wrong.empty() ? wrong.c_str() : (tally.read ? "read" : "refused"));
    return wrong.empty() ? 0 : 1;
  }
  return 2;
}

int run(const Options& o) {
  std::size_t count = 0;
  for (const auto& t : targets()) count += o.only.empty() || o.only == t.name;
  if (count == 0) {
    std::fprintf(stderr, "no target \"%s\"\n", o.only.c_str());
    return 2;
  }
  std::uint64_t all = 0, findings = 0;
  std::printf("target\tinputs\tread\trefused\tof these a library's crash contained\tfindings\tseconds\n");
  for (const auto& target : targets()) {
    if (!o.only.empty() && o.only != target.name) continue;
    const Scratch scratch;
    const auto start = std::chrono::steady_clock::now();
    const Tally t = run_target(target, o, scratch.path, o.seconds / static_cast<double>(count));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("%s\t%llu\t%llu\t%llu\t%llu\t%llu\t%.1f\n", target.name, static_cast<unsigned long long>(t.next),
                static_cast<unsigned long long>(t.read), static_cast<unsigned long long>(t.refused),
                static_cast<unsigned long long>(t.contained), static_cast<unsigned long long>(t.findings), seconds);
    std::fflush(stdout);
    all += t.next;
    findings += t.findings;
  }
  std::printf("%llu inputs, %llu findings%s\n", static_cast<unsigned long long>(all),
              static_cast<unsigned long long>(findings), findings ? (", kept in " + o.keep).c_str() : "");
  return findings ? 1 : 0;
}

}  // namespace
}  // namespace gdesp::fuzz

int main(int argc, char** argv) {
  gdesp::fuzz::Options o;
  std::string again;
  for (int k = 1; k + 1 < argc; k += 2) {
    const std::string key = argv[k], value = argv[k + 1];
    if (key == "--corpus")
      o.corpus = value;
    else if (key == "--target")
      o.only = value;
    else if (key == "--inputs")
      o.inputs = std::stoull(value);
    else if (key == "--first")
      o.first = std::stoull(value);
    else if (key == "--seconds")
      o.seconds = std::stod(value);
    else if (key == "--keep")
      o.keep = value;
    else if (key == "--replay")
      again = value;
    else
      argc = 0;
  }
  if (argc % 2 == 0 || o.corpus.empty()) {
    std::fprintf(stderr,
                 "usage: fuzz_readers --corpus FOLDER [--target NAME] [--inputs N] [--first N] [--seconds S, of all "
                 "targets] [--keep FOLDER] [--replay FILE]\n");
    return 2;
  }
  o.keep = std::filesystem::absolute(o.keep).string();  // a target may change the current folder
  if (!again.empty()) again = std::filesystem::absolute(again).string();
  gdesp::cli::set_verbosity(gdesp::cli::Verbosity::quiet, false);
  try {
    return again.empty() ? gdesp::fuzz::run(o) : gdesp::fuzz::replay(again, o.only);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "fuzz_readers: %s\n", e.what());
    return 2;
  }
}
