#pragma once

#include <map>
#include <string>

#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// Texts by key, kept in the metadata domain SHALLOW_SAND of a state's GeoTIFF. Numbers are hexadecimal
/// floating point ("0x1.8p+1"), which strtod reads back without loss.
using Metadata = std::map<std::string, std::string>;

/// What a run needs to go on besides the lists of its snapshot, and the parameters that it had.
Metadata stateMetadata(const SimulatorParameters& parameters, const Snapshot& snapshot);

/// @throws InvalidParameter if the state lies on another grid
void requireSameGrid(const Metadata& metadata, const SimulatorParameters& parameters);

/// A snapshot whose lists are still to be filled. @throws InvalidParameter
Snapshot snapshotOf(const Metadata& metadata, const Grid& grid);

}  // namespace shallow_sand
