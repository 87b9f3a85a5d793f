#include "benchmark/quiet_maps.h"

#include "benchmark/counters.h"
#include "benchmark/timing.h"

namespace shallow_sand {

void measurePatch(benchmark::State& state, Backend backend, int corner, int threads) {
  TimedRun run(onBackend(backend, sloshingPit(4096, 256, corner, threads)).simulator());
  TimedRun alone(onBackend(backend, sloshingSand(256, threads)).simulator());
  for (auto _ : state) {
    state.SetIterationTime(run.runFrame());
    alone.runFrame();
  }
  setCounters(state, run);
  state.counters["times_alone"] = run.steps().best() / alone.steps().best();
  state.counters["typical_times_alone"] = run.steps().typical() / alone.steps().typical();
}

void measureResting(benchmark::State& state, const Map& map) {
  Simulator simulator = map.simulator();
  simulator.advance(10.0 * kFiftieth);
  for (auto _ : state) simulator.advance(kFiftieth);
  state.counters["moving"] = static_cast<double>(simulator.activeCells());
}

void measureRestingGrains(benchmark::State& state, Map map) {
  map.parameters.grains = GrainParameters();
  measureResting(state, map);
}

}  // namespace shallow_sand
