#include "benchmark/cuda_benchmarks.h"

#include <benchmark/benchmark.h>

#include <exception>

#include "benchmark/counters.h"
#include "benchmark/cuda_references.h"
#include "benchmark/quiet_maps.h"
#include "benchmark/timing.h"

namespace shallow_sand {
namespace {

/// A map in which every cell moves, by turns with copying what its steps must move.
void step(benchmark::State& state) {
  constexpr double kBytes = 28.0;  // of a cell and step
  constexpr int kCopies = 10;      // at once, so that launches overlap
  const Map map = onBackend(Backend::cuda, sloshingSand(static_cast<int>(state.range(0)), 1));
  const double cells = static_cast<double>(map.bed.size());
  TimedRun run(map.simulator(), kFiftieth);
  DeviceCopy copying(map.bed.size());
  copying(kCopies);
  Timing copy_time;
  for (auto _ : state) {
    state.SetIterationTime(run.runFrame());
    copy_time.add(secondsOf([&] { copying(kCopies); }), kCopies);
  }
  setCounters(state, run);
  state.counters["steps"] = run.stepsPerFrame();
  state.counters["step_ms"] = 1e3 * run.steps().best();
  state.counters["typical_step_ms"] = 1e3 * run.steps().typical();
  state.counters["bytes_per_second"] = kBytes * cells / run.steps().best();
  state.counters["copy_bytes_per_second"] = kBytes * cells / copy_time.best();
  state.counters["times_copy"] = run.steps().best() / copy_time.best();
}

void patch(benchmark::State& state) {
  measurePatch(state, Backend::cuda, static_cast<int>(state.range(0)), 1);
}

void resting(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  measureResting(state, onBackend(Backend::cuda, restingSand(side, 1, Edge::wall)));
}

void restingGrains(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  measureRestingGrains(state, onBackend(Backend::cuda, restingSand(side, 1, Edge::wall)));
}

/// An empty kernel that is waited for, as the results of a frame are; and one of many in a row.
void launch(benchmark::State& state) {
  constexpr int kLaunches = 100;
  Timing queued;
  launchEmptyKernels(kLaunches);
  for (auto _ : state) {
    state.SetIterationTime(secondsOf([] { launchEmptyKernels(1); }));
    queued.add(secondsOf([] { launchEmptyKernels(kLaunches); }), kLaunches);
  }
  state.counters["queued_us"] = 1e6 * queued.best();
}

/// An empty cooperative kernel with and without synchronisations of the grid.
void gridSync(benchmark::State& state) {
  constexpr int kSynchronisations = 64;
  const int blocks = static_cast<int>(state.range(0));
  Timing with;
  Timing without;
  synchroniseGrid(blocks, kSynchronisations);
  for (auto _ : state) {
    const double seconds = secondsOf([&] { synchroniseGrid(blocks, kSynchronisations); });
    state.SetIterationTime(seconds);
    with.add(seconds, 1.0);
    without.add(secondsOf([&] { synchroniseGrid(blocks, 0); }), 1.0);
  }
  state.counters["sync_us"] = 1e6 * (with.best() - without.best()) / kSynchronisations;
  state.counters["empty_us"] = 1e6 * without.best();
}

/// What runs a benchmark and tells why it cannot run, such as for want of memory, so that the others go on.
auto telling(void (*function)(benchmark::State&)) {
  return [function](benchmark::State& state) {
    try {
      function(state);
    } catch (const std::exception& error) {
      state.SkipWithError(error.what());
    }
  };
}

}  // namespace

void registerCudaBenchmarks() {
  benchmark::AddCustomContext("gpu", deviceName());
  const auto add = [](const char* name, void (*function)(benchmark::State&), benchmark::TimeUnit unit) {
    return benchmark::RegisterBenchmark(name, telling(function))->UseManualTime()->Unit(unit);
  };
  add("step", step, benchmark::kMillisecond)->ArgNames({"side"})->RangeMultiplier(2)->Range(64, 8192);
  add("patch", patch, benchmark::kMillisecond)->ArgNames({"corner"})->Arg(1024)->Arg(1031)->Arg(1039);
  benchmark::RegisterBenchmark("resting", telling(resting))
      ->ArgNames({"side"})
      ->RangeMultiplier(8)
      ->Range(64, 4096)
      ->Unit(benchmark::kMicrosecond)
      ->UseRealTime();
  benchmark::RegisterBenchmark("resting_grains", telling(restingGrains))
      ->ArgNames({"side"})
      ->Arg(64)
      ->Arg(1024)
      ->Unit(benchmark::kMicrosecond)
      ->UseRealTime();
  add("launch", launch, benchmark::kMicrosecond);
  add("grid_sync", gridSync, benchmark::kMicrosecond)->ArgNames({"blocks"})->RangeMultiplier(2)->Range(1, 4);
}

}  // namespace shallow_sand
