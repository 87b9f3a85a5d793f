#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <string>

#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// A benchmark for each row of the paper's Table 1; see README.md here.
void registerTable1(Backend backend);

/// Prints the figures of these benchmarks as one table, in the order of the paper's. [ms per frame of 1/50 s]
class Table1Printer : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

 private:
  std::map<std::string, std::map<std::string, double>> figures_;  ///< by row, then by counter
};

}  // namespace shallow_sand
