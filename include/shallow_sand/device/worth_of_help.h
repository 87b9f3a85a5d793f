#pragma once

#include <algorithm>
#include <limits>

namespace shallow_sand {

/// Whether other threads are worth asking for help. Where other processes keep the cores busy, a helper that
/// loses its core in the middle of a task holds up the caller by more than all helpers save. Then the caller
/// goes on alone for a while; longer, each time that it did not pay to ask again.
class WorthOfHelp {
 public:
  /// @param now [s]
  bool ask(double now) const { return now >= alone_until_; }

  /// The caller did `own` tasks in `working` [s], helpers did `others`, and for these it had to wait [s].
  void book(int own, double working, int others, double waiting, double now) {
    // The caller may have lost its core, too; that is no help's fault.
    if (own > 0) task_ = std::min(1.02 * task_, working / own);
    if (others > 0 || waiting > 0.0) book(std::min(others * task_, 1.0) - waiting, now);
  }

 private:
  void book(double saved, double now) {
    balance_ = std::min(balance_ + saved, kMostCredit);
    if (balance_ == kMostCredit) pause_ = std::max(0.9 * pause_, kShortestPause);
    if (balance_ >= 0.0) return;
    balance_ = 0.0;
    alone_until_ = now + pause_;
    pause_ = std::min(2.0 * pause_, kLongestPause);
  }

  static constexpr double kMostCredit = 4e-3;  // what the loss of a core costs [s]
  static constexpr double kShortestPause = 2e-3;
  static constexpr double kLongestPause = 0.5;
  double task_ = std::numeric_limits<double>::infinity();  // that a task takes; rather too little [s]
  double balance_ = 0.0;                                   // time saved lately [s]
  double pause_ = kShortestPause;
  double alone_until_ = 0.0;
};

}  // namespace shallow_sand
