#pragma once

#include <vector>

#include "shallow_sand/core/fields.h"

namespace shallow_sand {

/// How the ground's sand differs from what it was. What bodies carry is not on the ground; where a body
/// stands in the sand, that has made way: it is missing there.
struct MovedVolume {
  double dug = 0.0;     ///< room below the first surface where there is no sand now [m³]
  double heaped = 0.0;  ///< sand above it [m³]
};

/// @param start depth of the sand at first, one value a cell [m] @param now fields of the same bed
/// heaped − dug + all loads is by how much there is more sand.
/// @throws InvalidParameter with key `start` for another number of cells
MovedVolume movedVolume(const Grid& grid, const std::vector<float>& start, const Fields& now);

}  // namespace shallow_sand
