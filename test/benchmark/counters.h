#pragma once

#include <benchmark/benchmark.h>

#include "benchmark/timing.h"

namespace shallow_sand {

/// Tells of a run what every benchmark of sand that moves tells.
inline void setCounters(benchmark::State& state, const TimedRun& run) {
  state.counters["cells_per_second"] = 1.0 / run.cells().typical();
  state.counters["best_cells_per_second"] = 1.0 / run.cells().best();
  state.counters["repeated"] = run.repeated();
  state.counters["moving"] = run.moving();
}

}  // namespace shallow_sand
