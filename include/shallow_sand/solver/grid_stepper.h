#pragma once

#include <vector>

#include "shallow_sand/solver/step.h"

namespace shallow_sand {

/// Steps every cell of the grid in every step, on any executor.
template <class Executor>
class GridStepper {
 public:
  /// @param with_slopes minmod reconstruction
  GridStepper(Executor& executor, bool with_slopes) : executor_(executor), with_slopes_(with_slopes) {}

  /// Cells of the window were changed from outside.
  void touch(const Window&) {}
  bool isDue(const Window&) const { return true; }
  std::vector<Window> due() const { return {stepped_}; }

  /// Computes the next state. Returns the largest signal speed of the present one. [m/s]
  /// @param bodies columns that bodies may touch
  float attempt(const StepArguments& arguments, const std::vector<Window>& bodies, const SandFieldsOut& out) {
    stepped_ = {0, 0, arguments.columns, arguments.rows};
    return withStep(arguments, !bodies.empty(), with_slopes_, [&](const auto& step) {
      return executor_.maximumOverCells(stepped_, StepCell<std::decay_t<decltype(step)>>{step, out});
    });
  }
  /// What the last attempt computed: everything.
  const Window& stepped() const { return stepped_; }
  std::vector<Window> rectangles() const { return {stepped_}; }
  /// The last attempt is the new state. Returns how many cells it computed.
  long long accept() { return static_cast<long long>(stepped_.cells()); }

 private:
  Executor& executor_;
  bool with_slopes_;
  Window stepped_;
};

}  // namespace shallow_sand
