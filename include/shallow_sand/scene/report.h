#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// The figures of a run, as others' scripts read them.
struct Report {
  std::string scene;  ///< its name
  std::string backend;
  int threads = 0;
  std::size_t cells = 0;
  std::uint64_t steps = 0;
  double simulated = 0.0;  ///< [s]
  double wall = 0.0;       ///< spent in Simulator::advance [s]
  std::uint64_t cell_updates = 0;
  std::size_t active_cells_end = 0;
  double max_speed_end = 0.0;  ///< [m/s]
  Ledger volume;
  double body_overlap = 0.0;  ///< [m³]
  std::size_t grains = 0;
};

/// Takes the figures of a simulator that ran for `wall` [s].
Report makeReport(const Simulator& simulator, const std::string& scene, double wall);

/// Writes one JSON object. @throws std::runtime_error naming the file if it cannot be written
void writeReport(const std::string& path, const Report& report);

}  // namespace shallow_sand
