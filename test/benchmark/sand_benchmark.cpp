#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "benchmark/cpu_benchmarks.h"
#include "benchmark/maps.h"
#include "benchmark/run_benchmarks.h"
#include "benchmark/table1.h"
#ifdef SHALLOW_SAND_WITH_CUDA
#include "benchmark/cuda_benchmarks.h"
#endif

/// How fast a step is, on the backend that is asked for; see README.md here.
namespace {

using namespace shallow_sand;

constexpr int kBadInput = 2;

int failed(const std::string& message) {
  std::fprintf(stderr, "sand_benchmark: %s\n", message.c_str());
  return kBadInput;
}

/// Why a backend cannot be measured here; empty if it can.
std::string unavailable(Backend backend) {
  try {
    onBackend(backend, restingSand(1, 1, Edge::wall)).simulator();
  } catch (const InvalidParameter& reason) {
    return reason.what();
  }
  return "";
}

void registerBenchmarks(Backend backend) {
  registerTable1(backend);
#ifdef SHALLOW_SAND_WITH_CUDA
  if (backend == Backend::cuda) return registerCudaBenchmarks();
#endif
  if (backend == Backend::cpu) registerCpuBenchmarks();
}

}  // namespace

int main(int argument_count, char** arguments) {
  std::string name = "cpu";
  CLI::App app("Measures how fast the sand is.", "sand_benchmark");
  app.add_option("--backend", name, "cpu (the default) or cuda")->check(CLI::IsMember({"cpu", "cuda"}));
  bool table = false;
  app.add_flag("--table1", table, "only the paper's Table 1, printed beside it [ms per frame of 1/50 s]");
  app.footer("Options that begin with --benchmark_ are Google Benchmark's.");
  app.allow_extras();
  try {
    app.parse(argument_count, arguments);
  } catch (const CLI::ParseError& error) {
    const bool asked_for = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);
    return asked_for ? app.exit(error) : failed(std::string(error.what()) + "; see sand_benchmark --help");
  }
  const Backend backend = backendFromString(name);
  const std::string reason = unavailable(backend);
  if (!reason.empty()) return failed("nothing is measured: " + reason);
  std::vector<std::string> others = app.remaining();
  others.insert(others.begin(), arguments[0]);
  if (table) {
    Table1Printer printer;
    return runBenchmarks(
        others, [&] { registerTable1(backend); }, &printer);
  }
  return runBenchmarks(others, [&] { registerBenchmarks(backend); });
}
