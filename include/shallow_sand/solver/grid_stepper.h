#pragma once

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

  /// Computes the next state. Returns the largest signal speed of the present one. [m/s]
  /// @param bodies columns that bodies may touch
  float attempt(const StepArguments& arguments, const Window& bodies, const SandFieldsOut& out) {
    cells_ = static_cast<long long>(arguments.columns) * arguments.rows;
    return withStep(arguments, !bodies.empty(), with_slopes_, [&](const auto& step) {
      return executor_.maximumOverCells(Window{0, 0, step.columns, step.rows},
                                        StepCell<std::decay_t<decltype(step)>>{step, out});
    });
  }
  /// The last attempt is the new state. Returns how many cells it computed.
  long long accept() { return cells_; }

 private:
  Executor& executor_;
  bool with_slopes_;
  long long cells_ = 0;
};

}  // namespace shallow_sand
