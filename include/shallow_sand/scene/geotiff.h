#pragma once

#include <string>

#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// Writes the state of the sand: bands `bed`, `depth` [m], `momentum_x`, `momentum_y` [m²/s] and, where
/// bodies are near the sand, `contact_ceiling`, `contact_length` [m], `contact_velocity_x`,
/// `contact_velocity_y` [m/s]; float32, bit for bit; row 0 at the north edge (the largest y), the
/// geotransform in the grid's frame. The rest of the snapshot, and the parameters, go into the metadata
/// domain SHALLOW_SAND. Whatever happens meanwhile, the file is as it was or all of the new one.
/// @throws std::runtime_error naming the file if it cannot be written, or for fields that do not fit the grid
void saveState(const std::string& path, const SimulatorParameters& parameters, const Snapshot& state);

/// Reads what saveState wrote. Of the parameters the grid must be the same; material, gravity and solver may
/// differ, but then the run does not go on bit for bit. @throws SceneError naming the file
Snapshot loadState(const std::string& path, const SimulatorParameters& parameters);

}  // namespace shallow_sand
