#pragma once

#include "shallow_sand/device/cuda_memory.cuh"
#include "shallow_sand/particles/grain_memory.h"
#include "shallow_sand/sim/run_tables.h"
#include "shallow_sand/solver/due_tiles.cuh"

namespace shallow_sand {

/// Cells that may move: those of tiles that are due for a step, and of the blocks that bodies may touch.
struct AwakeCells {
  DueTiles tiles;
  StepNumber step;
  const CellBlock* blocks;
  int block_count;
};

/// Puts a move of grains into a stream; the host waits for nothing.
void moveGrains(const GrainMove& move, const AwakeCells& awake, const CudaStream& stream);

}  // namespace shallow_sand
