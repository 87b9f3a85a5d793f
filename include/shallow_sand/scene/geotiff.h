#pragma once

#include <map>
#include <string>

#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// Texts by key, kept in the GeoTIFF's metadata domain SHALLOW_SAND.
using Metadata = std::map<std::string, std::string>;

/// What a run needs besides the fields to go on bit for bit: version, time, progress, ledger and the scene's
/// parameters. Numbers are hexadecimal floating point ("0x1.8p+1"), which strtod reads back without loss.
Metadata stateMetadata(const Simulator& simulator);

/// Writes the state of the sand: bands `bed`, `depth` [m], `momentum_x`, `momentum_y` [m²/s], float32, bit
/// for bit; row 0 at the north edge (the largest y), the geotransform in the grid's frame.
/// @throws std::runtime_error naming the file if it cannot be written, or for fields that do not fit the grid
void saveState(const std::string& path, const Grid& grid, const Fields& fields, const Metadata& metadata);

}  // namespace shallow_sand
