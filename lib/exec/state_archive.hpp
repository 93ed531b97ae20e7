// SPDX-License-Identifier: GPL-3.0-or-later
// State as a stream of bytes, for checkpoints. A class lists its members once,
//   template <class Archive> void archive(Archive& a) { a(position_, velocity_, time_); }
// and is saved by StateWriter, restored by StateReader. Native byte order; the stream's owner adds a checksum.
#pragma once

#include <algorithm>
#include <cstring>
#include <istream>
#include <ostream>
#include <string>
#include <type_traits>
#include <vector>

#include "core/error.hpp"
#include "exec/array.hpp"

namespace gdesp::exec {

class StateWriter {
 public:
  explicit StateWriter(std::ostream& out) : out_(out) {}

  /// Writes all parts: plain values, vectors of them, arrays of a back end, or classes with archive().
  template <class... Parts>
  void operator()(Parts&... parts) {
    (put(parts), ...);
  }

  /// The first `count` elements of an array whose rest means nothing.
  template <class T, class Exec>
  void prefix(const Array<T, Exec>& array, std::size_t count) {
    bytes(&count, sizeof count);
    if constexpr (std::is_same_v<Exec, OpenMP>) {
      bytes(array.data(), count * sizeof(T));
    } else {
      std::vector<T> block;
      for (std::size_t done = 0; done < count; done += block.size()) {
        block.resize(std::min(count - done, std::size_t{1} << 22));
        array.copy_to_host(block.data(), done, block.size());
        bytes(block.data(), block.size() * sizeof(T));
      }
    }
  }

  /// A word by which the reader knows where it is.
  void mark(const char* name) { bytes(name, std::strlen(name) + 1); }

 private:
  void bytes(const void* from, std::size_t count) {
    if (count > 0) out_.write(static_cast<const char*>(from), static_cast<std::streamsize>(count));
    if (!out_) throw Error(ErrorKind::resource, "the state of the simulation cannot be written");
  }
  template <class T, class Exec>
  void put(Array<T, Exec>& array) {
    prefix(array, array.size());
  }
  template <class T>
  void put(std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::size_t count = values.size();
    bytes(&count, sizeof count);
    bytes(values.data(), count * sizeof(T));
  }
  template <class T>
  void put(T& part) {
    if constexpr (std::is_trivially_copyable_v<T>)
      bytes(&part, sizeof(T));
    else
      part.archive(*this);
  }

  std::ostream& out_;
};

class StateReader {
 public:
  explicit StateReader(std::istream& in) : in_(in) {}

  template <class... Parts>
  void operator()(Parts&... parts) {
    (get(parts), ...);
  }

  template <class T, class Exec>
  void prefix(Array<T, Exec>& array, std::size_t) {
    get(array);
  }

  /// Throws Error(input) when the stream does not hold this mark here.
  void mark(const char* name) {
    std::string found(std::strlen(name) + 1, '\0');
    bytes(found.data(), found.size());
    if (std::strcmp(found.c_str(), name) != 0) fail();
  }

 private:
  [[noreturn]] static void fail() {
    throw Error(ErrorKind::input, "checkpoint: not a state of this simulation, or of another version of the program");
  }
  void bytes(void* to, std::size_t count) {
    if (count > 0) in_.read(static_cast<char*>(to), static_cast<std::streamsize>(count));
    if (!in_) fail();
  }
  template <class T, class Exec>
  void get(Array<T, Exec>& array) {
    std::vector<T> values;
    get(values);
    array.assign(values);
  }
  template <class T>
  void get(std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::size_t count = 0;
    bytes(&count, sizeof count);
    values.clear();
    while (values.size() < count) {  // block by block: a wrong count meets the end of the stream before the memory's
      const std::size_t done = values.size();
      values.resize(done + std::min(count - done, std::size_t{1} << 22));
      bytes(values.data() + done, (values.size() - done) * sizeof(T));
    }
  }
  template <class T>
  void get(T& part) {
    if constexpr (std::is_trivially_copyable_v<T>)
      bytes(&part, sizeof(T));
    else
      part.archive(*this);
  }

  std::istream& in_;
};

}  // namespace gdesp::exec
