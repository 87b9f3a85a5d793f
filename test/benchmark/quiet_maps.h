#pragma once

#include <benchmark/benchmark.h>

#include "benchmark/maps.h"

/// Maps of which little or nothing moves, on either backend.
namespace shallow_sand {

/// A patch of 256² cells moves in a map of 4096², by turns with a map of 256² that moves.
/// @param corner first column and row of the patch
void measurePatch(benchmark::State& state, Backend backend, int corner, int threads);

/// A frame of 1/50 s of a map at rest.
void measureResting(benchmark::State& state, const Map& map);

/// The same with 16 grains a cell.
void measureRestingGrains(benchmark::State& state, Map map);

}  // namespace shallow_sand
