#pragma once

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// Time spent for work of some amount: in all, and where it went fastest. Other load on a machine only ever
/// adds time.
class Timing {
 public:
  void add(double seconds, double amount) {
    seconds_ += seconds;
    amount_ += amount;
    best_ = std::min(best_, seconds / amount);
  }
  double typical() const { return seconds_ / amount_; }  ///< seconds for an amount of 1
  double best() const { return best_; }

 private:
  double seconds_ = 0.0;
  double amount_ = 0.0;
  double best_ = std::numeric_limits<double>::infinity();
};

template <class Function>
double secondsOf(Function&& function) {
  const auto begin = std::chrono::steady_clock::now();
  function();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

constexpr double kFiftieth = 0.02;  ///< a frame as sand_node and a film have it [s]

/// A simulator that runs frame by frame, and how long its steps take.
class TimedRun {
 public:
  /// @param frame its length [s]
  explicit TimedRun(Simulator simulator, double frame = 0.03)
      : simulator_(std::move(simulator)), frame_(frame) {
    simulator_.advance(20.0 * frame_);  // all cells have begun to move
    repeated_before_ = simulator_.progress().repeated_steps;
  }

  /// Returns the seconds that a frame took.
  double runFrame() {
    const Progress before = simulator_.progress();
    const double seconds = secondsOf([&] { simulator_.advance(frame_); });
    const Progress& after = simulator_.progress();
    cells_.add(seconds, static_cast<double>(after.cell_updates - before.cell_updates));
    steps_.add(seconds, static_cast<double>(after.steps - before.steps));
    frames_.add(seconds, 1.0);
    return seconds;
  }
  const Timing& cells() const { return cells_; }
  const Timing& steps() const { return steps_; }
  const Timing& frames() const { return frames_; }
  double stepsPerFrame() const { return frames_.typical() / steps_.typical(); }
  double repeated() const {
    return static_cast<double>(simulator_.progress().repeated_steps - repeated_before_);
  }
  double moving() const { return static_cast<double>(simulator_.activeCells()); }

 private:
  Simulator simulator_;
  double frame_;
  std::uint64_t repeated_before_ = 0;
  Timing cells_;
  Timing steps_;
  Timing frames_;
};

}  // namespace shallow_sand
