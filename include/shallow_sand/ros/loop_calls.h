#pragma once

#include <functional>
#include <future>
#include <list>
#include <mutex>

namespace shallow_sand {

/// What other threads have the node's loop do for them, because only the loop touches sand and bodies.
class LoopCalls {
 public:
  /// To be called by the loop: does what others wait for.
  void runPending();
  /// Has the loop do something, and waits until it has: as long as a frame takes, and what other threads
  /// want.
  /// @throws what `action` throws; std::runtime_error after close()
  void inLoop(const std::function<void()>& action);
  /// Nothing more is done for anybody: those who wait are told so.
  void close();

 private:
  std::mutex mutex_;  ///< guards the rest
  std::list<std::packaged_task<void()>> pending_;
  bool closed_ = false;
};

}  // namespace shallow_sand
