#pragma once

#include <Eigen/Core>
#include <vector>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// A surface of sand, one point at the centre of each cell; laid out as in Fields.
struct Surface {
  std::vector<Eigen::Vector3f> points;  ///< in the grid's frame [m]
  std::vector<Eigen::Vector3f>
      colors;  ///< red, green, blue from 0 to 1: sand shaded by its relief, bare bed grey
};

/// That of the ground, s = h + b, also below what lies on bodies. Sand thinner than a tenth of a cell counts
/// as bare bed (section 7.2).
Surface groundSurface(const Grid& grid, const Fields& fields);

/// What one sees from above: that of loads where there are any, of the ground elsewhere.
Surface visibleSurface(const Grid& grid, const Fields& fields);

/// Corners of the surface's triangles as indices of points, three for each, counter-clockwise seen from
/// above; two triangles between any four cells. Empty for a grid of one row or column.
std::vector<std::size_t> surfaceTriangles(const Grid& grid);

/// Those with a load at a corner, but none that hangs from a load to the ground far below: where a bucket
/// carries sand, that is a second sheet over the ground's.
std::vector<std::size_t> loadTriangles(const Grid& grid, const Fields& fields);

}  // namespace shallow_sand
