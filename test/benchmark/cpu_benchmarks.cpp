#include "benchmark/cpu_benchmarks.h"

#include <benchmark/benchmark.h>

#include <algorithm>

#include "benchmark/busy_processes.h"
#include "benchmark/counters.h"
#include "benchmark/quiet_maps.h"
#include "benchmark/references.h"
#include "benchmark/run_benchmarks.h"
#include "benchmark/timing.h"
#include "shallow_sand/surface/surface_mesh.h"

/// Everything that a ratio compares runs by turns, so that what else a machine does falls on both.
namespace shallow_sand {
namespace {

/// A map in which every cell moves, by turns with copying what its steps must move and with the plain loop.
void dense(benchmark::State& state, const Map& map) {
  const double cells = static_cast<double>(map.bed.size());
  TimedRun run(map.simulator());
  CopyingStep copying(map, map.parameters.threads);
  PlainStep plain(map, map.parameters.threads);
  Timing copy_time;
  Timing plain_time;
  int frame = 0;
  for (auto _ : state) {
    state.SetIterationTime(run.runFrame());
    // Not after every frame: they empty the caches of what the next one needs.
    if (frame++ % 8 != 0) continue;
    copying();
    copy_time.add(secondsOf(copying), cells);
    plain_time.add(secondsOf(plain), cells);
  }
  setCounters(state, run);
  state.counters["times_copy"] = run.cells().best() / copy_time.best();
  state.counters["times_plain_loop"] = run.cells().best() / plain_time.best();
  state.counters["copy_bytes_per_second"] = 28.0 / copy_time.best();
}

void moving(benchmark::State& state) {
  dense(state, sloshingSand(static_cast<int>(state.range(0)), static_cast<int>(state.range(1))));
}

void instructions(benchmark::State& state) {
  Map map = sloshingSand(256, 1);
  map.parameters.instructions = static_cast<InstructionSet>(state.range(0));
  state.SetLabel(toString(*map.parameters.instructions));
  dense(state, map);
}

void minmod(benchmark::State& state) {
  Map map = sloshingSand(static_cast<int>(state.range(0)), 1);
  map.parameters.solver.reconstruction = Reconstruction::minmod;
  dense(state, map);
}

void patch(benchmark::State& state) {
  const int threads = static_cast<int>(state.range(1));
  measurePatch(state, Backend::cpu, static_cast<int>(state.range(0)), threads);
}

void resting(benchmark::State& state) {
  measureResting(state, restingSand(4096, 2, state.range(0) != 0 ? Edge::open : Edge::wall));
}

/// The mesh of a pool of sand between bare slopes.
void surface(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  const Map map = sloshingPit(side, side / 2, side / 4, 1);
  const Simulator simulator = map.simulator();
  const Grid& grid = simulator.grid();
  const Fields fields = simulator.fields();
  Timing cells;
  for (auto _ : state) {
    const double seconds = secondsOf([&] { benchmark::DoNotOptimize(surfaceMesh(grid, fields)); });
    state.SetIterationTime(seconds);
    cells.add(seconds, static_cast<double>(grid.cells()));
  }
  state.counters["cells_per_second"] = 1.0 / cells.typical();
  state.counters["best_cells_per_second"] = 1.0 / cells.best();
}

void restingGrains(benchmark::State& state) {
  measureRestingGrains(state, restingSand(static_cast<int>(state.range(0)), 2, Edge::wall));
}

/// Two threads by turns with one, beside other processes that are busy on every core.
void besideBusyProcesses(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  const BusyProcesses others(static_cast<int>(state.range(1)));
  TimedRun two(sloshingSand(side, 2).simulator());
  TimedRun one(sloshingSand(side, 1).simulator());
  for (auto _ : state) {
    state.SetIterationTime(two.runFrame());
    one.runFrame();
  }
  setCounters(state, two);
  state.counters["times_one_thread"] = two.cells().typical() / one.cells().typical();
  state.counters["one_thread_cells_per_second"] = 1.0 / one.cells().typical();
}

}  // namespace

void registerCpuBenchmarks() {
  const auto add = [](const char* name, void (*function)(benchmark::State&)) {
    return benchmark::RegisterBenchmark(name, function)->UseManualTime();
  };
  withProduct(add("moving", moving)->ArgNames({"side", "threads"}), {{64, 128, 256, 1024, 4096}, {1, 2}});
  for (const InstructionSet set : instructionSets())
    add("instructions", instructions)->Arg(static_cast<int>(set));
  add("minmod", minmod)->ArgNames({"side"})->Arg(256)->Arg(1024);
  // Corners of tiles lie at multiples of 32 columns and 16 rows.
  withProduct(add("patch", patch)->ArgNames({"corner", "threads"}), {{1024, 1031, 1039}, {1, 2}});
  benchmark::RegisterBenchmark("resting", resting)
      ->ArgNames({"open_edges"})
      ->Arg(0)
      ->Arg(1)
      ->Unit(benchmark::kMicrosecond);
  add("surface", surface)->ArgNames({"side"})->Arg(64)->Arg(512)->Arg(1024)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("resting_grains", restingGrains)
      ->ArgNames({"side"})
      ->Arg(64)
      ->Arg(1024)
      ->Unit(benchmark::kMicrosecond);
  withProduct(add("beside_busy_processes", besideBusyProcesses)->ArgNames({"side", "others"}),
              {{64, 256, 1024}, {0, 1, 2}});
}

}  // namespace shallow_sand
