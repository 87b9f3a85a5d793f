#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>
#include <vector>

namespace shallow_sand {

/// Registers a benchmark with every choice of one argument from each list. Google Benchmark 1.5.0, which is
/// Ubuntu 20.04's, has no ArgsProduct.
inline benchmark::internal::Benchmark* withProduct(benchmark::internal::Benchmark* benchmark,
                                                   const std::vector<std::vector<std::int64_t>>& lists) {
  std::vector<std::vector<std::int64_t>> choices{{}};
  for (const std::vector<std::int64_t>& list : lists) {
    std::vector<std::vector<std::int64_t>> longer;
    for (const std::vector<std::int64_t>& choice : choices) {
      for (const std::int64_t argument : list) {
        longer.push_back(choice);
        longer.back().push_back(argument);
      }
    }
    choices = longer;
  }
  for (const std::vector<std::int64_t>& choice : choices) benchmark->Args(choice);
  return benchmark;
}

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
  return 0;
}

}  // namespace shallow_sand
