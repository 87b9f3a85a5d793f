#include "shallow_sand/ros/loop_calls.h"

#include <stdexcept>

namespace shallow_sand {
namespace {

constexpr const char* kClosed = "the node is shutting down";

}  // namespace

void LoopCalls::runPending() {
  std::list<std::packaged_task<void()>> tasks;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::swap(tasks, pending_);
  }
  for (std::packaged_task<void()>& task : tasks) task();
}

void LoopCalls::inLoop(const std::function<void()>& action) {
  std::packaged_task<void()> task(action);
  std::future<void> done = task.get_future();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (closed_) throw std::runtime_error(kClosed);
    pending_.push_back(std::move(task));
  }
  try {
    done.get();
  } catch (const std::future_error&) {  // the task was dropped
    throw std::runtime_error(kClosed);
  }
}

void LoopCalls::close() {
  const std::lock_guard<std::mutex> lock(mutex_);
  closed_ = true;
  pending_.clear();
}

}  // namespace shallow_sand
