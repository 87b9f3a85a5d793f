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

  /// What work took with help, until `now`, and what it would have taken without. [s]
  void book(double with_help, double alone, double now) {
    balance_ = std::min(balance_ + (alone - with_help), kMostCredit);
    if (balance_ == kMostCredit) pause_ = std::max(0.5 * pause_, kShortestPause);
    if (balance_ >= 0.0) return;
    balance_ = 0.0;
    alone_until_ = now + pause_;
    pause_ = std::min(2.0 * pause_, kLongestPause);
  }

 private:
  static constexpr double kMostCredit = 2e-3;  // less than a helper that lost its core costs [s]
  static constexpr double kShortestPause = 2e-3;
  static constexpr double kLongestPause = 0.25;
  double balance_ = 0.0;  // time saved lately [s]
  double pause_ = kShortestPause;
  double alone_until_ = 0.0;
};

}  // namespace shallow_sand
