#include <benchmark/benchmark.h>

#include <cstring>

#include "shallow_sand/device/host_executor.h"
#include "shallow_sand/device/passive_threads.h"
#include "shallow_sand/sim/simulator.h"
#include "shallow_sand/solver/grid_stepper.h"
#include "shallow_sand/solver/sand_constants.h"

/// How fast the CPU's step is: cells that it computes a second ("cells_per_second"), beside what bounds it.
namespace shallow_sand {
namespace {

constexpr double kSpacing = 0.02;
constexpr int kStepsOfAFrame = 10;

SimulatorParameters parametersOf(int cells_along_side, int threads) {
  SimulatorParameters parameters;
  parameters.backend = Backend::cpu;
  parameters.grid.spacing = kSpacing;
  parameters.grid.size = {cells_along_side * kSpacing, cells_along_side * kSpacing};
  parameters.threads = threads;
  return parameters;
}

/// Sand without friction that sloshes in a box for ever: every cell moves in every step.
struct SloshingSand {
  SimulatorParameters parameters;
  std::vector<float> bed;
  std::vector<float> depth;

  SloshingSand(int side, int threads) : parameters(parametersOf(side, threads)) {
    parameters.material.friction_angle = 0.0;
    parameters.gravity = {0.5, 0.3, -9.81};
    const Grid grid = parameters.grid.grid();
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) {
        bed.push_back(0.05f * std::sin(0.11f * i) * std::sin(0.07f * j));
        depth.push_back(1.0f + 0.1f * std::sin(0.05f * i + 0.09f * j));
      }
    }
  }
};

/// Runs frames of a few steps and counts the cells that moved.
void runFrames(benchmark::State& state, Simulator& simulator, double frame) {
  simulator.advance(20.0 * frame);  // all cells have begun to move, or come to rest
  const Progress before = simulator.progress();
  for (auto _ : state) simulator.advance(frame);
  const Progress& after = simulator.progress();
  state.counters["cells_per_second"] = benchmark::Counter(
      static_cast<double>(after.cell_updates - before.cell_updates), benchmark::Counter::kIsRate);
  state.counters["steps_per_second"] =
      benchmark::Counter(static_cast<double>(after.steps - before.steps), benchmark::Counter::kIsRate);
  state.counters["repeated"] = static_cast<double>(after.repeated_steps - before.repeated_steps);
  state.counters["moving"] = static_cast<double>(simulator.activeCells());
}

void denseSand(benchmark::State& state, const SloshingSand& sand) {
  Simulator simulator(sand.parameters, sand.bed, sand.depth);
  simulator.advance(1e-3);
  const double step = simulator.progress().last_step;
  runFrames(state, simulator, kStepsOfAFrame * std::max(step, 0.003));
}

void moving(benchmark::State& state) {
  denseSand(state, SloshingSand(static_cast<int>(state.range(0)), static_cast<int>(state.range(1))));
}

void instructions(benchmark::State& state) {
  SloshingSand sand(1024, 1);
  const auto set = static_cast<InstructionSet>(state.range(0));
  sand.parameters.instructions = set;
  state.SetLabel(toString(set));
  denseSand(state, sand);
}

void minmod(benchmark::State& state) {
  SloshingSand sand(1024, 1);
  sand.parameters.solver.reconstruction = Reconstruction::minmod;
  denseSand(state, sand);
}

}  // namespace
}  // namespace shallow_sand

int main(int argc, char** argv) {
  using namespace shallow_sand;
  waitPassively(argv);
  benchmark::RegisterBenchmark("moving", moving)
      ->ArgNames({"side", "threads"})
      ->ArgsProduct({{64, 256, 1024, 4096}, {1, 2}})
      ->UseRealTime();
  for (const InstructionSet set : instructionSets())
    benchmark::RegisterBenchmark("instructions", instructions)->Arg(static_cast<int>(set))->UseRealTime();
  benchmark::RegisterBenchmark("minmod", minmod)->UseRealTime();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
