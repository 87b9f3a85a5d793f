#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace shallow_sand {

/// Threads that help a caller if they come in time. Unlike an OpenMP region, a call does not wait for a
/// thread that another process keeps off its core: only those that have begun are waited for.
class HelpingThreads {
 public:
  explicit HelpingThreads(int helpers);
  ~HelpingThreads();
  HelpingThreads(const HelpingThreads&) = delete;
  HelpingThreads& operator=(const HelpingThreads&) = delete;

  /// Calls work(0) here and work(1), work(2), … on those helpers that begin before work(0) has returned;
  /// work(0) must return only when nothing is left to begin. Returns when all of these calls have.
  void run(const std::function<void(int)>& work);

 private:
  void help(int number);
  const std::function<void(int)>* begin(std::uint64_t& seen);
  void end();

  std::mutex mutex_;
  std::condition_variable called_;
  std::condition_variable done_;
  std::atomic<std::uint64_t> calls_{0};  // written under the mutex; read without it by those that spin
  std::atomic<int> working_{0};
  const std::function<void(int)>* work_ = nullptr;  // null: none may begin
  int asleep_ = 0;
  std::atomic<bool> closing_{false};
  std::vector<std::thread> helpers_;
};

}  // namespace shallow_sand
