#pragma once

#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// A benchmark for each row of the paper's Table 1; see README.md here.
void registerTable1(Backend backend);

}  // namespace shallow_sand
