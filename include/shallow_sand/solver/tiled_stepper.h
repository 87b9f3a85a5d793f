#pragma once

#include <vector>

#include "shallow_sand/device/host_executor.h"
#include "shallow_sand/device/instruction_set.h"
#include "shallow_sand/solver/step.h"
#include "shallow_sand/solver/tiles.h"

namespace shallow_sand {

/// Steps the tiles of a grid that are awake, on the CPU. The fields that are read and those that are written
/// must hold the same values in tiles that sleep: they do if they did once, and the two are swapped after
/// each step.
class TiledStepper {
 public:
  struct Options {
    bool with_slopes;  ///< minmod reconstruction
    bool sleeping;     ///< false: all tiles are stepped always
    InstructionSet instructions;
  };

  TiledStepper(const HostExecutor& executor, const Grid& grid, const Options& options);

  /// Cells of the window were changed from outside, or are near a body.
  void touch(const Window& cells) { tiles_.touch(cells); }

  /// Whether the next step computes any cell of the window.
  bool isDue(const Window& cells) const { return tiles_.isDue(cells); }
  /// Windows that hold all cells that it computes. Valid until the next attempt.
  const std::vector<Window>& due();

  /// Computes the next state. Returns the largest signal speed of the present one. [m/s]
  /// @param bodies columns that bodies may touch
  float attempt(const StepArguments& arguments, const std::vector<Window>& bodies, const SandFieldsOut& out);
  /// A window that holds all cells that the last attempt computed.
  const Window& stepped() const { return stepped_; }
  /// Those cells exactly.
  const std::vector<Window>& rectangles() const { return rectangles_; }
  /// The last attempt is the new state. Returns how many cells it computed.
  long long accept();

 private:
  const HostExecutor& executor_;
  Grid grid_;
  Options options_;
  Tiles tiles_;
  std::vector<HostExecutor::Memory<float>> scratch_;  // one for each thread
  long long cells_ = 0;
  Window stepped_;
  std::vector<Window> rectangles_;
};

}  // namespace shallow_sand
