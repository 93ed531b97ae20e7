// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/isolated.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <mutex>
#include <thread>

#include "core/error.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define GDESP_ADDRESS_SPACE_IS_VAST 1  // a sanitizer's shadow memory: no limit on addresses possible
#endif

namespace gdesp {
namespace {

/// A file in memory that parent and child share.
class SharedFile {
 public:
  SharedFile() : descriptor_(::memfd_create("gdesp-points", MFD_CLOEXEC)) {
    if (descriptor_ < 0)
      throw Error(ErrorKind::resource, std::string("no memory to read a file: ") + std::strerror(errno));
  }
  ~SharedFile() { ::close(descriptor_); }
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;

  void write(const void* data, std::size_t count) const {
    const char* next = static_cast<const char*>(data);
    while (count > 0) {
      const ssize_t n = ::write(descriptor_, next, std::min<std::size_t>(count, 1u << 30));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) throw std::bad_alloc();
      next += n;
      count -= static_cast<std::size_t>(n);
    }
  }
  void rewind() {
    struct stat status {};
    if (::fstat(descriptor_, &status) == 0) left_ = static_cast<std::size_t>(status.st_size);
    ::lseek(descriptor_, 0, SEEK_SET);
  }
  /// False when fewer bytes are left: the child did not finish.
  bool read(void* data, std::size_t count) {
    if (count > left_) return false;
    char* next = static_cast<char*>(data);
    left_ -= count;
    while (count > 0) {
      const ssize_t n = ::read(descriptor_, next, std::min<std::size_t>(count, 1u << 30));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      next += n;
      count -= static_cast<std::size_t>(n);
    }
    return true;
  }
  std::size_t left() const { return left_; }

 private:
  int descriptor_;
  std::size_t left_ = 0;
};

template <class T>
void put(const SharedFile& file, const T& value) {
  file.write(&value, sizeof value);
}
template <class T>
void put_all(const SharedFile& file, const std::vector<T>& values) {
  put<std::uint64_t>(file, values.size());
  file.write(values.data(), values.size() * sizeof(T));
}
void put_text(const SharedFile& file, const std::string& text) {
  put<std::uint64_t>(file, text.size());
  file.write(text.data(), text.size());
}

template <class T>
bool get(SharedFile& file, T& value) {
  return file.read(&value, sizeof value);
}
template <class Container>
bool get_all(SharedFile& file, Container& values) {
  std::uint64_t count = 0;
  if (!get(file, count) || count > file.left() / sizeof(values[0])) return false;
  values.resize(count);
  return file.read(values.data(), count * sizeof(values[0]));
}

enum class Outcome : std::uint32_t { points = 0x600d, refused = 0xbad };

void send(const SharedFile& file, const MemoryPoints& points) {
  put(file, Outcome::points);
  put_all(file, points.position);
  put<std::uint64_t>(file, points.columns.size());
  for (const MemoryColumn& column : points.columns) {
    put_text(file, column.name);
    put(file, column.components);
    put_all(file, column.numbers);
    put_all(file, column.integers);
  }
  put<std::uint64_t>(file, points.fields.size());
  for (const MemoryField& field : points.fields) {
    put_text(file, field.name);
    put_all(file, field.values);
  }
  put_all(file, points.surface.triangle);
  put_all(file, points.surface.body);
  put_all(file, points.surface.smooth);
}

bool sound(const MemoryPoints& points) {
  for (const MemoryColumn& c : points.columns)
    if (c.components < 1 || (c.numbers.empty() ? c.integers.size() : c.numbers.size()) !=
                                points.position.size() * std::size_t(c.components))
      return false;
  const auto count = std::int64_t(points.position.size());
  for (const Vec3<std::int32_t>& t : points.surface.triangle)
    for (const std::int32_t v : {t.x, t.y, t.z})
      if (v < 0 || v >= count) return false;
  const std::size_t smooth = points.surface.smooth.size();
  return points.surface.body.size() == points.surface.triangle.size() &&
         (smooth == 0 || smooth == points.surface.triangle.size());
}

bool receive(SharedFile& file, MemoryPoints& points) {
  std::uint64_t columns = 0, fields = 0;
  if (!get_all(file, points.position) || !get(file, columns)) return false;
  for (std::uint64_t i = 0; i < columns; ++i) {
    MemoryColumn column;
    if (!get_all(file, column.name) || !get(file, column.components) || !get_all(file, column.numbers) ||
        !get_all(file, column.integers))
      return false;
    points.columns.push_back(std::move(column));
  }
  if (!get(file, fields)) return false;
  for (std::uint64_t i = 0; i < fields; ++i) {
    MemoryField field;
    if (!get_all(file, field.name) || !get_all(file, field.values)) return false;
    points.fields.push_back(std::move(field));
  }
  return get_all(file, points.surface.triangle) && get_all(file, points.surface.body) &&
         get_all(file, points.surface.smooth) && sound(points);
}

std::size_t address_space_in_use() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void limit(int what, rlim_t most) {
  rlimit now{};
  ::getrlimit(static_cast<__rlimit_resource>(what), &now);
  now.rlim_cur = std::min(now.rlim_max, most);
  ::setrlimit(static_cast<__rlimit_resource>(what), &now);
}

/// In the child: quiet, without core files, within limits.
void confine(std::size_t file_size) {
  const int nowhere = ::open("/dev/null", O_RDWR);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGTERM, SIGINT, SIGXCPU, SIGXFSZ})
    std::signal(signal, SIG_DFL);
  const std::size_t memory = (std::size_t{4} << 30) + 64 * file_size;
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, memory);
  limit(RLIMIT_CPU, 20 + 2 * (file_size >> 20));
#ifndef GDESP_ADDRESS_SPACE_IS_VAST
  limit(RLIMIT_AS, address_space_in_use() + memory);
#endif
}

[[noreturn]] void work_in_child(const SharedFile& file, const std::string& path, std::size_t file_size,
                                const char* library,
                                const std::function<void(const std::string&, MemoryPoints&)>& reader) {
  std::string refusal;
  int kind = static_cast<int>(ErrorKind::input);
  try {
    confine(file_size);
    MemoryPoints points;
    reader(path, points);
    send(file, points);
    ::_exit(0);
  } catch (const Error& error) {
    refusal = error.what();
    kind = static_cast<int>(error.kind());
  } catch (const std::exception& error) {  // sizes that lie end in bad_alloc or length_error
    refusal = path + ": " + library + " cannot read it: " + error.what();
  } catch (...) { refusal = path + ": " + library + " cannot read it"; }
  try {
    put(file, Outcome::refused);
    put(file, kind);
    put_text(file, refusal);
    ::_exit(0);
  } catch (...) { ::_exit(1); }
}

/// Waits for the child, within a wall-clock limit; its wait status.
int wait_for(pid_t child, std::size_t file_size) {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + std::chrono::seconds(120 + 10 * (file_size >> 20));
  auto pause = std::chrono::microseconds(200);
  for (;;) {
    int status = 0;
    const pid_t ended = ::waitpid(child, &status, WNOHANG);
    if (ended == child) return status;
    if (ended < 0 && errno != EINTR) return 0;  // someone else reaped it; what it sent tells
    if (Clock::now() > deadline) ::kill(child, SIGKILL);
    std::this_thread::sleep_for(pause);
    pause = std::min(pause * 2, std::chrono::microseconds(5000));
  }
}

std::string cause_of(int status) {
  if (!WIFSIGNALED(status)) return "stopped";
  if (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL) return "came to no end";
  if (WTERMSIG(status) == SIGXFSZ) return "took more memory than such a file can need";
  return "crashed (signal " + std::to_string(WTERMSIG(status)) + ")";
}

std::size_t length_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) throw Error(ErrorKind::input, path + ": there is no such file");
  return static_cast<std::size_t>(status.st_size);
}

}  // namespace

const MemoryColumn* MemoryPoints::find(const std::string& name) const {
  for (const MemoryColumn& column : columns)
    if (column.name == name) return &column;
  return nullptr;
}

std::vector<std::string> MemoryPoints::names() const {
  std::vector<std::string> out;
  for (const MemoryColumn& column : columns) out.push_back(column.name);
  return out;
}

int MemoryPoints::components(const std::string& name) const {
  const MemoryColumn* column = find(name);
  return column ? column->components : 0;
}

void MemoryPoints::read(const std::string& name, float* values) const {
  const MemoryColumn& column = *find(name);
  if (column.numbers.empty())
    std::transform(column.integers.begin(), column.integers.end(), values,
                   [](std::int64_t v) { return static_cast<float>(v); });
  else
    std::copy(column.numbers.begin(), column.numbers.end(), values);
}

void MemoryPoints::read(const std::string& name, std::int64_t* values) const {
  const MemoryColumn& column = *find(name);
  const auto whole = [](float v) {
    return v >= -9e15f && v <= 9e15f ? static_cast<std::int64_t>(v) : std::int64_t(-1);
  };
  if (column.numbers.empty())
    std::copy(column.integers.begin(), column.integers.end(), values);
  else
    std::transform(column.numbers.begin(), column.numbers.end(), values, whole);
}

std::vector<double> MemoryPoints::field(const std::string& name) const {
  for (const MemoryField& one : fields)
    if (one.name == name) return one.values;
  return {};
}

TriangleTable MemoryPoints::triangles() const {
  TriangleTable table = surface;
  table.vertex = position;
  return table;
}

std::unique_ptr<MemoryPoints> read_isolated(const std::string& path, const char* library,
                                            const std::function<void(const std::string&, MemoryPoints&)>& reader) {
  static std::mutex forking;
  const std::size_t file_size = length_of(path);
  SharedFile file;
  pid_t child = -1;
  {
    const std::lock_guard<std::mutex> lock(forking);
    child = ::fork();
  }
  if (child == 0) work_in_child(file, path, file_size, library, reader);
  if (child < 0) throw Error(ErrorKind::resource, path + ": no process to read it: " + std::strerror(errno));
  const int status = wait_for(child, file_size);
  file.rewind();
  Outcome outcome{};
  auto points = std::make_unique<MemoryPoints>();
  if (WIFEXITED(status) && get(file, outcome)) {
    if (outcome == Outcome::points && receive(file, *points)) return points;
    int kind = 0;
    std::string refusal;
    if (outcome == Outcome::refused && get(file, kind) && get_all(file, refusal))
      throw Error(static_cast<ErrorKind>(kind), refusal);
  }
  throw Error(ErrorKind::input, path + ": damaged: " + library + " " + cause_of(status) + " while reading it");
}

}  // namespace gdesp
