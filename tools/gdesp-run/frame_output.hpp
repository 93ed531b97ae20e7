// SPDX-License-Identifier: GPL-3.0-or-later
// Frames go to disk in a thread of their own, while the simulation takes its next steps.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

#include "io/frame.hpp"

namespace gdesp::tool {

class FrameOutput {
 public:
  /// `written` is called in the writing thread, in order, once a frame is safely on disk.
  FrameOutput(FrameWriter writer, std::function<void(const FramePaths&)> written);
  ~FrameOutput();
  FrameOutput(const FrameOutput&) = delete;
  FrameOutput& operator=(const FrameOutput&) = delete;

  /// Hands a frame over; waits while two are under way. Throws what the writing thread has thrown.
  void push(Frame frame);
  /// Waits until all frames are on disk. Throws what the writing thread has thrown.
  void drain();
  /// Rethrows what the writing thread has thrown, if it has.
  void check();

 private:
  static constexpr std::size_t most_waiting = 2;
  void work();
  void rethrow(std::unique_lock<std::mutex>& lock);

  FrameWriter writer_;
  std::function<void(const FramePaths&)> written_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Frame> waiting_;
  bool busy_ = false, ending_ = false;
  std::exception_ptr problem_;
  std::thread thread_;
};

}  // namespace gdesp::tool
