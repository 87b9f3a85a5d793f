#pragma once

#include <string>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// The numbers of an image file for the cells that it says something about, as a scene would read them from
/// {file: PATH}. @throws InvalidParameter with the key `file`
CellValues readTerrainHeights(const std::string& file, const Grid& grid);

}  // namespace shallow_sand
