// SPDX-License-Identifier: GPL-3.0-or-later
// Array<T, Exec> owns memory where Exec computes; kernels see plain pointers. Copies between host and device are
// explicit and happen only at input, output and checkpoint.
#pragma once

#include <type_traits>
#include <utility>
#include <vector>

#include "exec/backend.hpp"

namespace gdesp::exec {

/// Bytes now held by all arrays of the process, and the most held so far.
std::size_t allocated_bytes();
std::size_t peak_allocated_bytes();

namespace detail {
void* allocate(const OpenMP&, std::size_t bytes);  // zeroed by the threads that will use it; huge pages
void release(const OpenMP&, void* p, std::size_t bytes);
void copy_to_host(const OpenMP&, void* to, const void* from, std::size_t bytes);
void copy_from_host(const OpenMP&, void* to, const void* from, std::size_t bytes);
void fill_bytes(const OpenMP&, void* p, int value, std::size_t bytes);
void* allocate(const Cuda&, std::size_t bytes);
void release(const Cuda&, void* p, std::size_t bytes);
void copy_to_host(const Cuda&, void* to, const void* from, std::size_t bytes);
void copy_from_host(const Cuda&, void* to, const void* from, std::size_t bytes);
void fill_bytes(const Cuda&, void* p, int value, std::size_t bytes);
}  // namespace detail

template <class T, class Exec>
class Array {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Array() = default;
  explicit Array(const Exec& exec) : exec_(exec) {}
  Array(Array&& other) noexcept { swap(other); }
  Array& operator=(Array&& other) noexcept {
    swap(other);
    return *this;
  }
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;
  ~Array() { detail::release(exec_, data_, capacity_ * sizeof(T)); }

  void swap(Array& other) noexcept {
    std::swap(exec_, other.exec_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
    std::swap(grown_, other.grown_);
  }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* data() { return data_; }
  const T* data() const { return data_; }

  /// Sets the size; what was in it is lost when it grows past the capacity (then it is zero).
  void resize_discard(std::size_t size) {
    if (size > capacity_) {
      detail::release(exec_, data_, capacity_ * sizeof(T));
      data_ = nullptr;
      capacity_ = 0;
      const std::size_t wanted = grown_ ? size + size / 64 : size;  // a set that never grows pays for no more
      grown_ = true;
      data_ = static_cast<T*>(detail::allocate(exec_, wanted * sizeof(T)));
      capacity_ = wanted;
    }
    size_ = size;
  }
  /// Gives the memory back.
  void free() { Array(exec_).swap(*this); }
  /// Sets every byte.
  void fill_bytes(int value) {
    if (size_) detail::fill_bytes(exec_, data_, value, size_ * sizeof(T));
  }
  void assign(const std::vector<T>& host) {
    resize_discard(host.size());
    if (size_) detail::copy_from_host(exec_, data_, host.data(), size_ * sizeof(T));
  }
  std::vector<T> to_host() const {
    std::vector<T> host(size_);
    copy_to_host(host.data(), 0, size_);
    return host;
  }
  /// `count` elements from `first` on, to memory of the host (synchronises the stream on a device).
  void copy_to_host(T* to, std::size_t first, std::size_t count) const {
    if (count) detail::copy_to_host(exec_, to, data_ + first, count * sizeof(T));
  }
  /// One element (synchronises the stream on a device).
  T read(std::size_t i) const {
    T value;
    copy_to_host(&value, i, 1);
    return value;
  }

 private:
  Exec exec_{};
  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
  bool grown_ = false;
};

/// Keys and values to be sorted, and a second place of the same size for each.
struct SortedPairs {
  std::uint64_t* keys;
  Index* values;
  std::uint64_t* other_keys;
  Index* other_values;
};

}  // namespace gdesp::exec
