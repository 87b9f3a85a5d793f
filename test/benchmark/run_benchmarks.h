#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

namespace shallow_sand {

/// What a program does that has registered benchmarks by `registerAll`. Returns its exit code.
/// @param arguments the program's name and Google Benchmark's options
/// @param reporter gets the figures; Google Benchmark's own if null
template <class RegisterAll>
int runBenchmarks(std::vector<std::string> arguments, RegisterAll&& registerAll,
                  benchmark::BenchmarkReporter* reporter = nullptr) {
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  int count = static_cast<int>(pointers.size());
  registerAll();
  benchmark::Initialize(&count, pointers.data());
  if (benchmark::ReportUnrecognizedArguments(count, pointers.data())) return 2;
  benchmark::RunSpecifiedBenchmarks(reporter);
  benchmark::Shutdown();
  return 0;
}

}  // namespace shallow_sand
