#include <boost/program_options.hpp>
#include <cstdio>
#include <iostream>
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
  namespace po = boost::program_options;
  std::string name = "cpu";
  po::options_description declared("Options");
  declared.add_options()("backend", po::value(&name), "cpu (the default) or cuda")(
      "table1", "only the paper's Table 1, printed beside it [ms per frame of 1/50 s]")("help",
                                                                                        "Tell all this");
  po::variables_map given;
  std::vector<std::string> others{arguments[0]};
  try {
    const po::parsed_options parsed =
        po::command_line_parser(argument_count, arguments)
            .options(declared)
            .allow_unregistered()
            .style(po::command_line_style::unix_style & ~po::command_line_style::allow_guessing)
            .run();
    po::store(parsed, given);
    po::notify(given);
    for (const std::string& other : po::collect_unrecognized(parsed.options, po::include_positional))
      others.push_back(other);
  } catch (const po::error& error) {
    return failed(std::string(error.what()) + "; see sand_benchmark --help");
  }
  if (given.count("help") > 0) {
    std::cout << "Measures how fast the sand is.\n\n"
              << declared << "Options that begin with --benchmark_ are Google Benchmark's.\n";
    return 0;
  }
  if (name != "cpu" && name != "cuda") return failed("--backend: " + name + "; expected cpu or cuda");
  const Backend backend = backendFromString(name);
  const std::string reason = unavailable(backend);
  if (!reason.empty()) return failed("nothing is measured: " + reason);
  if (given.count("table1") > 0) {
    Table1Printer printer;
    return runBenchmarks(
        others, [&] { registerTable1(backend); }, &printer);
  }
  return runBenchmarks(others, [&] { registerBenchmarks(backend); });
}
