#pragma once

#include <benchmark/benchmark.h>

#include "shallow_sand/device/passive_threads.h"

namespace shallow_sand {

/// What a program does that has registered benchmarks by `registerAll`. Returns its exit code.
inline int runBenchmarks(int argc, char** argv, void (*registerAll)()) {
  waitPassively(argv);
  registerAll();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace shallow_sand
