#include "benchmark/table1.h"

#include <benchmark/benchmark.h>

#include <exception>
#include <iomanip>
#include <sstream>

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

/// The paper's t_p: what a frame with grains takes beyond one without, by turns; and what it takes where all
/// grains move.
void table1Grains(benchmark::State& state, const Table1Row& row, Backend backend) {
  const auto with = [&](Scene scene) {
    scene.parameters.grains = row.grains;
    return runOf(scene);
  };
  const Scene scene = sceneOf(row, backend);
  const Scene sloshing = sloshingSandOf(row, backend);
  TimedRun grains = with(scene);
  TimedRun sand = runOf(scene);
  TimedRun all_grains = with(sloshing);
  TimedRun all_sand = runOf(sloshing);
  for (auto _ : state) {
    state.SetIterationTime(grains.runFrame());
    for (TimedRun* run : {&sand, &all_grains, &all_sand}) run->runFrame();
  }
  const auto milliseconds = [](const TimedRun& one, const TimedRun& other) {
    return 1e3 * (one.frames().typical() - other.frames().typical());
  };
  const GrainGrid grid(*row.grains, scene.parameters.grid.grid());
  state.counters["grains"] = static_cast<double>(grid.cells());
  state.counters["step_ms"] = 1e3 * sand.steps().typical();
  state.counters["steps"] = sand.stepsPerFrame();
  state.counters["tp_ms"] = milliseconds(grains, sand);
  state.counters["tp_all_ms"] = milliseconds(all_grains, all_sand);
  state.counters["all_step_ms"] = 1e3 * all_sand.steps().typical();
  state.SetLabel("paper: " + row.paper);
}

void registerRow(const std::string& name, const Table1Row& row, Backend backend,
                 void (*function)(benchmark::State&, const Table1Row&, Backend)) {
  const auto measure = [row, backend, function](benchmark::State& state) {
    try {
      function(state, row, backend);
    } catch (const std::exception& error) {
      state.SkipWithError(error.what());
    }
  };
  benchmark::RegisterBenchmark(name.c_str(), measure)
      ->UseManualTime()
      ->Iterations(kFrames)
      ->Unit(benchmark::kMillisecond);
}

/// Of a map; a dash where there is no such figure.
std::string figure(const std::map<std::string, double>& figures, const std::string& name) {
  const auto found = figures.find(name);
  if (found == figures.end()) return "–";
  std::ostringstream text;
  text << std::setprecision(2) << found->second;
  return text.str();
}

}  // namespace

bool Table1Printer::ReportContext(const Context&) { return true; }

void Table1Printer::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    const std::string name = run.benchmark_name();
    const std::size_t begin = name.find('/') + 1;
    const std::string row = name.substr(begin, name.find('/', begin) - begin);
    if (run.error_occurred) {
      GetErrorStream() << row << ": " << run.error_message << "\n";
      continue;
    }
    GetErrorStream() << name << "\n";  // long work shows progress
    for (const auto& counter : run.counters) figures_[row][counter.first] = counter.second.value;
    const bool with_grains = name.rfind("table1_grains/", 0) == 0;
    if (!with_grains) figures_[row]["frame_ms"] = run.GetAdjustedRealTime();
  }
}

void Table1Printer::Finalize() {
  std::ostream& out = GetOutputStream();
  out << "| row | steps | frame | t_d | t_i | t_p | t_p, all grains move | the paper, GTX 1060 |\n"
         "|---|---|---|---|---|---|---|---|\n";
  for (const Table1Row& row : table1Rows()) {
    const auto found = figures_.find(row.name);
    if (found == figures_.end()) continue;
    out << "| " << row.name << " | ";
    for (const char* name : {"steps", "frame_ms", "td_ms", "ti_ms", "tp_ms", "tp_all_ms"})
      out << figure(found->second, name) << " | ";
    out << row.paper << " |\n";
  }
}

void registerTable1(Backend backend) {
  for (const Table1Row& row : table1Rows()) {
    registerRow("table1/" + row.name, row, backend, table1);
    if (row.grains) registerRow("table1_grains/" + row.name, row, backend, table1Grains);
  }
}

}  // namespace shallow_sand
