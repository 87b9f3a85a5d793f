#pragma once

#include <vector>

#include "shallow_sand/device/host_executor.h"
#include "shallow_sand/particles/grain_move.h"

namespace shallow_sand {

/// Moves grains on the CPU.
/// @param awake windows that hold all cells of I that may move, and perhaps others; they may overlap
void moveGrains(const HostExecutor& executor, const GrainMove& move, const std::vector<Window>& awake);

}  // namespace shallow_sand
