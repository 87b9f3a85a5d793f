#include "benchmark/table1.h"

#include <benchmark/benchmark.h>

#include <exception>

#include "benchmark/table1_rows.h"
#include "benchmark/timing.h"
#include "shallow_sand/scene/simulation.h"

namespace shallow_sand {
namespace {

constexpr int kFrames = 50;

TimedRun runOf(const Scene& scene) { return TimedRun(buildSimulator(scene), kFiftieth); }

/// The paper's t_d is for all cells, and ours leaves out those that rest: it is a step of sand that sloshes
/// over the whole map, times the steps of the scene. t_i is what a frame of the scene takes beyond the cells
/// that it computes. Both run by turns.
void table1(benchmark::State& state, const Table1Row& row, Backend backend) {
  const Scene scene = sceneOf(row, backend);
  TimedRun run = runOf(scene);
  TimedRun sand = runOf(sloshingSandOf(row, backend));
  for (auto _ : state) {
    state.SetIterationTime(run.runFrame());
    sand.runFrame();
  }
  const double frame = run.frames().typical();
  const double cells = frame / run.cells().typical();  // computed in a frame
  state.counters["steps"] = run.stepsPerFrame();
  state.counters["computed"] = cells / run.stepsPerFrame() / static_cast<double>(scene.bed.size());
  state.counters["td_ms"] = 1e3 * run.stepsPerFrame() * sand.steps().typical();
  if (!scene.bodies.empty()) state.counters["ti_ms"] = 1e3 * (frame - cells * sand.cells().typical());
  state.SetLabel("paper: " + row.paper);
}

}  // namespace

void registerTable1(Backend backend) {
  for (const Table1Row& row : table1Rows()) {
    const auto measure = [row, backend](benchmark::State& state) {
      try {
        table1(state, row, backend);
      } catch (const std::exception& error) {
        state.SkipWithError(error.what());
      }
    };
    benchmark::RegisterBenchmark(("table1/" + row.name).c_str(), measure)
        ->UseManualTime()
        ->Iterations(kFrames)
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace shallow_sand
