// SPDX-License-Identifier: GPL-3.0-or-later
// Reorders arrays by a source index, keeping one scratch array per element type.
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

/// array[k] = array[source[k]], or `missing` where source[k] < 0; `count` is the new size.
template <class T, class Exec>
void permute(const Exec& exec, Array<T, Exec>& array, Array<T, Exec>& scratch, const Index* source, Index count,
             const T& missing) {
  scratch.resize_discard(static_cast<std::size_t>(count));
  parallel_for(exec, "sort::gather", count, Gather<T>{array.data(), source, scratch.data(), missing});
  array.swap(scratch);
}

}  // namespace gdesp::exec
