#pragma once

#include <Eigen/Core>
#include <optional>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// What the sand is like at a place.
struct SurfacePoint {
  double height;           ///< of the surface that one sees from above, in the grid's frame [m]
  double depth;            ///< of all sand, on the ground and on bodies [m]
  Eigen::Vector3d normal;  ///< of that surface, upward, of length 1
};

/// Bilinear between the four middles of cells around the place, and from the outermost squares on to the
/// edge of the map: exact on planes. @param place in the grid's frame [m]
/// @return nothing for a place that is beside the map
std::optional<SurfacePoint> surfaceAt(const Grid& grid, const Fields& fields, const Eigen::Vector2d& place);

}  // namespace shallow_sand
