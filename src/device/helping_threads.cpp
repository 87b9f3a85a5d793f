#include "shallow_sand/device/helping_threads.h"

#include <chrono>

namespace shallow_sand {

namespace {

/// How long a thread looks out for what it waits for before it sleeps: to be woken takes a core that idles
/// some 50 µs, as long as a step of a small map; a longer look would take time from other processes.
constexpr std::chrono::microseconds kLook{30};

void relax() {
#ifdef __x86_64__
  __builtin_ia32_pause();
#endif
}

template <class Condition>
bool lookOutFor(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + kLook;
  do {
    for (int k = 0; k < 16; ++k) {
      if (condition()) return true;
      relax();
    }
  } while (std::chrono::steady_clock::now() < end);
  return condition();
}

}  // namespace

HelpingThreads::HelpingThreads(int helpers) {
  for (int k = 1; k <= helpers; ++k) helpers_.emplace_back([this, k] { help(k); });
}

HelpingThreads::~HelpingThreads() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closing_ = true;
  }
  called_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void HelpingThreads::run(const std::function<void(int)>& work) {
  bool wake;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    work_ = &work;
    ++calls_;
    wake = asleep_ > 0;
  }
  if (wake) called_.notify_all();
  work(0);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    work_ = nullptr;
  }
  const auto all_done = [this] { return working_ == 0; };
  if (lookOutFor(all_done)) return;
  std::unique_lock<std::mutex> lock(mutex_);
  done_.wait(lock, all_done);
}

void HelpingThreads::help(int number) {
  std::uint64_t seen = 0;
  while (!closing_) {
    const std::function<void(int)>* work = begin(seen);
    if (work == nullptr) continue;
    (*work)(number);
    end();
  }
}

/// Waits for a call. Returns its work if it still wants help; it is then not over before end().
const std::function<void(int)>* HelpingThreads::begin(std::uint64_t& seen) {
  const auto called = [&] { return calls_ != seen || closing_; };
  const bool awake = lookOutFor(called);
  std::unique_lock<std::mutex> lock(mutex_);
  if (!awake) {
    ++asleep_;
    called_.wait(lock, called);
    --asleep_;
  }
  seen = calls_;
  if (work_ != nullptr) ++working_;
  return work_;
}

void HelpingThreads::end() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (--working_ == 0) done_.notify_one();
}

}  // namespace shallow_sand
