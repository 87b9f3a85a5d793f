#pragma once

#include <string>

#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// Why `backend: cuda` does not run here; empty if it does.
inline std::string cudaDeviceMissing() {
  SimulatorParameters parameters;
  parameters.grid.size = {parameters.grid.spacing, parameters.grid.spacing};
  parameters.backend = Backend::cuda;
  try {
    Simulator simulator(parameters, {0.0f}, {0.0f});
  } catch (const InvalidParameter& reason) {
    return reason.what();
  }
  return "";
}

}  // namespace shallow_sand
