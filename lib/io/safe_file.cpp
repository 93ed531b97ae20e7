// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/safe_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/error.hpp"

namespace gdesp {

SafeFile::SafeFile(std::string path) : path_(std::move(path)) {
  aside_ = path_ + ".part-" + std::to_string(::getpid());
  descriptor_ = ::open(aside_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail("created");
}

SafeFile::~SafeFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!aside_.empty()) ::unlink(aside_.c_str());
}

void SafeFile::fail(const char* doing) {
  const std::string why = std::strerror(errno);
  if (descriptor_ >= 0) {
    ::close(descriptor_);
    descriptor_ = -1;
    ::unlink(aside_.c_str());
  }
  aside_.clear();
  throw Error(ErrorKind::resource, path_ + ": cannot be " + doing + ": " + why);
}

void SafeFile::write(const void* bytes, std::size_t count) {
  const char* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t n = ::write(descriptor_, next, count);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("written");
    next += n;
    count -= static_cast<std::size_t>(n);
  }
}

void SafeFile::commit() {
  const int descriptor = std::exchange(descriptor_, -1);
  if (::close(descriptor) != 0 || ::rename(aside_.c_str(), path_.c_str()) != 0) {
    const int why = errno;
    ::unlink(aside_.c_str());
    errno = why;
    fail("completed");
  }
  aside_.clear();
}

void write_text_file(const std::string& path, std::string_view text) {
  SafeFile file(path);
  file.write(text);
  file.commit();
}

std::string read_text_file(const std::string& path, std::size_t largest) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    if (errno == ENOENT || errno == ENOTDIR) throw Error(ErrorKind::input, path + ": there is no such file");
    throw Error(ErrorKind::input, path + ": cannot be opened: " + std::strerror(errno));
  }
  struct stat status {};
  std::string text;
  const char* trouble = nullptr;
  if (::fstat(descriptor, &status) != 0)
    trouble = std::strerror(errno);
  else if (S_ISDIR(status.st_mode))
    trouble = "it is a folder, expected a file";
  else if (static_cast<std::size_t>(status.st_size) > largest)
    trouble = "it is larger than such a file can be";
  char block[65536];
  while (!trouble) {
    const ssize_t n = ::read(descriptor, block, sizeof block);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) trouble = std::strerror(errno);
    if (n <= 0) break;
    text.append(block, static_cast<std::size_t>(n));
    if (text.size() > largest) trouble = "it is larger than such a file can be";
  }
  ::close(descriptor);
  if (trouble) throw Error(ErrorKind::input, path + ": cannot be read: " + trouble);
  return text;
}

}  // namespace gdesp
