// SPDX-License-Identifier: GPL-3.0-or-later
// A series of passes that is given again and again in nearly the same shape, like the sub-steps of grains. A device captures
// it as a graph and takes it with one call; the host just does it (docs/decisions/0014).
#pragma once

#include "exec/backend.hpp"

namespace gdesp::exec {

namespace detail {
inline bool begin_capture(const OpenMP&) { return false; }
inline void drop_capture(const OpenMP&) {}
inline void launch_captured(const OpenMP&, void*&) {}
inline void forget_graph(const OpenMP&, void*) {}
// `graph`: a cudaGraphExec_t, null before the first. Capture begins unless GDESP_CUDA_GRAPHS=0 is in the environment.
bool begin_capture(const Cuda& exec);
void drop_capture(const Cuda& exec);
void launch_captured(const Cuda& exec, void*& graph);
void forget_graph(const Cuda& exec, void* graph);
}  // namespace detail

template <class Exec>
class Batch {
 public:
  explicit Batch(const Exec& exec) : exec_(exec) {}
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;
  ~Batch() { detail::forget_graph(exec_, graph_); }

  /// Does body() once. It may run passes over things and fill memory; it may not wait, copy to or from the host, or allocate.
  /// Throws what body() throws, and Error(resource) when the device refuses.
  template <class Body>
  void give(const Body& body) {
    const bool captures = detail::begin_capture(exec_);
    try {
      body();
    } catch (...) {
      if (captures) detail::drop_capture(exec_);
      throw;
    }
    if (captures) detail::launch_captured(exec_, graph_);
  }

 private:
  Exec exec_;
  void* graph_ = nullptr;
};

}  // namespace gdesp::exec
