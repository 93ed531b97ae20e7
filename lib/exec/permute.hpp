// SPDX-License-Identifier: GPL-3.0-or-later
// Reorders arrays by a source index, through memory that is idle while things are sorted (records, made anew after).
#pragma once

#include "exec/parallel.hpp"

namespace gdesp::exec {

template <class T>
struct Gather {
  const T* from;
  const Index* source;  ///< old index, or -1
  T* to;
  T missing;
  GDESP_HD void operator()(Index k) const { to[k] = source[k] >= 0 ? from[source[k]] : missing; }
};

template <class T>
struct CopyEach {
  const T* from;
  T* to;
  GDESP_HD void operator()(Index k) const { to[k] = from[k]; }
};

/// Room for `count` values of T in the memory of another array, whose contents are lost.
template <class T, class R, class Exec>
T* room_for(Array<R, Exec>& room, std::size_t count) {
  static_assert(alignof(T) <= 64);  // arrays begin at 64 bytes
  const std::size_t needed = (count * sizeof(T) + sizeof(R) - 1) / sizeof(R);
  if (needed > room.size()) room.resize_discard(needed);
  return reinterpret_cast<T*>(room.data());
}

/// array[k] = array[source[k]], or `missing` where source[k] < 0; `count` is the new size. What is in `room` is lost.
template <class T, class R, class Exec>
void permute(const Exec& exec, Array<T, Exec>& array, Array<R, Exec>& room, const Index* source, Index count,
             const T& missing) {
  T* between = room_for<T>(room, static_cast<std::size_t>(count));
  parallel_for(exec, "sort::gather", count, Gather<T>{array.data(), source, between, missing});
  array.resize_discard(static_cast<std::size_t>(count));
  parallel_for(exec, "sort::gather", count, CopyEach<T>{between, array.data()});
}

}  // namespace gdesp::exec
