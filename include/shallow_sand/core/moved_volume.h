#pragma once

#include <vector>

#include "shallow_sand/core/fields.h"

namespace shallow_sand {

/// Where there is sand now and where there was at first, by elevations: sand that lies on a body is at the
/// body's top and above. heaped − dug is by how much there is more sand.
struct MovedVolume {
  double dug = 0.0;     ///< room below the first surface that holds no sand now, a body's own included [m³]
  double heaped = 0.0;  ///< sand above it, on the ground or carried [m³]
};

/// @param start depth of the sand at first, one value a cell, all on the ground [m]
/// @param now fields on the same bed
/// @throws InvalidParameter with key `start` for another number of cells
MovedVolume movedVolume(const Grid& grid, const std::vector<float>& start, const Fields& now);

}  // namespace shallow_sand
