// SPDX-License-Identifier: GPL-3.0-or-later
#include "checkpoint_files.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <streambuf>
#include <type_traits>
#include <vector>

#include "cli/cli.hpp"
#include "core/error.hpp"
#include "io/safe_file.hpp"

namespace gdesp::tool {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t block_size = std::size_t{1} << 20, kept = 2;
constexpr char file_mark[8] = {'G', 'D', 'E', 'S', 'P', 'C', 'K', '4'};

struct Header {
  char mark[8];
  std::uint64_t fingerprint;
  std::int64_t step;
  double time, wall_seconds;
};
struct Trailer {
  std::uint64_t size, checksum;  // of all that comes before
  char mark[8];
};

/// Writes through a SafeFile, with the checksum taken on the way.
class CheckedOutput : public std::streambuf {
 public:
  explicit CheckedOutput(SafeFile& file) : file_(file), buffer_(block_size) {
    setp(buffer_.data(), buffer_.data() + buffer_.size());
  }
  Trailer finish() {
    write_out();
    Trailer trailer{size_, checksum_.value(), {}};
    std::memcpy(trailer.mark, file_mark, sizeof file_mark);
    return trailer;
  }

 protected:
  int_type overflow(int_type c) override {
    write_out();
    if (!traits_type::eq_int_type(c, traits_type::eof())) {
      *pptr() = traits_type::to_char_type(c);
      pbump(1);
    }
    return traits_type::not_eof(c);
  }

 private:
  void write_out() {
    const auto count = static_cast<std::size_t>(pptr() - pbase());
    checksum_.add(pbase(), count);
    file_.write(pbase(), count);
    size_ += count;
    setp(buffer_.data(), buffer_.data() + buffer_.size());
  }
  SafeFile& file_;
  std::vector<char> buffer_;
  Checksum checksum_;
  std::uint64_t size_ = 0;
};

/// Checkpoint files, newest first.
std::vector<fs::path> list(const std::string& folder) {
  std::vector<fs::path> paths;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".state") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end(), std::greater<>());
  return paths;
}

/// Reads the whole file once; what is wrong with it, or "".
std::string damage(std::ifstream& file, std::uintmax_t size) {
  if (size < sizeof(Header) + sizeof(Trailer)) return "is cut short";
  std::vector<char> block(block_size);
  Checksum checksum;
  std::uint64_t left = size - sizeof(Trailer);
  while (left > 0 && file) {
    const std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(left, block.size()));
    file.read(block.data(), static_cast<std::streamsize>(count));
    checksum.add(block.data(), count);
    left -= count;
  }
  Trailer trailer{};
  file.read(reinterpret_cast<char*>(&trailer), sizeof trailer);
  if (!file) return "cannot be read";
  if (std::memcmp(trailer.mark, file_mark, sizeof file_mark) != 0 || trailer.size != size - sizeof(Trailer))
    return "is cut short";
  return trailer.checksum == checksum.value() ? "" : "is damaged (its checksum does not fit)";
}

template <class T>
void put(std::ostream& out, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  out.write(reinterpret_cast<const char*>(&value), sizeof value);
}
template <class T>
T get(std::istream& in) {
  static_assert(std::is_trivially_copyable_v<T>);
  T value{};
  if (!in.read(reinterpret_cast<char*>(&value), sizeof value))
    throw Error(ErrorKind::input, "a checkpoint ends before what it should hold");
  return value;
}

void put_good_states(std::ostream& out, const std::deque<GoodState>& good) {
  std::size_t bytes = 0;
  for (const GoodState& state : good) bytes += state.bytes.size();
  const bool fit = bytes <= CheckpointFiles::largest_good_states;
  put(out, static_cast<std::uint64_t>(fit ? good.size() : 0));
  if (!fit) return;
  for (const GoodState& state : good) {
    put(out, state.guard);
    put(out, state.step);
    put(out, state.time);
    put(out, static_cast<std::uint64_t>(state.bytes.size()));
    out.write(state.bytes.data(), static_cast<std::streamsize>(state.bytes.size()));
  }
}

/// The checksum has been found right; a file made to fit it may still state any sizes.
std::size_t get_size(std::istream& in, std::size_t most) {
  const auto size = get<std::uint64_t>(in);
  if (size > most)
    throw Error(ErrorKind::input,
                "a checkpoint states " + std::to_string(size) + " where at most " + std::to_string(most) + " can be");
  return static_cast<std::size_t>(size);
}

std::deque<GoodState> get_good_states(std::istream& in) {
  std::deque<GoodState> good(get_size(in, Recovery::most_states));
  for (GoodState& state : good) {
    state.guard = get<Guard>(in);
    state.step = get<std::int64_t>(in);
    state.time = get<double>(in);
    state.bytes.resize(get_size(in, CheckpointFiles::largest_good_states));
    in.read(state.bytes.data(), static_cast<std::streamsize>(state.bytes.size()));
  }
  return good;
}

}  // namespace

void Checksum::add(const char* bytes, std::size_t count) {
  for (std::size_t at = 0; at < count; at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + at, std::min<std::size_t>(8, count - at));
    state_ = (state_ ^ word) * 0x9e3779b97f4a7c15ull;
    state_ = (state_ << 29) | (state_ >> 35);
  }
}

CheckpointFiles::CheckpointFiles(const std::string& run_folder, std::uint64_t fingerprint)
    : folder_(run_folder + "/checkpoints"), fingerprint_(fingerprint) {}

Checkpoint CheckpointFiles::write(Simulation& simulation, const Guard& guard, const Recovery& recovery,
                                  double wall_seconds) {
  std::error_code trouble;
  fs::create_directories(folder_, trouble);
  if (trouble) throw Error(ErrorKind::resource, folder_ + ": cannot be made: " + trouble.message());
  char name[48];
  std::snprintf(name, sizeof name, "/step_%012lld.state", static_cast<long long>(simulation.step_count()));
  Checkpoint checkpoint{folder_ + name, simulation.step_count(), simulation.time(), wall_seconds, {}, {}};
  Header header{{}, fingerprint_, checkpoint.step, checkpoint.time, wall_seconds};
  std::memcpy(header.mark, file_mark, sizeof file_mark);
  SafeFile file(checkpoint.path);
  CheckedOutput output(file);
  std::ostream stream(&output);
  stream.exceptions(std::ios::badbit);  // what SafeFile throws comes through
  stream.write(reinterpret_cast<const char*>(&header), sizeof header);
  simulation.save(stream);
  put(stream, recovery.watch(guard));
  put_good_states(stream, recovery.good_states());
  const Trailer trailer = output.finish();
  file.write(&trailer, sizeof trailer);
  file.commit();
  // Those of later steps are of a future that the run has gone back from, or damaged: with them there, they would be taken
  // for the newest.
  std::size_t newer = 0;
  const std::vector<fs::path> paths = list(folder_);
  for (; newer < paths.size() && paths[newer] > fs::path(checkpoint.path); ++newer) fs::remove(paths[newer], trouble);
  for (std::size_t k = newer + kept; k < paths.size(); ++k) fs::remove(paths[k], trouble);
  return checkpoint;
}

std::optional<Checkpoint> CheckpointFiles::load_newest(Simulation& simulation) {
  for (const fs::path& path : list(folder_)) {
    std::ifstream file(path, std::ios::binary);
    std::error_code ignored;
    const std::string wrong = damage(file, fs::file_size(path, ignored));
    if (!wrong.empty()) {
      cli::warning(path.string() + " " + wrong + "; the checkpoint before it is taken");
      continue;
    }
    file.clear();
    file.seekg(0);
    Header header{};
    file.read(reinterpret_cast<char*>(&header), sizeof header);
    if (std::memcmp(header.mark, file_mark, sizeof file_mark) != 0 || header.fingerprint != fingerprint_)
      throw Error(ErrorKind::input, path.string() +
                                        ": was written for another case, or with other parameters (--set, "
                                        "--preset); give those of the interrupted run, or --force to start anew");
    simulation.load(file);
    const auto watch = get<Watch>(file);
    return Checkpoint{path.string(), header.step, header.time, header.wall_seconds, watch, get_good_states(file)};
  }
  return std::nullopt;
}

}  // namespace gdesp::tool
