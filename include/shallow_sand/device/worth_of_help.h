#pragma once

#include <algorithm>

namespace shallow_sand {

/// Whether other threads are worth asking for help. Where other processes keep the cores busy, a helper that
/// loses its core in the middle of a task holds up the caller by more than all helpers save. Then the caller
/// goes on alone for a while; longer, each time that it did not pay to ask again.
class WorthOfHelp {
 public:
  /// @param now [s]
  bool ask(double now) const { return now >= alone_until_; }

  /// @param helped processor time that helpers spent on the caller's tasks [s]: what it would have taken
  /// itself
  /// @param waiting time that the caller then waited for them [s]
  void book(double helped, double waiting, double now) {
    balance_ = std::min(balance_ + helped - waiting, kMostCredit);
    if (balance_ == kMostCredit) pause_ = std::max(0.9 * pause_, kShortestPause);
    if (balance_ >= 0.0) return;
    balance_ = 0.0;
    alone_until_ = now + pause_;
    pause_ = std::min(2.0 * pause_, kLongestPause);
  }

 private:
  static constexpr double kMostCredit = 4e-3;  // what the loss of a core costs [s]
  static constexpr double kShortestPause = 2e-3;
  static constexpr double kLongestPause = 0.5;
  double balance_ = 0.0;  // time saved lately [s]
  double pause_ = kShortestPause;
  double alone_until_ = 0.0;
};

}  // namespace shallow_sand
