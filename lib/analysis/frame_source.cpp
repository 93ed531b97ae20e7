// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/frame_source.hpp"

#include <condition_variable>
#include <exception>
#include <filesystem>
#include <mutex>
#include <thread>

#include "core/error.hpp"

namespace gdesp::analysis {

namespace fs = std::filesystem;

namespace {

std::string base_name(const std::string& path) {
  fs::path p = fs::path(path).lexically_normal();
  if (p.filename().empty()) p = p.parent_path();
  return p.filename().string();
}

std::string text_of(const nlohmann::ordered_json& record, const char* key) {
  const auto it = record.find(key);
  return it != record.end() && it->is_string() ? it->get<std::string>() : std::string();
}

template <class T>
T number_of(const nlohmann::ordered_json& record, const char* key, T otherwise) {
  const auto it = record.find(key);
  return it != record.end() && it->is_number() ? it->get<T>() : otherwise;
}

}  // namespace

// Reads one frame ahead in a thread of its own. The thread may wait on standard input for ever, so it is
// detached and shares this state with the source.
struct FrameSource::Reader {
  SourceOptions options;
  std::vector<FramePaths> paths;  // folders and files
  std::size_t at = 0, seen = 0;
  bool from_stdin = false;
  std::string case_path, run_path;
  double file_dp = 0.0;
  Vec3d file_offset;

  std::mutex mutex;
  std::condition_variable ready;
  bool busy = false, ended = false, failed = false;
  bool closed = false, cut_short = false;  // the producer's own last word; none before its records ended
  std::string failure;
  std::optional<Frame> ahead;
  std::exception_ptr problem;

  std::optional<FramePaths> next_paths();
  std::optional<FramePaths> next_record();
  Frame load(const FramePaths& paths);
  void read_one();
};

std::optional<FramePaths> FrameSource::Reader::next_record() {
  while (auto record = options.next_record()) {
    const std::string kind = text_of(*record, "record");
    if (kind == "done" || kind == "interrupted" || kind == "failed") closed = true;
    if (kind == "failed") {
      const std::lock_guard lock(mutex);
      failed = true;
      failure = text_of(*record, "message");
    }
    if (!text_of(*record, "case").empty()) case_path = text_of(*record, "case");
    if (kind != "frame") continue;
    FramePaths p;
    p.fluid = text_of(*record, "fluid").empty() ? text_of(*record, "path") : text_of(*record, "fluid");
    p.grains = text_of(*record, "grains");
    p.bodies = text_of(*record, "bodies");
    if (p.fluid == p.grains) p.fluid.clear();
    p.time = number_of(*record, "t", 0.0);
    p.step = number_of(*record, "step", std::int64_t{0});
    if (run_path.empty()) {
      const std::string some = p.fluid.empty() ? p.grains : p.fluid;
      run_path = fs::path(some).parent_path().parent_path().string();
    }
    return p;
  }
  const std::lock_guard lock(mutex);
  cut_short = !closed;
  return std::nullopt;
}

std::optional<FramePaths> FrameSource::Reader::next_paths() {
  if (from_stdin) return next_record();
  if (at >= paths.size()) return std::nullopt;
  return paths[at++];
}

Frame FrameSource::Reader::load(const FramePaths& p) {
  Frame frame;
  frame.time = p.time;
  frame.step = p.step;
  FrameMeta meta;
  if (!p.fluid.empty()) {
    frame.fluid = read_fluid_frame(p.fluid, options.mapping, &meta);
    if (!from_stdin && run_path.empty() && meta.has_time) frame.time = meta.time;
    if (file_dp <= 0.0) file_dp = meta.dp;
    file_offset = meta.offset;
  }
  if (options.grains && !p.grains.empty()) frame.grains = read_grain_frame(p.grains, options.mapping, &meta);
  if (options.bodies && !p.bodies.empty()) read_bodies_frame(p.bodies, frame);
  return frame;
}

void FrameSource::Reader::read_one() {
  std::optional<Frame> frame;
  std::exception_ptr trouble;
  try {
    while (const auto p = next_paths()) {
      const bool chosen = seen++ % static_cast<std::size_t>(options.every) == 0;
      if (!chosen || p->time < options.from || p->time > options.until) continue;
      frame = load(*p);
      break;
    }
  } catch (...) { trouble = std::current_exception(); }
  const std::lock_guard lock(mutex);
  ended = ended || (!frame && !trouble);
  ahead = std::move(frame);
  problem = trouble;
  busy = false;
  ready.notify_all();
}

void FrameSource::read_ahead() {
  {
    const std::lock_guard lock(reader_->mutex);
    if (reader_->busy || reader_->ended || reader_->ahead) return;
    reader_->busy = true;
  }
  std::thread([reader = reader_] { reader->read_one(); }).detach();
}

FrameSource::FrameSource(SourceOptions options) : options_(std::move(options)), reader_(std::make_shared<Reader>()) {
  Reader& r = *reader_;
  r.options = options_;
  if (options_.inputs.empty())
    throw Error(ErrorKind::usage, "no run given: a run folder, frame files, or - (see --help)");
  r.case_path = options_.case_path;
  const std::string first = options_.inputs[0];
  if (first == "-") {
    r.from_stdin = true;
  } else if (fs::is_directory(first)) {
    if (options_.inputs.size() > 1) throw Error(ErrorKind::usage, "one run folder at a time, or several frame files");
    r.run_path = first;
    r.paths = list_frames(first);
    if (r.paths.empty()) throw Error(ErrorKind::input, first + ": a run folder without frames (frames/fluid_*.vtp)");
    if (r.case_path.empty() && fs::exists(fs::path(first) / "case.link")) r.case_path = run_case_path(first);
  } else {
    for (std::size_t k = 0; k < options_.inputs.size(); ++k) {
      if (!fs::exists(options_.inputs[k]))
        throw Error(ErrorKind::input, options_.inputs[k] + ": no such file or run folder");
      r.paths.push_back({options_.inputs[k], "", "", static_cast<double>(k) * options_.frame_interval, 0});
    }
  }
  read_ahead();
  {
    std::unique_lock lock(r.mutex);
    r.ready.wait(lock, [&] { return !r.busy; });
    if (r.problem) std::rethrow_exception(r.problem);
  }
  if (!r.ahead && r.failed) throw Error(ErrorKind::numerical, "the run failed before its first frame: " + r.failure);
  if (!r.ahead)
    throw Error(ErrorKind::input, first == "-" ? "standard input ended without a frame record"
                                               : first + ": no frame in the chosen time range");
  if (!options_.case_path.empty()) r.case_path = options_.case_path;
  if (!r.case_path.empty()) info_ = read_run_info(r.case_path);
  if (!info_.has_case) {
    info_.offset = r.file_offset;
    info_.dimensions = options_.dimensions;
  }
  if (options_.dp > 0.0)
    info_.dp = options_.dp;
  else if (info_.dp <= 0.0)
    info_.dp = r.file_dp;
  if (info_.dp <= 0.0)
    throw Error(ErrorKind::input, first + ": does not carry the particle spacing; give it with --dp METRES");
  if (!info_.has_case) complete_from_fluid(info_, r.ahead->fluid);
  if (options_.still_water) info_.still_water_level = *options_.still_water - info_.offset.z;
  info_.run_path = r.run_path;
  info_.name = base_name(r.run_path.empty() ? first : r.run_path);
}

FrameSource::~FrameSource() = default;

std::optional<Frame> FrameSource::next(const std::function<bool()>& stop) {
  Reader& r = *reader_;
  read_ahead();
  std::optional<Frame> frame;
  {
    std::unique_lock lock(r.mutex);
    while (!r.ready.wait_for(lock, std::chrono::milliseconds(100), [&] { return !r.busy; })) {
      if (stop && stop()) return std::nullopt;
    }
    if (r.problem) std::rethrow_exception(std::exchange(r.problem, nullptr));
    frame = std::move(r.ahead);
    r.ahead.reset();
  }
  if (frame) read_ahead();
  return frame;
}

bool FrameSource::failed() const {
  const std::lock_guard lock(reader_->mutex);
  return reader_->failed;
}

std::string FrameSource::failure() const {
  const std::lock_guard lock(reader_->mutex);
  return reader_->failure;
}

bool FrameSource::cut_short() const {
  const std::lock_guard lock(reader_->mutex);
  return reader_->cut_short;
}

std::size_t FrameSource::expected() const {
  return reader_->from_stdin ? 0 : reader_->paths.size() / static_cast<std::size_t>(options_.every);
}

}  // namespace gdesp::analysis
