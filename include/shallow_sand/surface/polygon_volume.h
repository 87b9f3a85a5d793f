#pragma once

#include <Eigen/Core>
#include <vector>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// Sand over, on and under a polygon that is seen from above.
struct PolygonVolume {
  double on_ground = 0.0;  ///< [m³]
  double on_bodies = 0.0;  ///< [m³]
  double area = 0.0;       ///< of the polygon where it is over the map [m²]
};

/// The corners of a polygon of which a volume can be told. @throws InvalidParameter with key `polygon` for
/// less than 3 corners or more than 10^4, numbers that are not finite or beyond 10^6 m, and sides that meet
/// others elsewhere than at their common corner
void requireSimplePolygon(const std::vector<Eigen::Vector2d>& corners);

/// Each cell counts with the exact share of its square that is within the polygon.
/// @param corners in the grid's frame, in either direction, see requireSimplePolygon [m]
PolygonVolume volumeInPolygon(const Grid& grid, const Fields& fields,
                              const std::vector<Eigen::Vector2d>& corners);

}  // namespace shallow_sand
