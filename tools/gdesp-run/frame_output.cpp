// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame_output.hpp"

#include <utility>

namespace gdesp::tool {

FrameOutput::FrameOutput(FrameWriter writer, std::function<void(const FramePaths&)> written)
    : writer_(std::move(writer)), written_(std::move(written)), thread_([this] { work(); }) {}

FrameOutput::~FrameOutput() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void FrameOutput::rethrow(std::unique_lock<std::mutex>& lock) {
  if (!problem_) return;
  const std::exception_ptr problem = problem_;
  lock.unlock();
  std::rethrow_exception(problem);
}

void FrameOutput::push(Frame frame) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return problem_ || waiting_.size() < most_waiting; });
  rethrow(lock);
  waiting_.push_back(std::move(frame));
  changed_.notify_all();
}

void FrameOutput::drain() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return problem_ || (waiting_.empty() && !busy_); });
  rethrow(lock);
}

void FrameOutput::check() {
  std::unique_lock lock(mutex_);
  rethrow(lock);
}

void FrameOutput::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return ending_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const Frame frame = std::move(waiting_.front());
    waiting_.pop_front();
    busy_ = true;
    changed_.notify_all();
    lock.unlock();
    std::exception_ptr problem;
    try {
      written_(writer_.write(frame));
    } catch (...) {  // a closed pipe is no std::exception; all goes to the thread that computes
      problem = std::current_exception();
    }
    lock.lock();
    busy_ = false;
    if (problem) {
      problem_ = problem;
      waiting_.clear();
    }
    changed_.notify_all();
    if (problem) return;
  }
}

}  // namespace gdesp::tool
